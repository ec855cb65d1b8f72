"""Logs of programs that go their own ways: lamps left early, own probabilities, points beside walls."""

import json
import shlex

import numpy as np
import pytest
from logs import HEADER, INNER, OUTER, write_log
from suite import castray

import tracer
from tracer.trace.jsonl import geometry, read_log
from tracer.trace.pixels import pixel, without_gaps
from viewer import app
from viewer.caption import CAPTIONS
from viewer.cli import main
from viewer.words import Speaker

EYE, FLOOR, ON_LAMP = (np.array(p, float) for p in ((278, 273, -800), (450, 0, 110), (278, 548.7, 280)))


def way(a, b):
    return ((b - a) / np.linalg.norm(b - a)).tolist()


LAMP = {
    "path": 0, "x": 3, "y": 5, "sample": 0, "call": 1, "parent": 0, "depth": 1,
    "ray.o": FLOOR.tolist(), "ray.d": way(FLOOR, ON_LAMP), "returned": [0, 0, 0],
}  # fmt: skip
TO_LAMP = OUTER | {
    "ray.d": way(EYE, FLOOR), "hit.p": FLOOR.tolist(), "bounce.wi": LAMP["ray.d"], "indirect": [0, 0, 0],
    "returned": OUTER["direct"],
}  # fmt: skip


@pytest.fixture(scope="module")
def cornell():
    return tracer.load("cornell")


@pytest.fixture
def written(tmp_path):
    return lambda *lines, head=HEADER: write_log(tmp_path / "mine.jsonl", *lines, head=head)


def said(log):
    return [(finding.rule, finding.bug) for finding in tracer.examine(log.trace).causes]


def test_a_call_that_leaves_a_lamp_at_once_met_it(written, cornell):
    log = read_log(written(TO_LAMP, LAMP), cornell)
    assert said(log) == [] and log.trace.vertices == 2
    assert any("where there is a lamp" in note for note in log.notes)
    (last,) = log.trace.tables["hit"]["primitive"][1:]
    assert cornell.shapes[cornell.shape_of[last]].name == "lamp"


def test_a_call_that_meets_nothing_where_there_is_a_wall_is_told(written, cornell):
    none = {name: value for name, value in INNER.items() if name not in ("hit.p", "hit.n", "direct")}
    assert said(read_log(written(OUTER, none | {"returned": [0, 0, 0]}), cornell))[0][0] == "escape-free"


@pytest.mark.parametrize(("q", "fires"), [(0.6, False), (0.0, True)])
def test_a_program_may_choose_its_survival_probability_vertex_by_vertex(written, cornell, q, fires):
    head = {name: value for name, value in HEADER.items() if name != "roulette"}
    log = read_log(written(OUTER, INNER | {"roulette.probability": q}, head=head), cornell)
    assert "roulette" in log.trace.free
    assert ("roulette-probability" in [rule for rule, _ in said(log)]) == fires
    declared = read_log(written(OUTER, INNER | {"roulette.probability": 0.6}), cornell)
    assert "roulette-probability" in [rule for rule, _ in said(declared)]


def test_points_beside_a_wall_are_named_with_it(written, cornell):
    above = FLOOR + [0, 3, 0]
    beside = TO_LAMP | {"ray.d": way(EYE, above), "hit.p": above.tolist(), "roulette.survived": False}
    findings = tracer.examine(read_log(written(beside), cornell).trace).findings
    (finding,) = [f for f in findings if f.rule == "on-surface"]
    assert finding.bug is None and "floor" in finding.explanation


def test_the_command_of_each_finding_opens_the_log_at_its_event(tmp_path, monkeypatch, capsys):
    spare = [{k: v for k, v in line.items() if not k.startswith("roulette")} for line in (OUTER, INNER)]
    spare = [line | {"path": 7, "sample": 4, "direct": [0.9, 0.9, 0.9]} for line in spare]
    monkeypatch.chdir(tmp_path)
    write_log(tmp_path / "my log.jsonl", OUTER, INNER, *spare, head={"castray": 1, "hemisphere": "uniform"})
    with pytest.raises(SystemExit):
        main(["doctor", "my log.jsonl", "--scene", "cornell", "--json"])
    opened, findings = [], json.loads(capsys.readouterr().out)["findings"]
    monkeypatch.setattr(app, "_run", lambda session, *_: opened.append(session))
    assert {finding["first"]["sample"] for finding in findings} == {4}  # the pixel's second path
    for finding in findings:
        assert "max-depth" not in finding["command"]
        with pytest.raises(SystemExit):
            main(shlex.split(finding["command"])[1:])
        session, first = opened.pop(), finding["first"]
        assert (session.cursor.path, session.path.sample) == (1, 4)
        if first["kind"]:
            assert (session.event.kind.name, session.event.depth) == (first["kind"], first["depth"])


def test_why_a_path_ended_is_not_made_up_where_no_line_says_it(written, cornell):
    plain = [{k: v for k, v in call.items() if not k.startswith("roulette")} for call in (OUTER, INNER)]
    alone = {k: v for k, v in plain[0].items() if not k.startswith(("bounce", "indirect"))}
    head = {name: value for name, value in HEADER.items() if name != "roulette"}
    log = read_log(written(*plain, alone | {"path": 1, "x": 4, "returned": [0.25] * 3}, head=head), cornell)
    (path,) = pixel(without_gaps(log.trace), 4, 5).paths
    assert path.end == "unsaid"
    said = CAPTIONS["end"](path.events[-1].values, cornell, Speaker("en"))
    assert said.startswith("The path is over; why was not recorded.")


def test_a_log_of_another_scene_is_asked_whether_it_is_one(written):
    log = read_log(written(OUTER, INNER), tracer.load("furnace"))
    assert any("is the log of another scene?" in note for note in log.notes)


@pytest.mark.slow
def test_a_log_in_which_little_is_said_is_not_called_right_without_a_word(written):
    path = written(OUTER, INNER)
    done = castray("doctor", path, "--scene", "cornell")
    assert done.returncode == 0 and "light.q" in done.stdout and "not all laws" in done.stdout
    assert not json.loads(castray("doctor", path, "--scene", "cornell", "--json").stdout)["findings"]


def test_points_that_rounding_puts_beside_an_edge_lie_on_the_face():
    scene = tracer.load("many_lights").at(tracer.Settings(precision=64))
    panel = 37
    q = np.array([[-5.3088], [3.95], [2.045]])  # on its edge, in six digits
    beside = q + [[0.0], [0.0], [1e-6]]
    wi = np.array([[0.443258], [0.495161], [-0.74722]])
    for p in (q, beside):
        assert geometry.primitives_at(scene, p - wi, wi, p).tolist() == [panel]
    away = q + [[0.0], [-0.2], [0.0]]
    assert geometry.primitives_at(scene, away - wi, wi, away).tolist() == [-1]


def test_what_is_logged_at_some_vertices_only_is_told_with_their_number(written, cornell):
    q = {"light.q": ON_LAMP.tolist()}
    some, all_ = OUTER | q | {"light.visible": True}, INNER | q
    at_some, at_all = (
        read_log(written(some, inner), cornell).notes for inner in (all_, all_ | {"light.visible": True})
    )
    assert "light.visible: tested at the 1 of 2 such events that log it" in at_some
    assert not any("tested at" in note for note in at_all)
