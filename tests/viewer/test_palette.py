"""Colours that name things are told apart by the colour-blind, dark and light, or have another sign as well.

A colour-blind eye is simulated by the matrices of Machado et al. (2009) for no working cones of one kind, on
linear sRGB; how different two colours look is their distance in OKLab (Ottosson 2020), in which 0.02 can just
be seen and black is 1 from white. Read on a screen, in small marks, four times that is asked for.
"""

import itertools
import re

import numpy as np
import pytest
from suite import ROOT

from viewer import hemisphere, overlay, plots, surfaces

EYES = {
    "normal": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                   [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                     [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
                   [0.004733, 0.691367, 0.303900]],
}  # fmt: skip
LMS = [[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
       [0.0883024619, 0.2817188376, 0.6299787005]]  # fmt: skip
LAB = [[0.2104542553, 0.7936177850, -0.0040720468], [1.9779984951, -2.4285922050, 0.4505937099],
       [0.0259040371, 0.7827717662, -0.8086757660]]  # fmt: skip
APART = 0.08
READABLE = 4.5  # contrast of text with what it stands on (WCAG 2.2, AA)

STYLES = (ROOT / "viewer" / "static" / "castray.css").read_text(encoding="utf-8")
SCRIPT = (ROOT / "viewer" / "static" / "understand.js").read_text(encoding="utf-8")


def tokens(text):
    """The colours that a part of a style sheet gives names, {name: #rrggbb}."""
    return dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})(?=;)", text))


DARK = tokens(STYLES[: STYLES.index("@media")])
LIGHT = DARK | tokens(STYLES[STYLES.index("@media (prefers-color-scheme: light)") : STYLES.index("} }")])
THEMES = {"dark": DARK, "light": LIGHT}


def linear(colour):
    """Linear sRGB of #rrggbb, or of three numbers of which each is sRGB from 0 to 1."""
    c = np.array(surfaces.rgb(colour) if isinstance(colour, str) else colour)
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def oklab(colour, eye="normal"):
    """Where a colour lies for an eye."""
    return np.array(LAB) @ np.cbrt(np.array(LMS) @ np.clip(np.array(EYES[eye]) @ linear(colour), 0.0, 1.0))


def confused(colours, told=()):
    """Pairs that some eye confuses, [(name, name, eye, distance)]; told: pairs that differ otherwise, too."""
    pairs = [p for p in itertools.combinations(colours, 2) if frozenset(p) not in set(map(frozenset, told))]
    far = [
        (a, b, eye, float(np.linalg.norm(oklab(colours[a], eye) - oklab(colours[b], eye))))
        for a, b in pairs
        for eye in EYES
    ]
    return [one for one in far if one[3] < APART]


def contrast(a, b):
    """The contrast of two colours (WCAG 2.2)."""
    low, high = sorted(float(np.dot([0.2126, 0.7152, 0.0722], linear(c))) for c in (a, b))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", THEMES)
def test_kinds_of_events_and_verdicts_are_told_apart_and_can_be_read(theme):
    colours = THEMES[theme]
    kinds = {name: colours[name] for name in ("light", "wi", "wo", "roulette", "dim", "text")}
    verdicts = {name: colours[name] for name in ("n", "bad", "dim")}
    assert confused(kinds) == confused(verdicts) == []
    for name in ("text", "dim", "accent", *kinds, *verdicts, "what-if", "twin"):
        assert contrast(colours[name], colours["panel"]) >= READABLE, name
    for name in ("accent", "twin", "bad", "wo"):
        assert contrast(colours[f"on-{name}"], colours[name]) >= READABLE, name


def test_what_is_drawn_in_3d_is_told_apart():
    arrows = {name: surfaces.COLOURS[name] for name in ("n", "wo", "wi", "light")}
    assert confused(arrows) == []
    # ways differ in thickness (walked, ahead, others), and from what is dashed; what is blocked has a cross
    lines = {k: surfaces.COLOURS[k] for k in ("walked", "ahead", "others", "lit", "blocked", "idle")}
    lines |= {k: surfaces.COLOURS[k] for k in ("what_if", "twin")}
    dashed = [(a, b) for a in ("walked", "ahead", "others") for b in ("idle", "what_if", "twin", "blocked")]
    assert confused(lines, dashed) == []
    assert confused({name: hemisphere.COLOURS[name] for name in ("more", "fewer")}) == []
    assert confused({name: hemisphere.COLOURS[name] for name in ("lobe_f", "lobe_p")}) == []


def test_the_dots_and_vectors_of_a_vertex_are_told_apart():
    tried = {k.removeprefix("tried_"): c for k, c in hemisphere.COLOURS.items() if k.startswith("tried_")}
    assert len(tried) == 4 and confused(tried) == []
    assert confused({name: DARK[name] for name in ("n", "ng", "wo", "wi", "h")}) == []


@pytest.mark.parametrize("eye", EYES)
def test_maps_grow_lighter_all_the_way_and_differences_have_two_sides_for_every_eye(eye):
    for kind in ("map", "mask"):
        lightness = [oklab(colour, eye)[0] for colour in overlay.STOPS[kind]]
        assert np.all(np.diff(lightness) > 0.02)
    stops = [oklab(colour, eye) for colour in overlay.STOPS["difference"]]
    middle = len(stops) // 2
    for k in range(1, middle + 1):
        below, above = stops[middle - k], stops[middle + k]
        assert np.linalg.norm(below - above) > APART  # which side
        assert min(below[0], above[0]) > max(stops[middle - k + 1][0], stops[middle + k - 1][0]) or k == 1


def test_curves_of_plots_are_told_apart_by_those_colours_that_are_known_for_it():
    """(Okabe and Ito 2008): their own distance is a little less; bench draws each with a mark of its own."""
    pairs = confused(dict(enumerate(plots.COLOURS)))
    assert all(distance > 0.07 for *_, distance in pairs) and len(pairs) < 3


def test_the_page_draws_with_the_colours_that_its_style_sheet_has():
    drawn = dict(re.findall(r'(\w+): "(#[0-9a-f]{6})"', SCRIPT))
    for name in ("n", "ng", "wo", "wi", "h", "blocked"):
        assert drawn[name] == DARK[name], name
    for name in ("n", "wo", "wi", "light", "twin", "what_if", "blocked"):
        assert surfaces.COLOURS[name] == surfaces.rgb(DARK[name.replace("_", "-")]), name
    assert hemisphere.COLOURS["ng"] == surfaces.rgb(DARK["ng"])
    assert hemisphere.COLOURS["h"] == surfaces.rgb(DARK["h"])
    for sheet in (ROOT / "viewer").glob("**/*.css"):
        used = set(re.findall(r"var\(--([\w-]+)", sheet.read_text(encoding="utf-8")))
        own = set(re.findall(r"--([\w-]+):", sheet.read_text(encoding="utf-8")))
        assert used <= own | DARK.keys() | {"veil", "aspect"}, sheet.name


def test_colours_that_are_alike_would_be_seen():
    """The tests above can fail: red and green of the same lightness."""
    assert confused({"good": "#73e687", "wi": "#ff9e4d"})  # deuteranopia
    assert confused({"wo": "#66b8ff", "roulette": "#d3a4ff"})  # protanopia
    assert confused({"n": "#73e687", "p": "#5fc7d8"})  # tritanopia
    assert not confused({"black": "#000000", "white": "#ffffff"})
