"""Numbers that do not fit: a result that is not its own formula's, an f or p that is not the material's."""

import numpy as np

from viewer.caption import named
from viewer.equation import product_of
from viewer.numerals import luminance, near
from viewer.understanding.places import places
from viewer.understanding.reasons import Reason, spelled
from viewer.understanding.surface import Surface

KINDS = ("hit", "light", "bounce", "roulette")
OFF = 1e-3  # relative difference from its own formula from which on a result does not fit
FAR = 0.05  # from the material, whose f and p may change a lot within the rounding of a direction


def reasons(record, scene, own=True):
    """Reasons of what does not fit, alike ones together. scene: at the record's settings; own: whether
    castray traced it, so that what is no number came out so and is not just left out."""
    there = list(places(record, *KINDS))
    of = {kind: sum(place.event.kind.name == kind for place in there) for kind in KINDS}
    seen = [place for place in there if place.hit]  # a log may lack the surface
    found = [("result", place, *both) for place in there if (both := _result(record, place)) is not None]
    found += _material([place for place in seen if not _astray(place)], scene)
    found += [("direction", place, place.event.values["wi"], np.nan) for place in seen if _astray(place)]
    groups = {}
    for what, place, recorded, right in found:
        known = np.isfinite(recorded).all() and (what != "result" or np.isfinite(right).all())
        if not own and not known:
            continue  # something was not recorded
        groups.setdefault((what, place.event.kind.name), []).append((place, recorded, right))
    return [_reason(what, kind, some, of, scene) for (what, kind), some in groups.items()]


def _result(record, place):
    """(recorded, right) where the result of an event is not what its factors give."""
    product = product_of(record.paths[place.path], place.event.step)
    if product is None:
        return None
    right, recorded = product.value, np.asarray(product.recorded, float)
    fits = not np.isfinite(recorded).all() or near(recorded, right, OFF)
    return None if fits else (recorded, right)


def _astray(place):
    """Whether a direction is no number or not of length 1."""
    wi = place.event.values.get("wi")
    return wi is not None and not abs(float(np.linalg.norm(wi)) - 1.0) < OFF


def _material(there, scene):
    """What light samples and bounces say of f and p against the materials themselves."""
    asked = [p for p in there if p.event.kind.name in ("light", "bounce") and not p.event.values.get("delta")]
    if not asked:
        return
    values = [place.event.values for place in asked]
    wi = np.stack([v["wi"] for v in values], axis=-1)
    with np.errstate(all="ignore"):
        surface = Surface(scene, [place.hit for place in asked])
        f, pdf = surface.f(wi), surface.pdf(wi)
    for k, (place, v) in enumerate(zip(asked, values, strict=True)):
        if not near(v["f"], f[:, k], FAR):
            yield "f", place, v["f"], f[:, k]
        if place.event.kind.name == "bounce" and not near(v["pdf"], pdf[k], FAR):
            yield "pdf", place, v["pdf"], pdf[k]


def _reason(what, kind, group, of, scene):
    """The Reason of some events; of those nearest the camera the one that is furthest off stands for them."""

    def off(one):
        place, recorded, right = one
        apart, whole = np.abs(recorded - right).max(), np.abs(right).max()
        return place.event.depth, -apart / whole if whole else -np.inf

    place, recorded, right = min(group, key=off)
    values = {"events": kind, "recorded": spelled(recorded), "right": spelled(right)}
    if what == "result":
        whole = luminance(right)
        values["times"] = luminance(recorded) / whole if whole else float("inf")
    else:
        values["shape"] = named("shape", place.hit["shape"], scene)
        values["bsdf"] = named("bsdf", place.hit["bsdf"], scene)
    weight = sum(0.5**p.event.depth for p, _, _ in group)
    return Reason(f"unfit.{what}", len(group), of[kind], place.at, values, weight)
