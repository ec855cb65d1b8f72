"""Why paths that bring nothing ended, which lamps they met, and why they took no light sample."""

import numpy as np

from tracer.settings import ANY_DEPTH
from viewer.caption import named
from viewer.understanding.reasons import Reason

LESS = 0.5  # how much an end counts beside a light sample at the same depth


def dead(record):
    """(number, path) of the paths that bring nothing."""
    return [(k, p) for k, p in enumerate(record.paths) if not np.any(p.radiance != 0)]


def reasons(record, scene):
    """Reasons of how the paths that bring nothing ended, by cause and surface."""
    groups = {}
    for k, path in dead(record):
        if path.end != "invalid":
            hit = _last(path, "hit")
            shape = "" if hit is None else named("shape", hit.values["shape"], scene)
            groups.setdefault((path.end, shape if path.end in ("absorbed", "black") else ""), []).append(
                (k, path)
            )
    return [_end(cause, shape, group, record) for (cause, shape), group in groups.items()]


def _end(cause, shape, group, record):
    k, path = min(group, key=lambda one: one[1].events[-1].depth)
    roulette, end = _last(path, "roulette"), path.events[-1]
    shown = roulette if cause == "roulette" and roulette else end
    values = {"depth": end.depth, "shape": shape, "most": record.settings.max_depth}
    values["q"] = float(roulette.values["probability"]) if cause == "roulette" and roulette else 1.0
    weight = LESS * sum(0.5 ** p.events[-1].depth for _, p in group)
    if cause == "max_depth" and values["most"] == ANY_DEPTH:  # of a log that declares none
        cause = "longest"
    return Reason(f"end.{cause}", len(group), len(record.paths), (k, shown.step), values, weight)


def _last(path, kind):
    return next((e for e in reversed(path.events) if e.kind.name == kind), None)


def met(record, scene):
    """Reasons of the lamps that paths meet: light that does not count, and light that counts in full though
    light samples find it as well."""
    groups = {}
    for k, path in enumerate(record.paths):
        for event in path.events:
            if event.kind.name == "hit":
                key = _meeting(event, scene, record.settings)
                if key:
                    groups.setdefault((key, int(event.values["shape"])), []).append((k, event))
    reasons = []
    for (key, shape), group in groups.items():
        k, event = min(group, key=lambda one: one[1].depth)
        values = {"shape": named("shape", shape, scene), "depth": event.depth}
        weight = LESS * sum(0.5**e.depth for _, e in group)
        paths = len({k for k, _ in group})
        reasons.append(Reason(key, paths, len(record.paths), (k, event.step), values, weight))
    return reasons


def _meeting(event, scene, settings):
    """What is to be said of a hit as that of a lamp; "" for nothing."""
    v = event.values
    if not scene.is_light(int(v["shape"])):
        return ""
    if not v["front"]:
        return "met.back_lit" if np.any(v["contribution"] != 0) else "met.back"
    if not np.any(v["Le"] > 0):
        return "met.dark"
    if v["w"] == 0:  # from the camera and after a mirror nothing else could count it
        return "met.lost" if np.isinf(v["pdf_bsdf"]) else "met.left"
    samples_too = settings.integrator != "walk" and settings.strategy != "bsdf"
    found = np.isfinite(v["pdf_bsdf"]) and v["pdf_light"] > 0
    return "met.certain" if samples_too and found and v["w"] == 1 else ""


def unsampled(record, scene):
    """Reasons why paths that bring nothing took no light sample."""
    without = [(k, p) for k, p in dead(record) if all(e.kind.name != "light" for e in p.events)]
    settings, of = record.settings, len(record.paths)
    if not without:
        return []
    if not scene.has_lights:
        return [Reason("unsampled.no_lamp", len(without), of, None, {}, 2.0 * len(without))]
    if settings.integrator == "walk" or settings.strategy == "bsdf":
        way = f"integrator {settings.integrator}" if settings.integrator == "walk" else "strategy bsdf"
        return [Reason("unsampled.settings", len(without), of, None, {"way": way}, 1.0 * len(without))]
    groups = {}
    for k, path in without:
        for hit, bounce in zip(path.events, path.events[1:], strict=False):
            if hit.kind.name == "hit" and bounce.kind.name == "bounce" and bounce.values["delta"]:
                groups.setdefault(int(hit.values["shape"]), []).append((k, bounce))
                break
    return [
        Reason(
            "unsampled.mirror",
            len(group),
            of,
            (group[0][0], group[0][1].step),
            {"shape": named("shape", shape, scene)},
            1.0 * len(group),
        )
        for shape, group in groups.items()
    ]
