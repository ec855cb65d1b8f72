"""More mistakes of a cast_ray in Python that is watched, written when those of python.py had been mended."""

from functools import partial

from outside.mistake import Mistake
from outside.python import diagnosed


def _of(id, words, laws, changes, fair=()):
    return Mistake(f"python {id}", words, laws, partial(diagnosed, changes), fair, "fresh")


_TERM = "light.emission * f * cos * cos_light / dot(towards, towards) / light.pdf"
_INNER = "indirect = cast_ray(scene, Ray(hit.p, wi), depth + 1) * f * dot(n, wi) / pdf / SURVIVAL"
_PDF = "        pdf = material.pdf(wi, wo, n)\n"
MISTAKES = (
    _of(
        "cosine-at-least",
        "the cosine at a light sample is at least 0.2",
        ("light-term", "light-cos"),
        {"max(dot(n, wi), 0.0), max(": "max(dot(n, wi), 0.2), max("},
    ),
    _of(
        "both-densities",
        "the light sample is divided by the bounce's density as well",
        ("light-term",),
        {_TERM: _TERM + " / material.pdf(wi, wo, n)"},
    ),
    _of(
        "cosine-of-the-eye",
        "n . wo at the bounce",
        ("throughput", "bounce-cos"),
        {_INNER: _INNER.replace("dot(n, wi)", "dot(n, wo)")},
    ),
    _of(
        "times-density",
        "times the lamp's density",
        ("light-term",),
        {_TERM: _TERM.replace("/ light.pdf", "* light.pdf")},
    ),
    _of(
        "cubed",
        "r^3: the direction is made unit a second time",
        ("light-term",),
        {_TERM: _TERM.replace("dot(towards, towards)", "length(towards) ** 3")},
    ),
    _of(
        "grey-bounce",
        "the bounce carries the mean of the colour",
        ("throughput", "bounce-f"),
        {_INNER: _INNER.replace("* f *", "* (f.r + f.g + f.b) / 3 *")},
    ),
    _of(
        "first-bounce-cut",
        "no indirect light after three bounces",
        ("roulette-probability", "roulette-share", "dead", "throughput", "absorbed", "end"),
        {"if scene.random() < SURVIVAL:": "if depth < 3 and scene.random() < SURVIVAL:"},
        ("R05",),
    ),
    _of(
        "into-the-wall",
        "the bounce starts a little below the surface",
        ("chain", "first-surface"),
        {_INNER: _INNER.replace("Ray(hit.p, wi)", "Ray(hit.p - n * 2.0, wi)")},
    ),
    _of(
        "from-the-lamp",
        "the path goes on from the light point",
        ("chain",),
        {_INNER: _INNER.replace("Ray(hit.p, wi)", "Ray(light.p, wi)")},
        ("B10",),
    ),
    _of(
        "light-at-bounce",
        "the lamp's normal at the bounce",
        ("throughput", "bounce-cos"),
        {_INNER: _INNER.replace("dot(n, wi)", "abs(dot(light.n, wi))")},
    ),
    _of(
        "wall-of-the-lamp",
        "density for the direction to the lamp",
        ("bounce-pdf", "throughput"),
        {_PDF: "        pdf = material.pdf(normalize(light.p - hit.p), wo, n)\n"},
    ),
    _of(
        "survivor-squared",
        "roulette is paid for twice",
        ("throughput", "roulette-weight"),
        {_INNER: _INNER + " / SURVIVAL"},
    ),
    _of(
        "no-shadow-of-the-far",
        "what blocks must lie within a third of the way",
        ("light-visible",),
        {"blocker.t > 0.999 * length(towards)": "3 * blocker.t > length(towards)"},
    ),
)  # fmt: skip
