"""A recording in the viewer: its scene, its settings, the place asked for."""

import json
import shutil

import numpy as np
import pytest

import tracer
from lessons import zoo
from tracer.trace import folder
from viewer import app as viewer_app
from viewer.cli import main
from viewer.recorded import compared, is_recording
from viewer.session import Session

SETTINGS = tracer.Settings(width=6, height=5, spp=3, max_depth=5, bug="E01")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    path, steps = tmp_path_factory.mktemp("recorded") / "box", zoo.planted(SETTINGS)
    tracer.record(tracer.load("cornell_unit"), SETTINGS, path, "events", steps=steps)
    return path


@pytest.fixture
def box(recorded, tmp_path):
    """A recording of one test's own."""
    return shutil.copytree(recorded, tmp_path / "box")


@pytest.fixture
def opened(monkeypatch):
    """The sessions that the viewer would have shown."""
    sessions = []
    monkeypatch.setattr(viewer_app, "_run", lambda session, *_: sessions.append(session))
    return sessions


def run(*words):
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in words])
    return ended.value.code


def test_a_recording_opens_where_its_scene_would_at_an_event_that_gives_light(box, opened, capsys):
    assert run("view", box, "--no-browser") == 0
    (session,) = opened
    alone = Session(session.scene, SETTINGS, None)
    alone.stand(None)
    assert session.cursor == alone.cursor
    assert np.any(session.event.values["contribution"] > 0)
    assert session.settings == SETTINGS
    assert capsys.readouterr().err == ""


@pytest.mark.slow
def test_the_command_that_a_query_prints_opens_the_event(box, opened, capsys):
    import shlex

    assert run("query", box, "kind = 'light' AND NOT visible", "--json") == 0
    answer = json.loads(capsys.readouterr().out)
    first = answer["found"][0]
    assert run(*shlex.split(first["view"])[1:]) == 0
    (session,) = opened
    assert session.event.kind.name == "light" and not session.event.values["visible"]
    assert session.path.sample == first["sample"] and session.event.depth == first["depth"]
    assert first["link"].startswith("#scene=cornell_unit&")


def test_a_recording_from_another_machine_is_compared(box):
    place = folder.whole(box)
    scene = tracer.load("cornell_unit")
    assert compared(place, scene, 2, 3) is None
    place.header["fingerprint"]["processor"] = "abacus"
    said = compared(place, scene, 2, 3)
    assert "abacus" in said and "is the same here" in said
    place.header["settings"]["seed"] = 5  # what is traced again is another path
    assert "is not the same here" in compared(folder.Folder(box, place.header), scene, 2, 3)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("view", "box#x=99&y=0"), "outside the picture"),
        (("view", "box#y=0"), "y without x of the pixel"),
        (("view", "box", "--spp", "4"), "has its own settings"),
        (("query", "box", "depth > 0", "--limit", "0"), "limit"),
        (("query", "box"), "give a condition"),
        (("query", "nowhere", "depth > 0"), "nowhere: is not there"),
        (("query", "box", "--break", "sometimes"), "choose one of nan"),
        (("query", "box", "SELECT 1", "--mask", "m.png"), "mask"),
        (("query", "box", "depth > 0", "--mask", "m.gif"), ".gif"),
        (("render", "cornell_unit", "--record-level", "events"), "record_level"),
        (("render", "cornell_unit", "--record", "box", "--until-error", "0.1"), "record"),
        (("render", "cornell_unit", "--record", "box"), "another folder"),
        (("render", "cornell_unit", "--record", "new", "--record-level", "all"), "paths, events"),
    ],
)
def test_what_cannot_be_is_one_line(box, opened, monkeypatch, capsys, words, said):
    monkeypatch.chdir(box.parent)
    assert run(*words) == 2
    out, err = capsys.readouterr()
    assert out == "" and said in err and len(err.splitlines()) == 1, err
    assert sorted(path.name for path in box.parent.iterdir()) == ["box"]


@pytest.mark.slow
def test_the_mask_shows_the_pixels_that_match(box, monkeypatch, capsys):
    monkeypatch.chdir(box.parent)
    assert run("query", "box", "x = 2 AND y = 3", "--mask", "m.npy") == 0
    shown = tracer.read("m.npy")
    rgb = shown.rgb if hasattr(shown, "rgb") else shown
    assert rgb[3, 2, 0] == 1.0 and rgb[3, 2, 1] < 0.5
    others = [rgb[y, x] for y in range(5) for x in range(6) if (x, y) != (2, 3)]
    assert all(pixel[0] == pixel[1] == pixel[2] for pixel in others)


def test_a_built_in_scene_stays_one_beside_a_folder_of_its_name(tmp_path, monkeypatch):
    (tmp_path / "cornell_unit").mkdir()
    monkeypatch.chdir(tmp_path)
    assert not is_recording("cornell_unit")
    (tmp_path / "mine").mkdir()
    assert is_recording("mine")
