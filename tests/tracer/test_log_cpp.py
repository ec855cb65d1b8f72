"""castray.h in a recursive C++ tracer of the homework's box: what it logs, and what the doctor says of it."""

import json
import os
import shutil
import subprocess

import numpy as np
import pytest
from suite import ROOT, missing

import tracer
from tracer.trace.jsonl import header_file, read_log

SOURCE = ROOT / "tests" / "cpp" / "castray_box.cpp"
SIZE, SPP = 32, 4  # of its picture
STRICT = ("-std=c++11", "-O1", "-Wall", "-Wextra", "-pedantic", "-Werror", "-pthread")

pytestmark = pytest.mark.slow


@pytest.fixture(scope="session")
def built(tmp_path_factory):
    """Builds the tracer with some compiler options, once each."""
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        missing("a C++ compiler")
    folder, done = tmp_path_factory.mktemp("cpp"), {}

    def build(*options):
        if options not in done:
            program = folder / f"box{len(done)}"
            words = [compiler, *STRICT, *options, "-I", header_file().parent, SOURCE, "-o", program]
            subprocess.run(words, check=True)
            done[options] = program
        return done[options]

    return build


@pytest.fixture
def logged(built, tmp_path):
    """Runs it, and gives the file that it logs to, and what it prints."""

    def run(bug="none", level=2, seed=1, threads=1, pixels="all", options=(), fine=True):
        path = tmp_path / "box.jsonl"
        words = [built(*options), bug, str(level), str(seed), str(threads)]
        env = os.environ | {"CASTRAY_LOG": str(path), "CASTRAY_PIXELS": pixels}
        done = subprocess.run(words, env=env, capture_output=True, encoding="ascii", timeout=120, check=False)
        assert (done.returncode == 0) == fine, done.stderr
        return path, done.stdout

    return run


@pytest.fixture(scope="module")
def cornell():
    return tracer.load("cornell")


def findings(path, scene):
    """(rule, bug) of the causes that the doctor finds in a log."""
    return [(finding.rule, finding.bug) for finding in tracer.examine(read_log(path, scene).trace).causes]


DOUBLE = ("-DDOUBLE", "-DCASTRAY_BITS=64", "-DCASTRAY_DIGITS=17")


@pytest.mark.parametrize(
    ("bug", "level", "options"),
    [
        ("none", 2, ()),
        ("none", 1, ()),
        ("none", 0, ()),
        ("PEEK", 2, ()),
        ("PEEK", 1, ()),
        ("none", 2, ("-DCASTRAY_DIGITS=6",)),
        ("none", 2, DOUBLE),
        ("none", 2, ('-DDECLARED=""',)),
        ("none", 1, ('-DDECLARED=""',)),
        ("none", 0, ('-DDECLARED=""',)),
    ],
)
def test_a_right_log_gives_no_findings_however_much_it_says(logged, cornell, bug, level, options):
    path, _ = logged(bug, level, seed=7, options=options)
    assert findings(path, cornell) == []


def test_roulette_of_which_the_log_has_no_word_is_read_off_what_pays_for_it(logged, cornell):
    """All else is logged, so that throughput can be tested, and grows by 1/q too much."""
    path, _ = logged("none", 2, seed=7)
    lines = [json.loads(line) for line in path.read_text(encoding="ascii").splitlines()]
    lines = [{k: v for k, v in line.items() if not k.startswith("roulette")} for line in lines]
    path.write_text("\n".join(json.dumps(line) for line in lines) + "\n", encoding="ascii")
    log = read_log(path, cornell)
    assert log.read_off["roulette"] == "0.8" and "max_depth" not in log.read_off
    assert findings(path, cornell) == []
    for call in lines[1:]:
        if "indirect" in call:  # paid for with 0.64, and played with 0.8
            call["indirect"] = [v / 0.8 for v in call["indirect"]]
            del call["returned"]
    path.write_text("\n".join(json.dumps(line) for line in lines) + "\n", encoding="ascii")
    assert read_log(path, cornell).read_off["roulette"] == "off"


def test_who_looks_ahead_may_log_roulette_only_where_it_lets_go_on(logged, cornell):
    path, _ = logged("PEEK", 2, seed=7)
    lines = [json.loads(line) for line in path.read_text(encoding="ascii").splitlines()]
    for call in lines[1:]:
        call.pop("bounce.wi", None)
        if not call.pop("roulette.survived", True):
            del call["roulette.probability"]
    path.write_text("\n".join(json.dumps(line) for line in lines) + "\n", encoding="ascii")
    assert findings(path, cornell) == []


