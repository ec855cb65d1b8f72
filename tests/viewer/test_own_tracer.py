"""A learner's tracer in the viewer: run again when its file is saved; mistakes never take the page away."""

import shlex
from dataclasses import replace
from html import escape
from pathlib import Path

import numpy as np
import pytest
from logs import INNER, OUTER, write_log

import tracer
from tracer.learner import starter
from viewer import app
from viewer.checking import report
from viewer.checking.learner import settings_of
from viewer.checking.submission import row_of
from viewer.cli import main
from viewer.opening import learner
from viewer.opening.learner import Watched
from viewer.options import CheckOptions
from viewer.panels import find, share, what_if
from viewer.panels import given as panel
from viewer.session import Session
from viewer.words import Speaker

TEXT = Path(starter.__file__).read_text(encoding="utf-8")
WRONG = TEXT.replace("* f * cos * cos_light", "* f * cos_light")
BROKEN = TEXT.replace("dot(n, wi) / pdf", "dot(n, w1) / pdf")
LINE = BROKEN[: BROKEN.index("w1)")].count("\n") + 1
SETTINGS = replace(settings_of(None), width=6, height=6, spp=2)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "my_tracer.py"
    path.write_text(WRONG, encoding="utf-8")
    return path


@pytest.mark.slow
def test_its_paths_are_shown_with_what_the_doctor_says_of_them(file):
    session = Session(tracer.load("cornell"), SETTINGS, None)
    session.stand((3, 3, 0, 0))
    session.give(learner.given(file, "cornell", SETTINGS))
    assert "light-term" in {f.rule for f in session.desk["doctor"].diagnosis.causes}
    assert session.event.kind.name == "light"  # the event that proves it
    assert np.allclose(session.given.picture.rgb[session.cursor.y, session.cursor.x], session.record.value)
    seen = [e for p in session.record.paths for e in p.events if e.kind.name == "light"]
    assert all(np.isfinite(e.values["f"]).all() for e in seen)  # of those that bring nothing, too
    assert "my_tracer.py" in what_if.show(session, Speaker("zh"))["note"]
    assert "my_tracer.py" in find.show(session, Speaker("en"))["foreign"]
    with pytest.raises(tracer.TracerError, match=r"own paths, not for those of my_tracer\.py"):
        session.suppose({(0, "bounce"): (10.0, 10.0)})
    session.alter(
        session.scene, session.settings
    )  # a knob is turned: castray's own tracer shows what it does
    assert session.given is None and not find.show(session, Speaker("en"))["foreign"]


def test_a_failed_run_keeps_the_last_good_one_and_says_where_it_failed(file):
    watched = Watched(file, "cornell", SETTINGS)
    session = Session(tracer.load("cornell"), SETTINGS, None)
    session.stand((3, 3, 0, 0))
    session.shelf["watched"] = watched
    watched._told = lambda: None
    for say in map(Speaker, ("en", "zh")):
        assert panel.show(session, say)["busy"]
        watched._failed(tracer.TracerError("my_tracer.py:9: in cast_ray: NameError"))
        assert panel.show(session, say)["error"].startswith("my_tracer.py:9")
        watched._begun()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("nowhere.py",), "nowhere.py: there is no such file"),
        (("my_tracer.py", "--integrator", "walk"), "integrator: is decided by the code of my_tracer.py"),
        (("my_tracer.py", "--compare", "mine.png"), "my_tracer.py is compared with right"),
        (("my.jsonl",), "give --scene"),
        (("my.jsonl", "--scene", "cornell", "--spp", "2"), "a log has its own settings"),
        (("cornell", "--scene", "cornell"), "scene: is for your own tracer"),
        (("my.jsonl#x=9", "--scene", "cornell"), "link: x without y of the pixel"),
        (("my_tracer.py#x=1&y=2&spp=9",), "only x, y, path and event are said"),
        (("right.jsonl#x=9&y=9", "--scene", "cornell"), "pixel 9 9: no path of it was recorded"),
        (("right.jsonl#x=3&y=5&event=99", "--scene", "cornell"), "event 99 of 9: there is no such place"),
    ],
)
def test_what_will_not_do_is_said_in_one_line(file, monkeypatch, capsys, words, said):
    monkeypatch.chdir(file.parent)
    (file.parent / "my.jsonl").write_text("{}\n", encoding="utf-8")
    write_log(file.parent / "right.jsonl", OUTER, INNER)
    with pytest.raises(SystemExit) as ended:
        main(["view", *words, "--no-browser"])
    assert ended.value.code == 2 and said in capsys.readouterr().err


