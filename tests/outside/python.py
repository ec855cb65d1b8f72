"""Mistakes of a cast_ray in Python that is watched: lines of the starter written otherwise."""

import tempfile
from functools import partial
from pathlib import Path

from outside.mistake import Mistake
from tracer.learner import child, starter
from viewer.checking.learner import judged, settings_of

SMALL = {"width": 24, "height": 24, "spp": 8}


def with_changes(text, changes):
    """A program with some of its text changed, {old: new}; ValueError unless each old is there once."""
    for old, new in changes.items():
        if text.count(old) != 1:
            raise ValueError(f"{text.count(old)} times in the program: {old}")
        text = text.replace(old, new)
    return text


def judged_text(text, **settings):
    """What `castray check` says of a program; settings beside the small ones."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mine.py"
        path.write_text(text, encoding="utf-8")
        request = {
            "file": str(path),
            "scene": "cornell",
            "settings": settings_of(None).as_dict() | SMALL | settings,
        }
        return judged(*child.run(request))


def diagnosed(changes):
    """What `castray check` says of the starter with some of its text changed, {old: new}."""
    return judged_text(with_changes(Path(starter.__file__).read_text(encoding="utf-8"), changes))


def _of(id, words, laws, changes, fair=()):
    return Mistake(f"python {id}", words, laws, partial(diagnosed, changes), fair)


_SAMPLE = "wi = material.sample(wo, n)\n        pdf = material.pdf(wi, wo, n)\n"
MISTAKES = (
    _of(
        "wrong-normal",
        "the lamp's cosine with the surface's normal",
        ("light-term",),
        {"dot(light.n, -wi)": "dot(n, wi)"},
    ),
    _of(
        "density-before",
        "the density of the direction before",
        ("bounce-pdf", "throughput"),
        {_SAMPLE: "pdf = material.pdf(wi, wo, n)\n        wi = material.sample(wo, n)\n"},
    ),
    _of(
        "albedo-again",
        "f and the albedo",
        ("light-term", "light-f"),
        {"light.emission * f": "light.emission * f * material.albedo"},
    ),
    _of(
        "dead-divisor",
        "divided by 1 - q",
        ("roulette-weight", "throughput"),
        {"/ pdf / SURVIVAL": "/ pdf / (1 - SURVIVAL)"},
    ),
    _of(
        "half-visible",
        "whatever lies in the nearer half of the way does not block",
        ("light-visible",),
        {"0.999 * length": "0.5 * length"},
    ),
    _of(
        "indirect-halved",
        "half of the indirect light",
        ("throughput",),
        {"return direct + indirect": "return direct + 0.5 * indirect"},
    ),
    _of(
        "other-random",
        "q is 0.8, the test is with 0.6",
        ("roulette-probability", "roulette-weight", "throughput"),
        {"scene.random() < SURVIVAL": "scene.random() < 0.6"},
    ),
    _of(
        "length-of-one",
        "the direction to the lamp divided by the squared length",
        ("unit-light", "light-direction"),
        {"wi = normalize(towards)": "wi = towards / dot(towards, towards)"},
        ("D20",),
    ),
    _of(
        "lamp-halved",
        "the lamp that is seen shines by half",
        ("emission", "emission-weight", "emission-term"),
        {"return hit.emission if": "return 0.5 * hit.emission if"},
    ),
)
