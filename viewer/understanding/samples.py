"""What became of a pixel's light samples, and why some of them bring nothing."""

import numpy as np

from tracer.frame import dot
from viewer.caption import named, no_number
from viewer.numerals import luminance
from viewer.understanding.places import places
from viewer.understanding.reasons import Reason

NEAR = 1e-5  # share of the way within which the surface that a ray starts on has no business to be
# What light samples that come to nothing for the same reason must have in common to be told together.
BY = {"light.blocked": "blocker", "light.self": "blocker", "light.behind": "light"}
BY |= dict.fromkeys(("light.below", "light.sides", "light.black", "light.dark"), "shape")


def outcome(sample):
    """What became of a light sample (a Place), as the words call it; "" where it brings light, or NaN, of
    which other reasons speak."""
    v, hit = sample.event.values, sample.hit
    if no_number(v):
        return ""
    if np.any(v["contribution"] < 0):
        return "light.negative"
    if np.any(v["contribution"] > 0):
        return "light.back_lit" if v["cos_light"] < 0 else ""
    if v["cos_light"] <= 0:
        return "light.behind"
    if not np.any(v["f"] > 0):
        return _without_f(v, hit)
    if not np.any(v["transmittance"] > 0):
        return "light.absorbed"
    if v["w"] == 0:
        return "light.weight"
    if v["visible"] or not np.any(v["Le"] > 0):
        return "light.nothing"
    if v["blocker"] < 0:
        return "light.phantom"
    own = v["blocker"] == hit["shape"] and v["blocker_distance"] < NEAR * v["distance"]
    return "light.self" if own else "light.blocked"


def _without_f(v, hit):
    """Why the surface sends nothing on: the lamp is behind it, or its material has nothing for it."""
    if dot(hit["n"], v["wi"]) <= 0:
        return "light.below"
    if dot(hit["ng"], v["wi"]) * dot(hit["n"], v["wi"]) <= 0:
        return "light.sides"
    return "light.dark" if np.any(hit["albedo"] > 0) else "light.black"


def reasons(record, scene):
    """Reasons of the light samples that bring nothing, or less, alike ones together."""
    samples = [place for place in places(record, "light") if place.hit]  # a log may lack it
    total = [sum((s.event.depth > 0) == deep for s in samples) for deep in (False, True)]
    groups = {}
    for sample in samples:
        key = outcome(sample)
        if key:
            by = _names(sample, scene).get(BY.get(key), "")
            groups.setdefault((key, sample.event.depth > 0, by), []).append(sample)
    return [_reason(key, deep, group, total[deep], scene) for (key, deep, _), group in groups.items()]


def _names(sample, scene):
    v, hit = sample.event.values, sample.hit
    return {
        "light": named("light", v["light"], scene),
        "blocker": named("shape", v["blocker"], scene),
        "shape": named("shape", hit["shape"], scene),
        "bsdf": named("bsdf", hit["bsdf"], scene),
    }


def _reason(key, deep, group, of, scene):
    """The Reason of a group of light samples; the one that would count most stands for it."""
    shown = max(group, key=lambda s: (0.5**s.event.depth, luminance(s.event.values["beta"])))
    v = shown.event.values
    values = {"where": "further" if deep else "first", **_names(shown, scene)}
    values |= {
        "at": float(v["blocker_distance"]),
        "cos": float(dot(shown.hit["n"], v["wi"])),
        "cos_light": float(v["cos_light"]),
        "distance": float(v["distance"]),
        "least": float(np.min(v["contribution"])),
    }
    weight = sum(0.5**s.event.depth for s in group)
    return Reason(key, len(group), of, shown.at, values, weight)
