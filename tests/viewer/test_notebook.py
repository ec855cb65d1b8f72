"""viewer.show: what a cell displays stands alone, and gives way to the viewer on this machine."""

import functools
import http.server
import re
import subprocess
import sys
import threading
import urllib.error
import urllib.request

import pytest
from suite import ROOT

import tracer
import viewer
from tracer.trace import gather

SMALL = {"width": 16, "height": 16, "spp": 2, "max_depth": 3}


def test_a_cell_shows_a_page_that_needs_nothing_else_at_the_pixel_asked_for(tmp_path):
    shown = viewer.show("cornell_unit", pixel=(5, 9), live=False, bug="D01", **SMALL)
    html = shown._repr_html_()
    assert (
        html.startswith("<iframe sandbox=") and "<script>" not in html
    )  # all of the page is in an attribute
    assert '"x":5,"y":9' in shown.html and not re.search(r"(?:src|href)=[\"'](?!data:)", shown.html)
    assert shown.address is None and "save" in repr(shown)
    shown.save(tmp_path / "cell.html")
    assert (tmp_path / "cell.html").read_text(encoding="utf-8") == shown.html


def test_scenes_recordings_and_traces_are_shown(tmp_path):
    scene, settings = tracer.load("cornell_unit"), tracer.Settings(**SMALL)
    tracer.record(scene, settings, tmp_path / "box", "paths")
    asked = {"pixel": (5, 9), "live": False}
    pages = [
        viewer.show(scene, settings, **asked),
        viewer.show(tmp_path / "box", **asked),
        viewer.show(gather(scene, settings), **asked),
    ]
    assert len({re.sub(r"castray: pixel[^<]*", "", shown.html) for shown in pages}) == 1


@pytest.mark.parametrize(
    ("what", "options", "words"),
    [
        ("no such scene", {}, "no such scene"),
        ("cornell_unit", {"settings": tracer.Settings(), "spp": 4}, "not both"),
        ("cornell_unit", {"pixel": (99, 0), **SMALL}, "outside the picture"),
        ("cornell_unit", {"pixel": 5, **SMALL}, r"5 is not \(x, y\)"),
        ("mine.jsonl", {}, "castray view mine.jsonl --scene SCENE"),
        (3, {}, "3 is no scene"),
    ],
)
def test_what_cannot_be_shown_is_one_clear_line(what, options, words):
    with pytest.raises(tracer.TracerError, match=words) as told:
        viewer.show(what, live=False, **options)
    assert "\n" not in str(told.value)


def test_importing_the_viewer_for_it_imports_no_window():
    code = "import viewer, sys; viewer.show; print('vtkmodules' in sys.modules, 'trame' in sys.modules)"
    ran = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, encoding="utf-8", check=True
    )
    assert ran.stdout.split() == ["False", "False"]


@pytest.mark.slow
def test_what_the_viewer_refuses_is_one_clear_line_even_beside_a_file_called_tracer(tmp_path, monkeypatch):
    (tmp_path / "tracer.py").write_text("raise SystemExit('the wrong tracer')", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(tracer.TracerError, match="'Z99' is neither a bug"):
        viewer.show("cornell_unit", compare="Z99", **SMALL)


@pytest.mark.browser
def test_in_a_notebook_on_this_machine_the_viewer_takes_the_pages_place(context, tmp_path):
    shown = viewer.show("cornell_unit", compare="D01", **SMALL)
    try:
        assert shown.address in repr(shown)
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(shown.address.replace("/?key=", "/alive?key=x"))
        (tmp_path / "cell.html").write_text(f"<!doctype html>{shown._repr_html_()}", encoding="utf-8")
        notebook = http.server.ThreadingHTTPServer(
            ("127.0.0.1", 0), functools.partial(Quiet, directory=tmp_path)
        )
        threading.Thread(target=notebook.serve_forever, daemon=True).start()
        page = context.new_page()
        page.goto(f"http://localhost:{notebook.server_address[1]}/cell.html")
        live = page.frame_locator("iframe")
        live.get_by_test_id("castray").wait_for()
        live.get_by_test_id("tab-compare").click()
        assert live.get_by_test_id("rival").input_value() == "D01"
        notebook.shutdown()
    finally:
        shown.close()
    (tmp_path / "cell.html").rename(tmp_path / "later.html")
    page.goto((tmp_path / "later.html").as_uri())  # elsewhere, or when the viewer has ended, the page stays
    page.frame_locator("iframe").locator(".castray-3d[data-event]").wait_for()


class Quiet(http.server.SimpleHTTPRequestHandler):
    """A notebook's server, as far as it matters here."""

    def log_message(self, *_):
        """Say nothing."""
