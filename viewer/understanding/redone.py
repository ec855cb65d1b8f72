"""What a right tracer does at the recorded vertices with the recorded numbers, where this one did else.

Only castray's own paths are asked so: another tracer may use its numbers as it likes.
"""

import numpy as np

from tracer.integrator import steps
from viewer.caption import named
from viewer.numerals import near
from viewer.understanding.places import places
from viewer.understanding.reasons import Reason, spelled
from viewer.understanding.surface import Surface, column

APART = 1e-3  # between unit vectors, and relative between lengths, from which on they are not the same
FAR = 0.01  # the same of densities and weights
STRATEGIES = {"direct": "light", "walk": "bsdf"}


def reasons(record, scene):
    """Reasons of what a right tracer would have done otherwise. scene: at the record's settings."""
    found = []
    with np.errstate(all="ignore"):
        for kind, asked in (("light", _lights), ("bounce", _bounces)):
            there = [p for p in places(record, kind) if p.hit and np.isfinite(p.event.values["wi"]).all()]
            found += asked(there, scene, record.settings) if there else []
        found += _rays(record, scene)
    found += _fates(record)
    groups = {}
    for what, place, values in found:
        groups.setdefault((what, place.event.kind.name), []).append((place, values))
    of = {kind: sum(1 for _ in places(record, kind)) for _, kind in groups}
    return [_reason(what, kind, group, of[kind]) for (what, kind), group in groups.items()]


def _reason(what, kind, group, of):
    place, values = min(group, key=lambda one: one[0].event.depth)
    weight = sum(0.5**p.event.depth for p, _ in group)
    return Reason(f"redone.{what}", len(group), of, place.at, {"events": kind, **values}, weight)


def _values(recorded, right):
    """Both numbers as a sentence takes them."""
    return {"recorded": spelled(recorded), "right": spelled(right)}


def _lights(there, scene, settings):
    """Light samples: the point, its density, its weight, and whether anything is in the way."""
    v = {name: column(there, name) for name in ("u", "wi", "pdf", "pdf_bsdf", "w", "visible", "distance")}
    surface = Surface(scene, [place.hit for place in there])
    right = scene.sample_light(surface.p, v["u"])
    strategy = STRATEGIES.get(settings.integrator, settings.strategy)
    w = steps.light_weight(settings, strategy, v["pdf"], v["pdf_bsdf"])
    blocker, at = _in_the_way(there, scene, surface)
    for k, place in enumerate(there):
        length = np.linalg.norm(v["wi"][:, k])
        if not np.abs(v["wi"][:, k] / length - right.wi[:, k]).max() < APART:
            yield "direction", place, _values(v["wi"][:, k], right.wi[:, k])
        elif not near(v["pdf"][k], right.pdf[k], FAR):
            yield "density", place, _values(v["pdf"][k], right.pdf[k])
        if not near(v["w"][k], w[k], FAR):
            yield "weight", place, _values(v["w"][k], w[k])
        if v["visible"][k] and blocker[k] >= 0:
            values = {"blocker": named("shape", blocker[k], scene), "at": float(at[k])}
            yield "through", place, {**values, "distance": float(v["distance"][k])}


def _in_the_way(there, scene, surface):
    """Number (N,) of the shape that is between each vertex and its light point, -1 for none, and how far."""
    vertex = {"p": surface.p, "ng": surface.ng, "primitive": surface.primitive}
    names = ("q", "nq", "primitive", "wi", "f", "Le")
    event = {name: column(there, name) for name in names} | {"visible": np.zeros(len(there), bool)}
    return scene.blocker(vertex, event)


def _bounces(there, scene, settings):
    """Bounces: the direction, and at a Dirac lobe the share that goes there."""
    surface = Surface(scene, [place.hit for place in there])
    wi, u = column(there, "wi"), column(there, "u")
    sample, f = surface.sample(u), column(there, "f")
    right = surface.frame.to_world(sample.wi)
    for k, place in enumerate(there):
        if not np.abs(wi[:, k] - right[:, k]).max() < APART:
            yield "direction", place, _values(wi[:, k], right[:, k])
        elif sample.delta[k] and not near(f[:, k], sample.f[:, k], FAR):
            yield "share", place, _values(f[:, k], sample.f[:, k])


def _rays(record, scene):
    """Hits and escapes: what a ray from the vertex before really meets, and the normal there."""
    ends = list(_after(record))
    bounced = [(before, place) for before, place in ends if before.event.kind.name == "bounce"]
    first = [(before, place) for before, place in ends if before.event.kind.name == "camera"]
    for some in (first, bounced):
        if some:
            yield from _met(some, scene)


def _after(record):
    """(Place of the camera or bounce, Place of the hit or escape that its ray came to)."""
    before = None
    for place in places(record, "camera", "bounce", "hit", "escape"):
        if place.event.kind.name in ("camera", "bounce"):
            before = place
        else:
            yield before, place


def _met(pairs, scene):
    starts = [before for before, _ in pairs]
    if starts[0].event.kind.name == "camera":
        o, d = column(starts, "o"), column(starts, "d")
        source = np.full(len(pairs), -1, np.int32)
    else:
        surface = Surface(scene, [place.hit for place in starts])
        d, source = column(starts, "wi"), surface.primitive
        o = scene.spawn(surface.as_hit(), d)
    t, primitive = scene.intersect(o, d, source)
    met = primitive >= 0
    right = scene.hit(o, d, np.where(met, t, 1).astype(t.dtype), np.maximum(primitive, 0))
    for k, (_, place) in enumerate(pairs):
        v = place.event.values
        found = named("shape", v["shape"], scene) if "shape" in v else ""
        there = named("shape", scene.shape_of[primitive[k]], scene) if met[k] else ""
        if found != there or (found and not abs(v["t"] - t[k]) <= APART * abs(t[k])):
            values = {"found": found or "∞", "t": float(v.get("t", np.inf)), "there": there or "∞"}
            yield "hit", place, {**values, "right": float(t[k])}
        elif found and not np.abs(v["n"] - right.n[:, k]).max() < APART:
            yield "normal", place, {"shape": found, **_values(v["n"], right.n[:, k])}


def _fates(record):
    """Roulettes: whether the number drawn decides as it should."""
    for place in places(record, "roulette"):
        v = place.event.values
        if bool(v["survived"]) != bool(v["u"] < v["probability"]):
            yield "fate", place, {"u": float(v["u"]), "q": float(v["probability"])}
