"""`assert_healthy`, and what of a trace proves nothing."""

import json

import pytest
from cases import loaded

import tracer
from lessons import zoo
from tracer.doctor import examine
from tracer.testing import assert_healthy
from tracer.trace import gather
from tracer.trace.jsonl import read_log

SMALL = {"width": 8, "height": 8, "spp": 4, "integrator": "direct"}
HEADER = {"castray": 1, "tracer": "mine", "hemisphere": "uniform", "roulette": 0.8, "digits": 15, "bits": 64}
CALL = {
    "path": 0, "x": 3, "y": 5, "sample": 0, "call": 0, "parent": -1, "depth": 0,
    "ray.o": [278, 273, -800], "ray.d": [0.0, -0.28734788556634544, 0.9578262852211514],
    "hit.p": [278, 0, 110], "hit.n": [0, 1, 0], "light.q": [300.0, 548.7, 280.0],
    "roulette.probability": 0.8, "roulette.survived": False,
}  # fmt: skip


@pytest.fixture
def log(tmp_path):
    def write(**fields):
        path = tmp_path / "mine.jsonl"
        path.write_text("".join(json.dumps(line) + "\n" for line in (HEADER, CALL | fields)), "utf-8")
        return path

    return write


@pytest.fixture
def wrong(tmp_path):
    """A recording of a tracer that forgets the surface cosine."""
    settings = tracer.Settings(bug="D10", **SMALL)
    tracer.record(loaded("cornell"), settings, tmp_path / "box", "events", steps=zoo.planted(settings))
    return tmp_path / "box"


def test_a_right_trace_is_healthy_in_memory_and_on_disk(tmp_path):
    settings = tracer.Settings(**SMALL)
    assert_healthy(gather(loaded("cornell"), settings))
    tracer.record(loaded("cornell"), settings, tmp_path / "box", "events")
    assert_healthy(tmp_path / "box")


def test_a_wrong_trace_is_told_by_law_numbers_place_and_command():
    settings = tracer.Settings(bug="D10", **SMALL)
    with pytest.raises(AssertionError) as failed:
        assert_healthy(gather(loaded("cornell"), settings, zoo.planted(settings)))
    said = str(failed.value)
    for words in (
        "light-term",
        "D10",
        "recorded",
        "right",
        "first at pixel",
        "castray inspect cornell --pixel",
    ):
        assert words in said
    assert "--bug D10" in said


def test_a_wrong_recording_names_the_command_that_opens_it(wrong):
    with pytest.raises(AssertionError, match=r"castray view '.*box#x=\d+&y=\d+&path=\d+&event=\d+'"):
        assert_healthy(wrong)


def test_a_wrong_log_names_the_command_that_opens_it(log):
    with pytest.raises(AssertionError, match=r"castray view '.*#x=3&y=5&path=0&event=\d' --scene cornell"):
        assert_healthy(log(**{"light.cos": 0.9}), "cornell")


def test_what_cannot_be_judged_is_not_healthy(tmp_path, log):
    tracer.record(loaded("cornell"), tracer.Settings(**SMALL), tmp_path / "rows", "paths")
    with pytest.raises(AssertionError, match="no law could be held"):
        assert_healthy(tmp_path / "rows")
    with pytest.raises(tracer.TracerError, match="name the scene"):
        assert_healthy(log())


def test_what_a_law_was_asked_for_cannot_prove_it(log):
    states = {v.rule.id: v for v in examine(read_log(log(), loaded("cornell")).trace).rules}
    for rule in ("light-f", "light-cos", "light-distance", "ledger", "emission"):
        assert states[rule].state == "not_testable", rule
    assert states["light-f"].missing == "light.f is worked out by this law"
    given = log(**{"light.f": [0.5, 0.5, 0.5], "light.cos": 0.9})
    states = {v.rule.id: v.state for v in examine(read_log(given, loaded("cornell")).trace).rules}
    assert states["light-f"] == states["light-cos"] == "fired"