@pytest.mark.parametrize(
    ("bug", "found"),
    [
        ("E01", ("emission-weight", "E01")),
        ("E02", ("emission-weight", "E02")),
        ("E04", ("depth", None)),
        ("D01", ("light-visible", "D01")),
        ("D06", ("light-f", "D06")),
        ("D10", ("light-term", "D10")),
        ("D11", ("light-term", "D11")),
        ("R01", ("roulette-weight", "R01")),
        ("B02", ("throughput", "B02")),
        ("B03", ("light-f", "B03")),
        ("B05", ("bounce-side", None)),
        ("F01", ("ledger", None)),
        ("W01", ("wo", None)),
    ],
)
def test_a_planted_bug_is_found(logged, cornell, bug, found):
    path, _ = logged(bug)
    rule, name = found
    first = findings(path, cornell)[0]
    assert first[0] == rule
    assert name is None or first[1] == name


@pytest.mark.parametrize(("bug", "rule"), [("R01", "roulette-weight"), ("B02", "throughput")])
def test_terms_alone_show_a_bug_of_theirs(logged, cornell, bug, rule):
    path, _ = logged(bug, level=1)
    assert findings(path, cornell)[0] == (rule, bug)


def test_the_rebuilt_trace_adds_up_to_what_castray_returned(logged, cornell):
    path, printed = logged()
    trace = read_log(path, cornell).trace
    total = np.zeros((3, trace.size))
    for kind in ("hit", "light", "escape"):
        for channel in range(3):
            gain = trace.tables[kind]["contribution"][channel]
            total[channel] += np.bincount(trace.tables[kind].path, gain, trace.size)
    np.testing.assert_allclose(total, trace.paths["radiance"], rtol=1e-5)
    assert trace.size >= 0.99 * SIZE * SIZE * SPP
    mean = trace.paths["radiance"].sum(axis=1) / (SIZE * SIZE * SPP)
    np.testing.assert_allclose(mean, [float(word) for word in printed.split()], rtol=0.01)


def test_the_log_changes_nothing_and_switched_off_is_not_there(built, logged):
    off = built("-DCASTRAY_OFF")
    plain = subprocess.run([off], capture_output=True, encoding="ascii", check=True).stdout
    assert plain == logged()[1] == logged(pixels="8")[1]
    assert b"castray_log" not in off.read_bytes()
    assert b"castray_log" in built().read_bytes()


def test_threads_log_the_same_paths(logged):
    def paths(path):
        lines = path.read_text(encoding="ascii").splitlines()[1:]
        calls = [json.loads(line) for line in lines]
        return len(calls), {(call["x"], call["y"], call["sample"]) for call in calls}

    path, _ = logged(threads=1)
    _, one = paths(path)
    path, _ = logged(threads=4)
    count, four = paths(path)
    assert one == four and len(four) == SIZE * SIZE * SPP and count > len(four)


@pytest.mark.parametrize(
    ("pixels", "count"), [("", 4), ("16", 4), ("8", 16), ("all", SIZE * SIZE), ("3,5 31,0 7,7", 3)]
)
def test_pixels_are_chosen_by_the_environment(logged, pixels, count):
    path, _ = logged(pixels=pixels)
    calls = [json.loads(line) for line in path.read_text(encoding="ascii").splitlines()[1:]]
    assert len({(call["x"], call["y"]) for call in calls}) == count
    assert {call["sample"] for call in calls} == set(range(SPP))
    if "," in pixels:
        assert {(call["x"], call["y"]) for call in calls} == {(3, 5), (31, 0), (7, 7)}


def test_lines_survive_a_crash(logged, cornell):
    path, _ = logged("crash", fine=False)
    log = read_log(path, cornell)
    assert log.trace.size > 0 and not log.read.mistaken
    assert any("lack a call" in note for note in log.notes)


def test_a_vertex_takes_less_than_850_bytes_with_all_that_can_be_said(logged, cornell):
    path, _ = logged()
    assert path.stat().st_size < 850 * read_log(path, cornell).trace.vertices


def test_the_header_is_ascii_and_its_lines_are_short():
    text = header_file().read_bytes()
    assert text.isascii() and max(map(len, text.splitlines())) <= 120


def test_a_mirrored_picture_is_told_and_can_be_declared(logged, cornell):
    path, _ = logged()
    head, *calls = (json.loads(line) for line in path.read_text(encoding="ascii").splitlines())
    turned = [call | {"x": SIZE - 1 - call["x"]} for call in calls]

    def notes(head):
        path.write_text("\n".join(map(json.dumps, [head, *turned])) + "\n", encoding="ascii")
        return [note for note in read_log(path, cornell).notes if "mirrored" in note]

    assert notes(head) == ['your picture is mirrored: declare "x": "left" in the header']
    assert notes(head | {"x": "left"}) == []
    assert findings(path, cornell) == []
