"""`castray twin` on the command line."""

import json
import shlex

import pytest

import tracer
from lessons import zoo
from viewer import app as viewer_app
from viewer.cli import main

pytestmark = pytest.mark.slow

SMALL = ("--size", 8, 6, "--spp", 4, "--integrator", "direct")


def run(*words):
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in words])
    return ended.value.code


@pytest.fixture(autouse=True)
def narrow(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    """Recordings of the right tracer, a wrong one, another seed, and rows of paths only; two empty logs."""
    folder = tmp_path_factory.mktemp("twins")
    scene = tracer.load("cornell_unit")
    for name, options, level in (
        ("right", {}, "events"),
        ("wrong", {"bug": "D01"}, "events"),
        ("seed", {"seed": 1}, "events"),
        ("rows", {}, "paths"),
    ):
        settings = tracer.Settings(width=8, height=6, spp=4, integrator="direct", **options)
        tracer.record(scene, settings, folder / name, level, steps=zoo.planted(settings))
    for name in ("mine.jsonl", "yours.jsonl"):
        (folder / name).touch()
    return folder


@pytest.fixture
def opened(monkeypatch):
    """The sessions that the viewer would have shown."""
    sessions = []
    monkeypatch.setattr(viewer_app, "_run", lambda session, *_: sessions.append(session))
    return sessions


def test_right_and_wrong_in_step_say_where_they_part_in_80_columns(capsys):
    assert run("twin", "cornell", *SMALL, "--bug", "D10") == 1
    out, err = capsys.readouterr()
    for words in ("D10", "light sample", "contribution", "standard error", "all before it is the same"):
        assert words in out
    assert err == ""
    said = [line for line in out.splitlines() if "castray " not in line]
    assert max(map(len, said)) <= 80


def test_no_difference_is_said_and_is_code_0(capsys):
    assert run("twin", "cornell", *SMALL, "--bug", "P01") == 0
    out = capsys.readouterr().out
    assert "No event differs" in out and "costs time only" in out
    assert run("twin", "cornell", "--size", 8, 6, "--spp", 1, "--integrator", "walk", "--bug", "D10") == 0
    assert "\ncastray twin cornell --bug D10 --integrator direct" in capsys.readouterr().out


def test_the_commands_it_prints_show_the_event(capsys, opened):
    assert run("twin", "cornell_unit", *SMALL, "--bug", "D01", "--limit", 1, "--json") == 1
    (first,) = json.loads(capsys.readouterr().out)["largest"]
    for commands, step, kind, seen in zip(
        first["commands"], first["steps"], first["kinds"], first["numbers"]["visible"], strict=True
    ):
        inspect, view = (shlex.split(command)[1:] for command in commands)
        assert run(*inspect, "--json") == 0
        (path,) = json.loads(capsys.readouterr().out)["samples"]
        assert (path["events"][step]["kind"], path["events"][step]["visible"]) == (kind, seen)
        assert run(*view, "--no-browser") == 0
        session = opened.pop()
        assert session.event.kind.name == kind and session.event.values["visible"] == seen
        assert (session.cursor.x, session.cursor.y) == (first["x"], first["y"])


def test_two_recordings_are_compared_and_open_where_they_part(recordings, capsys, opened):
    right, wrong = recordings / "right", recordings / "wrong"
    assert run("twin", right, right) == 0
    capsys.readouterr()
    assert run("twin", right, wrong, "--json") == 1
    found = json.loads(capsys.readouterr().out)
    assert found["names"] == [str(right), str(wrong)] and found["alone"] == [0, 0]
    assert {cause["what"] for cause in found["causes"]} == {"visible"}
    first = found["largest"][0]
    for (command,), seen in zip(first["commands"], first["numbers"]["visible"], strict=True):
        assert run(*shlex.split(command)[1:], "--no-browser") == 0
        assert opened.pop().event.values["visible"] == seen
    assert run("twin", right, wrong) == 1
    out = capsys.readouterr().out
    assert max(len(line) for line in out.splitlines() if "castray " not in line and "/" not in line) <= 80


def test_two_logs_are_compared(tmp_path, capsys):
    header = {"castray": 1, "tracer": "mine", "bits": 64, "digits": 17}
    hit = {"kind": "hit", "x": 3, "y": 5, "sample": 0, "step": 1, "depth": 0, "p": [278, 0, 110], "t": 5.0}
    for name, t in (("a.jsonl", 5.0), ("b.jsonl", 6.0)):
        lines = (header, hit | {"t": t})
        (tmp_path / name).write_text("\n".join(map(json.dumps, lines)) + "\n", encoding="utf-8")
    one, other = tmp_path / "a.jsonl", tmp_path / "b.jsonl"
    assert run("twin", one, one, "--scene", "cornell") == 0
    capsys.readouterr()
    assert run("twin", one, other, "--scene", "cornell", "--json") == 1
    (cause,) = json.loads(capsys.readouterr().out)["causes"]
    assert (cause["what"], cause["example"]["numbers"]["t"]) == ("t", [5.0, 6.0])
    assert run("twin", one, other, "--scene", "cornell") == 1
    out = capsys.readouterr().out
    assert "were the random numbers the same?" in out and "for every path" in " ".join(out.split())
    assert f"castray view '{other}#x=3&y=5&path=0&event=0' --scene cornell" in out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("right", "seed"), "seed is 0 in right and 1 in seed"),
        (("right", "rows"), "--record-level events"),
        (("right",), "name the other one"),
        (("right", "nowhere"), "neither a recording"),
        (("right", "wrong", "--spp", "4"), "leave out the path options"),
        (("right", "wrong", "--limit", "0"), "limit"),
        (("cornell",), "--bug"),
        (("cornell", "--bug", "X99"), "X99"),
        (("cornell", "--bug", "D10", "--scene", "cornell"), "--scene"),
        (("mine.jsonl", "yours.jsonl"), "--scene"),
    ],
)
def test_what_cannot_be_compared_is_one_line_and_code_2(recordings, monkeypatch, capsys, words, said):
    monkeypatch.chdir(recordings)
    assert run("twin", *words) == 2
    out, err = capsys.readouterr()
    assert out == "" and said in err and len(err.splitlines()) == 1, err
