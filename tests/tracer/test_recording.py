"""Recordings on disk: the same picture, the same Trace, parts that are whole or not there."""

import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
from collections import namedtuple

import numpy as np
import pytest
from cases import slow_but
from suite import ROOT

import tracer
from lessons import zoo
from tracer import trace
from tracer.trace import folder, parquet, recording

SMALL = {"width": 6, "height": 5, "spp": 3, "max_depth": 6}


@pytest.fixture
def few_a_part(monkeypatch):
    """Parts of a few paths."""
    monkeypatch.setattr(recording, "PART_BYTES", 60_000)
    monkeypatch.setattr(recording, "PATHS_IN_PART", 32)


def same(a, b):
    """Two Traces have the same numbers."""
    for name, column in a.paths.items():
        np.testing.assert_array_equal(column, b.paths[name], name)
    for kind, table in a.tables.items():
        other = b.tables[kind]
        for name in ("path", "step", "depth"):
            np.testing.assert_array_equal(getattr(table, name), getattr(other, name))
        assert table.columns.keys() == other.columns.keys()
        for name, column in table.columns.items():
            assert column.dtype == other[name].dtype, (kind, name)
            np.testing.assert_array_equal(column, other[name], f"{kind} {name}")


def digests(path):
    """{file: digest} of a folder's parts."""
    files = sorted(path.rglob("*.parquet"))
    return {str(file.relative_to(path)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


@pytest.mark.parametrize("level", ["paths", "events"])
@pytest.mark.parametrize("name", slow_but(("cornell_unit", "coloured_glass", "sky"), "sky"))
def test_the_picture_of_a_recorded_render_is_the_same(tmp_path, few_a_part, level, name):
    scene, settings = tracer.load(name), tracer.Settings(width=4, height=3, spp=20, max_depth=6)
    plain = tracer.render(scene, settings)
    recorded = tracer.record(scene, settings, tmp_path / "rec", level)
    for what in ("rgb", "variance", "samples", "rays", "dropped"):
        assert np.asarray(getattr(plain, what)).tobytes() == np.asarray(getattr(recorded, what)).tobytes(), (
            what
        )
    assert folder.opened(tmp_path / "rec").parts > 1


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("name", slow_but(("cornell_unit", "coloured_glass", "sky", "textures"), "sky"))
def test_a_recording_read_again_is_the_trace(tmp_path, few_a_part, name, precision):
    scene, settings = tracer.load(name), tracer.Settings(precision=precision, **SMALL)
    tracer.record(scene, settings, tmp_path / "rec", "events")
    read = tracer.read_trace(tmp_path / "rec")
    same(trace.gather(scene, settings), read)
    assert read.scene.name == name and read.settings == settings.at_size_of(scene)
    assert sum(part.size for part in trace.read_parts(tmp_path / "rec")) == read.size


@pytest.mark.parametrize("max_depth", [0, 1, 6])
@pytest.mark.parametrize("name", ["cornell_unit", "sky"])
def test_the_rows_of_paths_are_the_same_at_both_levels(tmp_path, name, max_depth):
    scene, settings = tracer.load(name), tracer.Settings(**SMALL | {"max_depth": max_depth})
    for level in folder.LEVELS:
        tracer.record(scene, settings, tmp_path / level, level)
    rows, whole = (tracer.read_trace(tmp_path / level) for level in folder.LEVELS)
    for name, column in whole.paths.items():
        np.testing.assert_array_equal(column, rows.paths[name], name)
    assert rows.column("hit", "p") is None and rows.vertices == 0


def test_a_recording_on_several_processes_has_the_same_bytes(tmp_path, few_a_part, monkeypatch):
    from tracer.engine import processes

    scene, settings = tracer.load("cornell_unit"), tracer.Settings(**SMALL)
    tracer.record(scene, settings, tmp_path / "one", "events")
    monkeypatch.setattr(processes, "WORTH_A_START", -1.0)
    tracer.record(scene, settings, tmp_path / "two", "events", workers=2)
    assert digests(tmp_path / "one") == digests(tmp_path / "two")


def test_a_bug_is_recorded_with_its_picture(tmp_path):
    scene, settings = tracer.load("cornell_unit"), tracer.Settings(bug="E01", **SMALL)
    picture = tracer.record(scene, settings, tmp_path / "rec", steps=zoo.planted(settings))
    plain = tracer.render(scene, settings, steps=zoo.planted(settings))
    assert picture.rgb.tobytes() == plain.rgb.tobytes()
    with pytest.raises(tracer.TracerError, match="needs its steps"):
        tracer.record(scene, settings, tmp_path / "other")


def test_a_scene_with_files_comes_along(tmp_path):
    (tmp_path / "here").mkdir()
    shutil.copytree(ROOT / "scenes" / "meshes", tmp_path / "here" / "meshes")
    shutil.copy(ROOT / "scenes" / "smooth_ball.toml", tmp_path / "here")
    settings = tracer.Settings(**SMALL)
    tracer.record(tracer.load(tmp_path / "here" / "smooth_ball.toml"), settings, tmp_path / "rec")
    shutil.rmtree(tmp_path / "here")
    shutil.move(tmp_path / "rec", tmp_path / "moved")
    read = tracer.read_trace(tmp_path / "moved")
    assert tracer.render(read.scene, read.settings).paths == read.size


def test_what_is_there_is_not_traced_again(tmp_path, few_a_part, monkeypatch):
    scene, settings = tracer.load("cornell_unit"), tracer.Settings(**SMALL)
    first = tracer.record(scene, settings, tmp_path / "rec", "events")
    whole = digests(tmp_path / "rec")
    gone = folder.opened(tmp_path / "rec").part(1)
    shutil.rmtree(gone)
    (tmp_path / "rec" / "part-00001.99.partial").mkdir()
    traced = []
    monkeypatch.setattr(
        recording, "_write", lambda *a, write=recording._write: (traced.append(a[1].number), write(*a))
    )
    again = tracer.record(scene, settings, tmp_path / "rec", "events")
    assert traced == [1]
    assert digests(tmp_path / "rec") == whole
    assert (again.rgb.tobytes(), again.rays) == (first.rgb.tobytes(), first.rays)


WORK = """
import sys, time, tracer
from tracer.trace import recording
recording.PART_BYTES = 20_000
write = recording._write
recording._write = lambda *a: (write(*a), print(a[1].number, flush=True), time.sleep(float(sys.argv[2])))
tracer.record(tracer.load("cornell_unit"), tracer.Settings(width=12, height=10, spp=4), sys.argv[1], "events")
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="kill -9 is not for Windows")
def test_a_recording_that_was_killed_goes_on_and_equals_the_uninterrupted_one(tmp_path):
    def begun(name, wait):
        command = [sys.executable, "-c", WORK, str(tmp_path / name), str(wait)]
        return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE)

    killed = begun("killed", 30)
    assert killed.stdout.readline().split() == [b"0"]
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    killed.stdout.close()
    there = digests(tmp_path / "killed")
    assert there
    with pytest.raises(tracer.TracerError, match="parts are there"):
        tracer.read_trace(tmp_path / "killed")
    for name in ("killed", "whole"):
        with begun(name, 0) as done:
            done.stdout.read()
        assert done.returncode == 0
    assert digests(tmp_path / "killed") == digests(tmp_path / "whole")
    assert there.items() <= digests(tmp_path / "killed").items()


def test_ctrl_c_while_a_part_is_written_stops_as_at_any_other_time(tmp_path):
    """DuckDB, which writes it, makes a RuntimeError of it."""
    with pytest.raises(KeyboardInterrupt), parquet.explained(tmp_path):
        raise RuntimeError("Query interrupted")
    with pytest.raises(RuntimeError, match="anything else"), parquet.explained(tmp_path):
        raise RuntimeError("anything else")


def test_another_recording_in_the_folder_is_refused(tmp_path):
    scene, settings = tracer.load("cornell_unit"), tracer.Settings(**SMALL)
    tracer.record(scene, settings, tmp_path / "rec")
    for other, level, said in (
        (tracer.Settings(**SMALL | {"spp": 4}), "paths", "spp 3, not 4"),
        (settings, "events", "level paths, not events"),
    ):
        with pytest.raises(tracer.TracerError, match=said):
            tracer.record(scene, other, tmp_path / "rec", level)
    with pytest.raises(tracer.TracerError, match="another scene"):
        tracer.record(tracer.load("furnace"), settings, tmp_path / "rec")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "letter.txt").write_text("dear", encoding="utf-8")
    with pytest.raises(tracer.TracerError, match="letter.txt"):
        tracer.record(scene, settings, tmp_path / "full")


def test_a_disk_without_room_is_noticed_before_anything_is_traced(tmp_path, monkeypatch):
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage(0, 0, 1000))
    with pytest.raises(tracer.TracerError, match="GB free"):
        tracer.record(tracer.load("cornell_unit"), tracer.Settings(**SMALL), tmp_path / "rec", "events")
    assert not (tmp_path / "rec").exists()


def test_the_estimate_of_the_size_is_above_it_and_not_far(tmp_path):
    scene, settings = (
        tracer.load("cornell_unit"),
        tracer.Settings(width=32, height=32, spp=8).at_size_of(tracer.load("cornell_unit")),
    )
    tracer.record(scene, settings, tmp_path / "rec", "events")
    estimate = recording.bytes_of_path(scene, settings) * recording.SHARE * 32 * 32 * 8
    assert 1.0 < estimate / folder.opened(tmp_path / "rec").bytes() < 2.5


def spoil_version(path):
    header = json.loads((path / "recording.json").read_text(encoding="utf-8"))
    (path / "recording.json").write_text(json.dumps(header | {"format": 7}), encoding="utf-8")


def cut(path):
    file = path / "part-00000" / "hit.parquet"
    file.write_bytes(file.read_bytes()[:-100])


def foreign(path):
    from tracer.trace import parquet

    parquet.write(path / "part-00000" / "hit.parquet", {"weather": np.arange(3)})


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (shutil.rmtree, "is not there"),
        (lambda path: (path / "recording.json").unlink(), "holds no recording"),
        (lambda path: (path / "recording.json").write_text("[1", encoding="utf-8"), "is not the JSON"),
        (lambda path: (path / "recording.json").write_text("[1]", encoding="utf-8"), "names no format"),
        (spoil_version, "format 7"),
        (lambda path: shutil.rmtree(path / "part-00000"), "0 of 1 parts"),
        (lambda path: (path / "part-00000" / "end.parquet").unlink(), "end.parquet: is not there"),
        (cut, "hit.parquet: is no whole Parquet file"),
        (foreign, "hit.parquet"),
        (lambda path: (path / "scene.json").write_text("{}", encoding="utf-8"), "scene.json"),
    ],
)
def test_a_spoiled_recording_is_one_clear_line(tmp_path, spoil, said):
    path = tmp_path / "rec"
    tracer.record(tracer.load("cornell_unit"), tracer.Settings(**SMALL), path, "events")
    spoil(path)
    with pytest.raises(tracer.TracerError, match=said) as refused:
        tracer.read_trace(path)
    assert "\n" not in str(refused.value)


def test_duckdb_alone_reads_the_parts(tmp_path):
    import duckdb

    path = tmp_path / "rec"
    tracer.record(tracer.load("cornell_unit"), tracer.Settings(**SMALL), path, "events")
    lit = duckdb.sql(f"SELECT count(*), avg(radiance_r) FROM '{path}/part-*/paths.parquet'").fetchall()
    assert lit[0][0] == 6 * 5 * 3 and lit[0][1] > 0.0
    most = duckdb.sql(
        f"SELECT max(abs(n_x * wi_x + n_y * wi_y + n_z * wi_z - cos)) FROM '{path}/*/bounce.parquet'"
    )
    assert most.fetchall()[0][0] < 1e-5  # a bounce carries the normal of its vertex
