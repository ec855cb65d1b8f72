"""What is taken along from the viewer is what the commands write, and asks nobody for anything."""

import io
import json
import re
from contextlib import redirect_stdout
from copy import copy
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import tracer
from lessons.zoo import planted
from tracer.trace import gather
from viewer.checking.learner import settings_of
from viewer.cli import main
from viewer.comparing.rival import Rival
from viewer.panels import share
from viewer.session import Session
from viewer.sharing.files import FILES, Moment
from viewer.sharing.report import report
from viewer.words import Speaker

WORDS = ("cornell_unit", "--size", "16", "16", "--spp", "4", "--max-depth", "4", "--bug", "D10")


def said(*words):
    """What a command prints; its exit code."""
    out = io.StringIO()
    with redirect_stdout(out), pytest.raises(SystemExit) as ended:
        main([str(word) for word in words])
    return out.getvalue(), ended.value.code


@pytest.fixture(scope="module")
def moment():
    """The moment of a session at a path, with the picture that the command renders."""
    settings = tracer.Settings(width=16, height=16, spp=4, max_depth=4, bug="D10")
    session = Session(tracer.load("cornell_unit"), settings, None)
    session.stand((7, 11, 2, 1))
    session.picture = tracer.render(session.scene, settings, steps=planted(settings))
    return Moment.of(session, Speaker("en"))


def test_the_path_is_what_castray_inspect_prints(moment):
    name, data = moment.file("path.json")
    assert name == "cornell_unit-7-11-2.json"
    printed, _ = said("inspect", *WORDS, "--pixel", 7, 11, "--sample", 2, "--json")
    assert data.decode("ascii") == printed


def test_a_supposed_path_is_what_castray_inspect_prints(moment):
    what = {(0, "bounce"): (30.0, 45.0)}
    data = moment.__class__(**{**vars(moment), "suppositions": what}).file("path.json")[1]
    words = ("--pixel", 7, 11, "--sample", 2, "--what-if", "0.bounce=30,45", "--json")
    assert json.loads(data) == json.loads(said("inspect", *WORDS, *words)[0])


@pytest.mark.parametrize("ending", ["png", "exr"])
def test_the_picture_is_what_castray_render_writes(moment, ending, tmp_path):
    (tmp_path / f"shared.{ending}").write_bytes(moment.file(f"picture.{ending}")[1])
    said("render", *WORDS, "-o", tmp_path / f"rendered.{ending}", "--json")
    shared, rendered = (tracer.read(tmp_path / f"{name}.{ending}") for name in ("shared", "rendered"))
    assert np.array_equal(shared.rgb, rendered.rgb)
    assert shared.notes == rendered.notes


def test_the_report_has_every_finding_and_law_of_castray_doctor(moment, tmp_path):
    page = moment.file("doctor.html")[1].decode("utf-8")
    printed, code = said("doctor", *WORDS, "--html", tmp_path / "report.html", "--json")
    diagnosis = json.loads(printed)
    assert code == 1 and (tmp_path / "report.html").read_text(encoding="utf-8") == page
    causes = [f for f in diagnosis["findings"] if f["follows"] is None]
    assert re.findall(r'data-rule="([^"]+)" data-bug="([^"]*)"', page) == [
        (f["rule"], f["bug"] or "") for f in causes
    ]
    states = dict(re.findall(r'data-rule="([^"]+)" data-state="([^"]+)"', page))
    assert states == {rule["rule"]: rule["state"] for rule in diagnosis["rules"]}
    assert "--bug D10" in causes[0]["command"] and causes[0]["command"] in page
    assert f">{max(rule['checked'] for rule in diagnosis['rules']):,}<" in page


@pytest.mark.parametrize(("language", "words"), [("en", "bug"), ("zh", "错误")])
def test_the_report_speaks_of_a_bug_only_where_one_is_planted(language, words):
    scene, say = tracer.load("furnace"), Speaker(language)
    for bug in ("", "E01"):
        settings = tracer.Settings(width=4, height=4, spp=1, bug=bug)
        page = report(tracer.examine(gather(scene, settings)), scene, settings, 16, say, again=False)
        about = re.search(r'<p class="dim">(.*?)</p>', page)[1]
        assert (words in about) == bool(bug) and about.endswith(bug or "0")


@pytest.mark.parametrize("name", [name for name in FILES if name.endswith(".html")])
def test_a_page_names_nothing_outside_itself(moment, name):
    page = moment.file(name)[1].decode("utf-8")
    assert not re.search(r"(?:src|href)=[\"'](?!data:)", page) and "url(" not in page and "http" not in page


def test_the_paths_in_3d_are_what_castray_inspect_writes(tmp_path):
    file = tmp_path / "view.html"
    said("inspect", *WORDS, "--pixel", 7, 11, "--html", file, "--json")
    data = re.search(r'id="paths">(.*?)</script>', file.read_text(encoding="utf-8"), re.DOTALL)[1]
    place = json.loads(data)["places"][0]
    assert (place["x"], place["y"], len(place["paths"])) == (7, 11, 4)


def test_a_page_that_cannot_be_written_is_said_before_anything_is_traced(tmp_path, capsys):
    assert said("doctor", *WORDS, "--html", tmp_path / "none" / "report.html") == ("", 2)
    assert "there is no folder" in capsys.readouterr().err


def test_without_a_picture_it_says_so(moment):
    with pytest.raises(tracer.TracerError, match="no picture yet"):
        moment.__class__(**{**vars(moment), "picture": None}).file("picture.png")


class Watched:
    """A learner's file that is looked at."""

    file, scene, settings = "mine tracer.py", "cornell", replace(settings_of(None), spp=16)


@pytest.mark.parametrize(
    ("name", "shelf", "against", "again"),
    [
        (None, {}, "", "castray view '#scene=cornell_unit&width=4&height=4&spp=2&x=1&y=1&path=0&event=0'"),
        (None, {"gl": SimpleNamespace(asked="auto")}, "right", "castray view '#... --engine auto"),
        (None, {}, "my box.png", "castray view '#... --compare 'my box.png'"),
        ("a.toml", {}, "D01", "castray view a.toml --size 4 4 --spp 2 --compare D01"),
        (
            None,
            {"watched": Watched},
            "right",
            "castray view 'mine tracer.py' --scene cornell --spp 16 --compare right",
        ),
    ],
)
def test_what_starts_the_viewer_again_says_what_no_link_does(name, shelf, against, again):
    scene = copy(tracer.load("cornell_unit"))
    scene.name = scene.name if name is None else name
    session = Session(scene, tracer.Settings(width=4, height=4, spp=2), None)
    session.stand((1, 1, 0, 0))
    session.shelf.update(shelf)
    session.against, session.rivals = against, {"my box.png": Rival("my box.png")}
    begin, _, end = again.partition("...")
    said = share.show(session, Speaker("en"))["again"]
    assert said == again if not end else said.startswith(begin) and said.endswith(end)
