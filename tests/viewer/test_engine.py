"""`castray view --engine`: who makes the picture, and what is said where gl cannot."""

import re
import threading

import numpy as np
import pytest
import suite
from cases import loaded
from suite import castray
from viewers import SMALL

from tracer import Settings, TracerError
from viewer.link import parse
from viewer.render import READY_SOON, Painter
from viewer.words import Speaker, table

BLIND = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nowhere", "DISPLAY": "", "WAYLAND_DISPLAY": ""}


def painted(settings, gl):
    """What a Painter shows one after another: [(engine, samples, why)]."""
    shown, over, painter = [], threading.Event(), Painter(loaded("cornell_unit"), settings, gl)

    def done(picture, spp):
        shown.append((picture.engine, spp, painter.why))
        if spp == settings.spp:
            over.set()

    def failed(text):
        shown.append(text)
        over.set()

    painter.start(done, lambda share, spp: None, failed)
    assert over.wait(60)
    return shown


class Slow:
    """A gl engine that is not heard of at first, and then does what it can."""

    def __init__(self, refuses=""):
        self.refuses = refuses

    def render(self, scene, settings, steps, progress, meanwhile=None):
        if meanwhile:
            meanwhile()
        if self.refuses and settings.spp > 1:
            raise TracerError(f"engine: {self.refuses}; choose engine numpy")
        return type("Picture", (), {"engine": "gl"})()


def test_until_gl_is_ready_the_first_coarse_picture_is_numpys():
    assert painted(Settings(width=4, height=4, spp=5), Slow()) == [
        ("numpy", 1, READY_SOON), ("gl", 1, READY_SOON), ("gl", 4, READY_SOON), ("gl", 5, READY_SOON)
    ]  # fmt: skip
    assert [engine for engine, *_ in painted(Settings(width=4, height=4, spp=1), Slow())] == ["gl"]


def test_what_gl_gives_up_numpy_goes_on_with_and_says_why():
    *_, fourth, last = painted(Settings(width=4, height=4, spp=5), Slow("no memory"))
    assert (fourth, last) == (("numpy", 4, "no memory"), ("numpy", 5, "no memory"))


@pytest.mark.slow
def test_without_opengl_gl_is_refused_in_one_line_before_anything_is_served():
    done = castray("view", "cornell_unit", *SMALL, "--engine", "gl", "--no-browser", env=BLIND)
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert "engine: gl needs" in done.stderr


@pytest.mark.parametrize(("words", "said"), [(["--engine", "cuda"], "choose one of"), ([], "brings its own")])
def test_an_engine_that_will_not_do_is_refused(tmp_path, words, said):
    file = tmp_path / "mine.py"
    file.write_text("", encoding="utf-8")
    done = castray("view", file, *(words or ["--engine", "gl"]))
    assert done.returncode == 2 and said in done.stderr and len(done.stderr.splitlines()) == 1


def test_why_numpy_made_the_picture_is_told_in_chinese():
    reasons = [key for key in table("en") if key.startswith("error.gl_")]
    assert len(reasons) > 8
    for key in reasons:
        said = Speaker("en").words[key].format_map(type("Any", (dict,), {"__missing__": lambda *_: "x"})())
        assert re.search(r"[\u4e00-\u9fff]", Speaker("zh").error(said)), said


@pytest.fixture(scope="module")
def page(serve, tab):
    """A page of a viewer that paints by gl, with whatever OpenGL there is."""
    suite.gl()
    return tab(serve("cornell_unit", *SMALL, "--engine", "gl").address)


def complete(page, words):
    """Wait until the picture is complete, and made by whom the line says."""
    page.wait_for_function(
        "words => document.querySelector('[data-testid=engine]')?.textContent.startsWith(words)"
        " && !document.querySelector('[data-testid=progress]')",
        arg=words,
        timeout=60_000,
    )


def shown(page):
    """The numbers of the picture on the page."""
    rgb = page.evaluate("() => Array.from(new Uint8Array(window.trame.state.get('rgb').slice().buffer))")
    return np.frombuffer(bytes(rgb), np.float32).reshape(64, 64, 3)


@pytest.mark.slow
@pytest.mark.browser
def test_the_picture_is_that_of_castray_render_by_gl_whatever_is_turned(page, tmp_path):
    turned = (
        ("change", "white.reflectance", 0.25),
        ("change", "lamp.scale", 2),
        ("tune", "sampler", "lattice"),
    )
    for call, name, value in turned:
        page.evaluate("([call, ...knob]) => window.trame.trigger(call, knob)", [call, name, value])
        page.wait_for_function("name => window.trame.state.get('link').includes(name)", arg=name)
        complete(page, "by gl: ")
        there = parse(page.evaluate("() => window.trame.trigger('truth')")["link"])
        words = [word for key, said in there.changes.items() for word in ("--set", f"{key}={said}")]
        words += ["--sampler", there.settings.sampler, "--engine", "gl", "-o", tmp_path / "a.npy"]
        done = castray("render", "cornell_unit", *SMALL, *words)
        assert done.returncode == 0, done.stderr
        assert np.array_equal(shown(page), np.load(tmp_path / "a.npy"))
    assert "rounding" in page.get_by_test_id("engine").get_attribute("title")


@pytest.mark.browser
def test_what_gl_cannot_do_numpy_does_and_the_page_says_so_in_both_languages(page):
    page.evaluate("() => window.trame.trigger('tune', ['bug', 'E01'])")
    complete(page, "by NumPy: gl cannot do bug E01, which replaces emission_weight")
    page.get_by_test_id("language").select_option("zh")
    complete(page, "由 NumPy 绘制：gl 不支持错误 E01")
    page.get_by_test_id("language").select_option("en")
    page.evaluate("() => window.trame.trigger('tune', ['bug', ''])")
    complete(page, "by gl: ")


@pytest.mark.browser
def test_two_pictures_that_are_compared_are_both_numpys(page):
    page.evaluate("() => window.trame.trigger('compare', ['D01'])")
    complete(page, "by NumPy: two pictures are compared")
    page.evaluate("() => window.trame.trigger('compare', [''])")
    complete(page, "by gl: ")
