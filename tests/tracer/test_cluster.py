"""A picture by any Executor: the same bits whoever does which task when, and what is done is never lost."""

import threading
import time
import warnings
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor

import numpy as np
import pytest
from cases import slow_but

import tracer
from tracer import cluster
from tracer.engine import many, waves
from tracer.engine.picture import SoFar
from tracer.trace import folder, recording, unfinished

pytestmark = pytest.mark.slow

SETTINGS = tracer.Settings(width=6, height=5, spp=36, max_depth=4)


@pytest.fixture(autouse=True)
def small_tasks(monkeypatch):
    """Tasks of a few pixels, each of several waves."""
    monkeypatch.setattr(waves, "LANES", 160)
    monkeypatch.setattr(recording, "PATHS_IN_PART", 100)


@pytest.fixture(scope="module")
def scene():
    return tracer.load("cornell_unit")


class Backwards(ThreadPoolExecutor):
    """Does what it is asked only once three are waiting, the last one first."""

    def __init__(self, breaks_after=None):
        super().__init__(1)
        self._waiting, self._left, self._one = [], breaks_after, threading.RLock()

    def submit(self, function, *words):
        if self._left == 0:
            raise BrokenExecutor("pulled the plug")
        self._left = None if self._left is None else self._left - 1
        future = Future()
        self._waiting.append((future, function, words))
        if len(self._waiting) == 3:
            self.flush()
        else:
            threading.Timer(0.05, self.flush).start()
        return future

    def flush(self):
        with self._one:
            while self._waiting:
                future, function, words = self._waiting.pop()
                if future.set_running_or_notify_cancel():
                    try:
                        future.set_result(function(*words))
                    except tracer.TracerError as error:
                        future.set_exception(error)


def same(a, b):
    """Two Pictures have the same bits."""
    for what in ("rgb", "variance", "samples", "rays", "dropped"):
        assert np.asarray(getattr(a, what)).tobytes() == np.asarray(getattr(b, what)).tobytes(), what


def threads(count):
    return cluster.Cluster(ThreadPoolExecutor(count), count)


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("sampler", [{}, {"sampler": "lattice", "replicates": 4}])
def test_the_picture_is_the_local_one_bit_for_bit(scene, count, sampler):
    settings = tracer.Settings(**{**SETTINGS.as_dict(), **sampler})
    local = tracer.render(scene, settings)
    same(local, tracer.render(scene, settings, cluster=threads(count)))


def test_the_order_in_which_tasks_are_done_does_not_matter(scene):
    backwards = cluster.Cluster(Backwards(), 3)
    same(tracer.render(scene, SETTINGS), tracer.render(scene, SETTINGS, cluster=backwards))


@pytest.mark.parametrize("plan", [{"adaptive": "mse"}, {"until_error": 0.2}])
def test_plans_that_look_at_the_film_give_the_local_picture(scene, plan):
    settings = tracer.Settings(width=6, height=5, spp=48, max_depth=4)
    local = tracer.render(scene, settings, **plan)
    same(local, tracer.render(scene, settings, cluster=threads(3), **plan))


@pytest.mark.parametrize("level", slow_but(folder.LEVELS, "paths"))
def test_workers_write_the_parts_of_a_recording(scene, tmp_path, monkeypatch, level):
    settings = SETTINGS if level == "paths" else tracer.Settings(width=4, height=3, spp=32, max_depth=4)
    here = tracer.record(scene, settings, tmp_path / "here", level)
    monkeypatch.chdir(tmp_path)
    same(here, tracer.record(scene, settings, "there", level, cluster=threads(3)))
    assert not folder.whole(tmp_path / "there").missing()
    one, other = (tracer.read_trace(tmp_path / name).paths for name in ("here", "there"))
    np.testing.assert_array_equal(one["radiance"], other["radiance"])


def test_a_part_that_two_workers_write_is_there_once(scene, tmp_path):
    tracer.record(scene, SETTINGS, tmp_path / "rec")
    place = folder.opened(tmp_path / "rec")
    late = tmp_path / "rec" / f"late{folder.PARTIAL}"
    late.mkdir()
    recording._put(late, place.part(0))
    assert not late.exists()
    assert not place.missing()


