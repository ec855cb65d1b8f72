"""Mistakes of a cast_ray in Python with two light samples a vertex: changed lines of programs/two_rays.py."""

from functools import partial
from pathlib import Path

from outside.mistake import Mistake
from outside.python import judged_text, with_changes

SOURCE = Path(__file__).parent / "programs" / "two_rays.py"


def diagnosed(changes, hemisphere="cosine"):
    """What `castray check` says of the program with some of its text changed, {old: new}."""
    return judged_text(with_changes(SOURCE.read_text(encoding="utf-8"), changes), hemisphere=hemisphere)


def _of(id, words, laws, changes, fair=(), **settings):
    return Mistake(f"two-rays {id}", words, laws, partial(diagnosed, changes, **settings), fair, "fourth")


_SHADOW = "seen = scene.intersect(Ray(v.p, to))\n"
_DENSITY = "density = v.material.pdf(to, v.out, v.n)\n"
MISTAKES = (
    _of("right", "no mistake", (), {}),
    _of("right-uniform", "no mistake; a uniform hemisphere", (), {}, hemisphere="uniform"),
    _of(
        "right-late",
        "no mistake; roulette from the third vertex on",
        (),
        {"FREE_BOUNCES = 0": "FREE_BOUNCES = 2"},
    ),
    _of("right-one", "no mistake; one light sample a vertex", (), {"SHADOW_RAYS = 2": "SHADOW_RAYS = 1"}),
    _of(
        "not-averaged",
        "the two light samples are summed, not averaged",
        ("light-term",),
        {"return total / SHADOW_RAYS": "return total"},
    ),
    _of(
        "return-in-loop",
        "return stands inside the loop: one light sample of two, divided by two",
        ("light-term", "light-due"),
        {"    return total / SHADOW_RAYS": "        return total / SHADOW_RAYS"},
    ),
    _of(
        "weight-by-depth",
        "survivors weigh 1/q to the power of the depth",
        ("throughput", "roulette-weight"),
        {"weight = 1.0 / KEEP": "weight = 1.0 / KEEP**depth"},
    ),
    _of(
        "shadow-backwards",
        "the shadow ray leaves the lamp's way backwards",
        ("light-visible", "light-direction"),
        {_SHADOW: "seen = scene.intersect(Ray(v.p, -to))\n"},
    ),
    _of(
        "distance-from-origin",
        "the squared distance is that of the lamp's point from the origin of the world",
        ("light-term",),
        {"r2 = dot(gap, gap)": "r2 = dot(lamp.p, lamp.p)"},
    ),
    _of(
        "vertex-moves",
        "the shadow test leaves its own hit's point in the vertex",
        (
            "chain",
            "light-direction",
            "light-distance",
            "light-visible",
            "light-term",
            "first-surface",
            "throughput",
        ),  # fmt: skip
        {_SHADOW: _SHADOW + "    if seen is not None:\n        v.p = seen.p\n"},
        ("B10",),
    ),
    _of(
        "percent",
        "roulette compares a number in percent with a share",
        ("roulette-share", "roulette-survival", "roulette-played", "roulette-probability", "end"),
        {"scene.random() > KEEP": "100 * scene.random() > KEEP"},
    ),
    _of(
        "distance-at-least",
        "the distance to the lamp is at least 250 mm, against white dots",
        ("light-term",),
        {"r2 = dot(gap, gap)": "r2 = max(dot(gap, gap), 250.0**2)"},
    ),
    _of(
        "lamp-at-second",
        "the lamp that the first bounce meets counts as well: <= for <",
        ("emission-weight",),
        {"if depth == 0 else": "if depth <= 1 else"},
        ("E01",),
    ),
    _of(
        "weight-one-late",
        "roulette is played at all vertices, its weight is given from the second on",
        ("throughput", "roulette-weight"),
        {"weight = 1.0 / KEEP": "weight = 1.0 / KEEP if depth > FREE_BOUNCES else 1.0"},
        ("R01",),
    ),
    _of(
        "nudge-inwards",
        "the next ray starts 1 mm below the surface",
        ("chain", "own-surface", "first-surface"),
        {"Ray(v.p, to), depth + 1": "Ray(v.p - v.n * 1.0, to), depth + 1"},
        ("B10", "G03"),
    ),
    _of(
        "half-uniform-density",
        "the density is that of a mixture with the uniform one, the directions are not",
        ("throughput", "bounce-pdf"),
        {_DENSITY: "density = 0.5 * v.material.pdf(to, v.out, v.n) + 0.5 / (2 * 3.14159265)\n"},
        ("B01",),
    ),
    _of(
        "square-with-length",
        "the shadow test compares the square of a distance with a distance",
        ("light-visible",),
        {"seen.t + TOLERANCE > far": "seen.t * seen.t + TOLERANCE > far"},
        ("D03",),
    ),
    _of(
        "parentheses",
        "the light sample stands within the parentheses of the bounce",
        ("light-term", "light-throughput", "ledger"),
        {
            "return reflected * cast_ray(": "return reflected * (from_lamps(scene, v) + cast_ray(",
            "depth + 1)": "depth + 1))",
            "return from_lamps(scene, v) + onward": "return onward",
        },
    ),
)
