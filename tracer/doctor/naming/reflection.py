"""What a BSDF says when it is asked wrongly."""

import numpy as np

from tracer.doctor.naming.case import SHARE
from tracer.frame import dot


def given_to(case):
    """What the BSDF is asked with at the vertex of each event."""
    return {name: case.vertex(name) for name in ("p", "n", "wo", "primitive")}


def exchanged(evidence, given, wi, what):
    """What the BSDF says with both directions exchanged."""
    return evidence.asked(**given | {"wo": wi}, wi=given["wo"], what=what)


def to_the_lamp(case, given, what):
    """What the BSDF says of the direction in which a lamp was looked for there; nan where none was."""
    row = case.evidence.before(case.kind, "light")[case.rows]
    wi = case.evidence("light.wi").take(np.maximum(row, 0), axis=1)
    same = (row >= 0) & (case.depth == case.evidence.trace.tables["light"].depth.take(np.maximum(row, 0)))
    return np.where(same, case.evidence.asked(**given, wi=wi, what=what), np.nan)


def local(evidence, given, wi, what):
    """What the BSDF says of world directions taken for local ones."""
    material = evidence.scene.bsdf_of.take(given["primitive"])
    texture = evidence.scene.painted(given["p"], given["primitive"])
    return getattr(evidence.scene.bsdf, what)(material, given["wo"], wi, texture)


def mixed(evidence, given, wi, what):
    """What the BSDF says of a local wo and a wi in world space."""
    material = evidence.scene.bsdf_of.take(given["primitive"])
    texture = evidence.scene.painted(given["p"], given["primitive"])
    frame = evidence.scene.frame(given["n"], given["p"], given["primitive"])
    return getattr(evidence.scene.bsdf, what)(material, frame.to_local(given["wo"]), wi, texture)


def nothing_rough(case, given):
    """Whether f is no number, and that on rough surfaces only."""
    nan = np.isnan(case.recorded).any(axis=0)
    materials = list(case.evidence.scene.definition.bsdfs.values())
    rough = np.array(["D" in m.explain(np.ones((3, 1)), np.ones((3, 1))) for m in materials])
    return bool(nan.mean() >= SHARE and rough[case.evidence.scene.bsdf_of.take(given["primitive"])].all())


def leaks(case, given, wi):
    """Whether light is let through where shading and true normal disagree about its side."""
    ng = case.evidence.brute.normals(given["p"], given["primitive"])
    through = dot(ng, wi) * dot(given["n"], wi) < 0.0
    return bool(np.mean(through & (case.right == 0.0).all(axis=0)) >= SHARE)


def wrong_f(case, given, wi):
    """Guesses about f for light from wi (3, K), at a light sample or a bounce."""
    evidence, right = case.evidence, case.right
    cos = np.abs(dot(given["n"], wi))
    below = "light from below the true surface is let through by the shading normal"
    rough = "recorded NaN on rough surfaces: a roughness of 0 is divided by"
    twice_wi = "recorded = f(wi, wi): wi is given for both directions"
    for_local = "recorded is f asked with world directions as if they were local"
    half_local = "recorded is f asked with a local wo and wi in world space"
    added = "recorded > right everywhere: two lobes are added without sharing the light between them"
    return [
        ("G09", below, lambda: leaks(case, given, wi)),
        ("S08", rough, lambda: nothing_rough(case, given)),
        ("B03", "recorded = right x pi: 1/pi is missing", right * np.pi),
        (None, "recorded = right / pi: 1/pi is there twice", right / np.pi),
        ("D10", "recorded = right x cos: the cosine is in f already", right * cos),
        (
            "B14",
            "recorded = f(wi, wo): the two directions are exchanged",
            lambda: exchanged(evidence, given, wi, "eval"),
        ),
        ("B14", twice_wi, lambda: evidence.asked(**given | {"wo": wi}, wi=wi, what="eval")),
        ("W04", for_local, lambda: local(evidence, given, wi, "eval")),
        ("W04", half_local, lambda: mixed(evidence, given, wi, "eval")),
        ("S09", added, lambda: _layered(case, given) and _more(case)),
    ]


def _more(case):
    """Whether more is recorded than is right at all events."""
    ratio = case.recorded / np.where(case.right > 0.0, case.right, np.nan)
    return bool(np.nanmin(ratio) > 1.0) if np.isfinite(ratio).any() else False


def _layered(case, given):
    from tracer.bsdf import Plastic, RoughPlastic

    kinds = [type(m) for m in case.evidence.scene.definition.bsdfs.values()]
    here = np.unique(case.evidence.scene.bsdf_of.take(given["primitive"]))
    return all(issubclass(kinds[k], (Plastic, RoughPlastic)) for k in here)