def test_a_lost_cluster_leaves_what_is_done_and_another_goes_on(scene):
    so_far = SoFar.begin(SETTINGS)
    broken = cluster.Cluster(Backwards(breaks_after=7), 2, name="the cluster of the test")
    with pytest.warns(many.ClusterWarning, match=r"the cluster of the test is lost \(pulled the plug\)"):
        stopped = tracer.render(scene, SETTINGS, cluster=broken, so_far=so_far)
    assert broken.lost
    assert not stopped.complete
    done = int((stopped.samples == SETTINGS.spp).sum())
    assert 0 < done < stopped.samples.size
    local = tracer.render(scene, SETTINGS)
    assert stopped.rgb.reshape(-1, 3)[:done].tobytes() == local.rgb.reshape(-1, 3)[:done].tobytes()
    same(local, tracer.render(scene, SETTINGS, cluster=threads(2), so_far=so_far))


def test_a_lost_cluster_leaves_whole_parts_of_a_recording(scene, tmp_path):
    broken = cluster.Cluster(Backwards(breaks_after=4), 1)
    with pytest.warns(many.ClusterWarning, match="is lost"):
        tracer.record(scene, SETTINGS, tmp_path / "rec", cluster=broken)
    missing = folder.opened(tmp_path / "rec").missing()
    assert 0 < len(missing) < folder.opened(tmp_path / "rec").parts
    local = tracer.render(scene, SETTINGS)
    same(local, tracer.record(scene, SETTINGS, tmp_path / "rec", cluster=threads(2)))


class Stuck(ThreadPoolExecutor):
    """Does one task, by its number in the order of asking, only once it is let go."""

    def __init__(self, number):
        super().__init__(4)
        self.asked, self.gate, self._number = 0, threading.Event(), number

    def submit(self, function, *words):
        self.asked += 1
        if self.asked == self._number:
            return super().submit(lambda: self.gate.wait(30.0) and function(*words))
        return super().submit(function, *words)


def test_behind_a_slow_worker_no_more_is_asked_for_than_a_window_of_tasks(monkeypatch):
    monkeypatch.setattr(many, "LOOK", 0.01)
    slow, looked = Stuck(1), []

    def working():  # asked where nothing has come for a while
        looked.append(slow.asked)
        if len(looked) == 20:
            slow.gate.set()
        return True

    tasks = list(range(many.AHEAD * 10))
    assert list(many.traced(int, tasks, cluster.Cluster(slow, 2, working=working))) == tasks
    assert max(looked[:20]) == many.AHEAD * 2


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr(many, "LOOK", 0.01)
    monkeypatch.setattr(cluster, "PATIENCE", 0.05)


def test_where_all_workers_are_gone_that_is_said_and_it_goes_on_with_the_next(scene, impatient):
    alone, counted = Stuck(2), []

    def working():
        counted.append(len(counted) >= 30)
        if counted[-1]:
            alone.gate.set()
        return counted[-1]

    there = cluster.Cluster(alone, 1, name="the cluster of the test", working=working)
    with pytest.warns(many.ClusterWarning, match="the cluster of the test has no worker any more"):
        picture = tracer.render(scene, SETTINGS, cluster=there)
    assert any(counted)
    same(tracer.render(scene, SETTINGS), picture)


def test_that_there_is_no_worker_is_said_once_until_there_is_one_again(impatient):
    there = cluster.Cluster(None, working=lambda: False)
    with pytest.warns(many.ClusterWarning) as said:
        for moving in (*[False] * 10, True, *[False] * 10):
            there.look(moving)
            time.sleep(0.02)
    assert len(said) == 2


def test_where_no_worker_comes_back_what_is_done_is_kept_and_another_goes_on(scene, impatient, monkeypatch):
    monkeypatch.setattr(cluster, "LONGEST", 0.8)
    alone, so_far, done = Stuck(5), SoFar.begin(SETTINGS), []
    there = cluster.Cluster(alone, 1, working=lambda: len(done) < 4)
    with pytest.warns(many.ClusterWarning) as said:
        stopped = tracer.render(
            scene, SETTINGS, lambda *paths: done.append(paths), cluster=there, so_far=so_far
        )
    alone.gate.set()
    assert "has no worker any more" in str(said[0].message)
    assert "has had no worker for 0.8 seconds" in str(said[-1].message)
    assert there.lost
    assert not stopped.complete
    assert stopped.samples.any()
    same(tracer.render(scene, SETTINGS), tracer.render(scene, SETTINGS, cluster=threads(2), so_far=so_far))


