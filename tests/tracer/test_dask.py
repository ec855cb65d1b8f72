"""A real scheduler and real workers on loopback: the same bits, whatever happens to them."""

import asyncio
import os
import random
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from clusters import SLOW, Machines
from suite import ROOT, castray, missing

import tracer
from tracer import cluster
from tracer.trace import folder

pytestmark = pytest.mark.slow

SETTINGS = tracer.Settings(width=48, height=48, spp=32, max_depth=6)
OPTIONS = ("--size", "64", "64", "--max-depth", "6")


@pytest.fixture(scope="module")
def machines(tmp_path_factory):
    """A scheduler and one worker; the tests of this file add to them, in their order."""
    try:
        import distributed  # noqa: F401
    except ImportError:
        missing("distributed")
    started = Machines(tmp_path_factory.mktemp("machines"), workers=1)
    yield started
    started.close()


@pytest.fixture(scope="module")
def local():
    scene = tracer.load("cornell_unit")
    return scene, tracer.render(scene, SETTINGS)


def check(machines, local, progress=None, workers=None, processes=8):
    """The cluster's picture is the local one. processes: more than there are, for more and smaller tasks."""
    scene, picture = local
    with cluster.connected(machines.address) as there:
        assert workers in (None, there.processes)
        there.processes = processes
        other = tracer.render(scene, SETTINGS, progress, cluster=there)
    for what in ("rgb", "variance", "samples", "rays", "dropped"):
        assert np.asarray(getattr(picture, what)).tobytes() == np.asarray(getattr(other, what)).tobytes()


@pytest.fixture(autouse=True)
def small_tasks(monkeypatch):
    monkeypatch.setattr("tracer.engine.waves.LANES", 1 << 12)


def test_a_notebook_with_its_running_loop_may_ask_for_a_cluster(machines):
    async def cell():
        with cluster.connected(machines.address) as found:
            return found.processes

    with ThreadPoolExecutor(1) as beside:  # a browser test before this one leaves its loop running here
        assert beside.submit(asyncio.run, cell()).result() == 1


def test_one_two_and_three_workers_give_the_same_bits_a_slow_one_among_them(machines, local, tmp_path):
    slow = tmp_path / "slow.py"
    slow.write_text(SLOW, encoding="utf-8")
    check(machines, local, workers=1)
    machines.workers += [machines.start()]
    check(machines, local, workers=2)
    machines.workers += [machines.start(slow)]
    check(machines, local, workers=3)


def test_a_worker_killed_at_any_moment_changes_nothing(machines, local, suite_seed):
    moment = random.Random(suite_seed).randrange(1, 16)  # of 18 tasks
    seen = []

    def kill(done, total):
        seen.append(done)
        if len(seen) == moment:
            machines.workers[0].kill()
            machines.workers.pop(0).wait()

    check(machines, local, kill)
    assert len(seen) > moment


def test_where_all_workers_die_that_is_said_and_the_next_one_goes_on(machines, local, monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 1.0)
    seen, said = [], []

    def kill(done, total):
        seen.append(done)
        if len(seen) == 3:
            while machines.workers:
                machines.workers[0].kill()
                machines.workers.pop(0).wait()

    def start(message, *_):  # once it is said, not before
        said.append(str(message))
        machines.workers += [machines.start()]

    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = start
        check(machines, local, kill, processes=1)  # so that not all is done when they die
    (line,) = said
    assert f"the scheduler at {machines.address} has no worker any more" in line


def test_the_command_records_by_the_workers_and_survives_the_scheduler(machines, tmp_path):
    words = ("render", "cornell_unit", *OPTIONS, "--cluster", machines.address)
    done = castray(*words, "--spp", 4, "--record", "rec", "-o", "a.exr", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert not folder.whole(tmp_path / "rec").missing()
    assert castray("query", tmp_path / "rec", "depth >= 0").returncode in (0, 2)

    code = "import sys; from viewer.cli import main; sys.exit(main())"
    command = [sys.executable, "-c", code, *words, "--spp", "100000", "-o", "b.exr"]
    running = subprocess.Popen(
        command,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )
    machines.wait_for_work()
    with pytest.raises(subprocess.TimeoutExpired):
        running.wait(2.0)
    machines.scheduler.kill()
    said = running.communicate(timeout=20)[1].splitlines()
    assert running.returncode == 1
    assert len(said) == 2, said
    assert "is lost" in said[0]
    assert "the same command goes on" in said[1]
    assert (tmp_path / "b.exr.unfinished.npz").exists()
    again = castray(*words, "--spp", 100000, "-o", "b.exr", cwd=tmp_path)
    assert (again.returncode, again.stderr.count("\n")) == (2, 1)
    assert "no scheduler answers" in again.stderr