@pytest.mark.slow
def test_the_command_of_each_finding_opens_its_event(file, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    found = row_of(Path(file.name), file.name, "cornell", CheckOptions(size=(6, 6), spp=2, seed=3), 60.0)
    told = report.as_html([found], "homework", "cornell", Speaker("en"))
    opened = []
    monkeypatch.setattr(app, "_run", lambda session, *_: opened.append(session))
    for finding in found.more:
        assert f"<code>{escape(finding.command)}</code>" in told
        with pytest.raises(SystemExit):
            main(shlex.split(finding.command)[1:])
        session, first = opened.pop(), finding.first
        watched = session.shelf["watched"]
        watched._show = session.give
        watched._done(learner.given(watched.file, watched.scene, watched.settings))
        assert (session.cursor.x, session.cursor.y, session.path.sample) == (
            first["x"],
            first["y"],
            first["sample"],
        )
        assert (session.event.kind.name, session.event.depth) == (first["kind"], first["depth"])
        assert share.show(session, Speaker("en"))["command"] == finding.command
    assert found.more


@pytest.mark.slow
def test_a_place_that_a_saved_file_has_no_more_is_the_first_findings(file):
    session = Session(tracer.load("cornell"), SETTINGS, None)
    watched = Watched(file, "cornell", SETTINGS, at=(3, 3, 0, 999))
    watched._show = session.give
    watched._done(learner.given(file, "cornell", SETTINGS))
    assert session.event.kind.name == "light"


@pytest.mark.browser
def test_a_saved_file_is_run_again_and_the_place_is_kept(serve, visit, file):
    page = visit(serve(str(file), "--scene", "cornell", "--size", "6", "6", "--spp", "2").address)
    page.wait_for_selector("[data-testid=given][data-runs='1']", timeout=60_000)
    page.wait_for_selector("[data-testid=doctor] [data-rule=light-term]")  # the doctor's findings are open
    page.evaluate("() => window.trame.trigger('pick', [4, 3])")
    page.wait_for_selector("[data-testid=event-table][data-pixel='4,3']")

    file.write_text(BROKEN, encoding="utf-8")
    said = page.get_by_test_id("given-error")
    said.wait_for(timeout=60_000)
    assert f"my_tracer.py:{LINE}: in cast_ray: NameError" in said.inner_text()
    assert page.locator("[data-testid=given][data-shown=true]").count() == 1  # the last good one stays

    file.write_text(TEXT, encoding="utf-8")
    page.wait_for_selector("[data-testid=given][data-runs='2']", timeout=60_000)
    assert said.count() == 0 and page.locator("[data-testid=doctor] [data-rule=light-term]").count() == 0
    assert page.locator("[data-testid=event-table]").get_attribute("data-pixel") == "4,3"
    assert page.errors == []


@pytest.mark.slow
def test_a_right_tracer_opens_where_light_arrives(tmp_path):
    file = tmp_path / "right.py"
    file.write_text(TEXT, encoding="utf-8")
    session = Session(tracer.load("cornell"), SETTINGS, None)
    session.give(learner.given(file, "cornell", SETTINGS))
    assert not session.desk["doctor"].diagnosis.causes
    assert np.any(session.event.values["contribution"] > 0)