def test_a_worker_of_another_kind_is_told_once(scene, monkeypatch):
    strange = {**cluster.fingerprint(), "numpy": "0.1"}
    monkeypatch.setattr(cluster, "told", lambda job, task: (strange, job(task)))
    with pytest.warns(many.ClusterWarning) as said:
        tracer.render(scene, SETTINGS, cluster=threads(2))
    (line,) = said
    assert "numpy 0.1 there" in str(line.message)
    assert "statistically, not bit by bit" in str(line.message)


def test_workers_of_the_same_kind_are_not_spoken_of(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tracer.render(scene, SETTINGS, cluster=threads(2))


def test_a_mistake_in_a_task_is_told_and_ends_the_render(scene):
    def fails(*_):
        raise tracer.TracerError("scene: something is wrong")

    with pytest.raises(tracer.TracerError, match="something is wrong"):
        list(many.traced(fails, [1, 2, 3], threads(2)))


def test_a_worker_that_lacks_something_is_told_in_one_line_and_what_is_done_is_kept(scene, monkeypatch):
    calls = []

    def lacking(job, task):
        calls.append(task)
        if len(calls) > 3:
            raise ModuleNotFoundError("No module named 'tracer'")
        return cluster.fingerprint(), job(task)

    monkeypatch.setattr(cluster, "told", lacking)
    with pytest.warns(many.ClusterWarning, match=r"failed: ModuleNotFoundError \(No module named 'tracer'\)"):
        stopped = tracer.render(scene, SETTINGS, cluster=threads(1))
    assert not stopped.complete
    assert stopped.samples.any()


def test_a_recording_of_too_many_parts_is_refused_before_anything_is_written(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(folder, "MOST_PARTS", 5)
    with pytest.raises(tracer.TracerError, match="would have 15 parts, and a recording has 5 at most"):
        tracer.record(scene, SETTINGS, tmp_path / "rec")
    assert not (tmp_path / "rec").exists()


def test_tasks_of_a_large_render_are_a_hundred_thousand_and_keep_pixels_together(monkeypatch):
    monkeypatch.undo()
    settings = tracer.Settings(width=9000, height=9000, spp=4096)

    class Empty:
        samples = np.zeros(0)

    tasks = list(many.left(settings, 1000, Empty()))
    assert len(tasks) == -(-9000 * 9000 // 2048)
    assert all(task.sample == 0 and task.samples == 4096 for task in tasks)


@pytest.fixture
def stopped(scene, tmp_path):
    """An unfinished picture's file."""
    so_far, path = SoFar.begin(SETTINGS), tmp_path / f"a.exr{unfinished.ENDING}"
    with pytest.warns(many.ClusterWarning):
        broken = cluster.Cluster(Backwards(breaks_after=7), 2)
        tracer.render(scene, SETTINGS, cluster=broken, so_far=so_far)
    assert unfinished.keep(path, so_far, scene, SETTINGS) == np.count_nonzero(so_far.sheet.samples)
    return path


def test_an_unfinished_picture_goes_on_from_its_file(scene, stopped):
    so_far = unfinished.resumed(stopped, scene, SETTINGS)
    assert so_far.sheet.samples.any()
    same(tracer.render(scene, SETTINGS), tracer.render(scene, SETTINGS, cluster=threads(2), so_far=so_far))


def test_the_beginning_of_another_picture_is_refused(scene, stopped):
    other = tracer.Settings(**{**SETTINGS.as_dict(), "seed": 5})
    with pytest.raises(
        tracer.TracerError, match="beginning of a picture with settings seed 0, not 5; remove it"
    ):
        unfinished.resumed(stopped, scene, other)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 nonsense", b"words"])
def test_a_file_that_is_no_unfinished_picture_is_refused(scene, tmp_path, content):
    path = tmp_path / f"a.exr{unfinished.ENDING}"
    path.write_bytes(content)
    with pytest.raises(tracer.TracerError, match="is not the beginning of a picture; remove it"):
        unfinished.resumed(path, scene, SETTINGS)


def test_without_the_package_one_line_says_what_is_missing(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with (
        pytest.raises(tracer.TracerError, match="needs the package distributed.*pip install distributed"),
        cluster.connected("tcp://127.0.0.1:8786"),
    ):
        pass
