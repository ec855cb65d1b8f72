"""What lies at a vertex: the point on its surface, its normals, its side."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.rule import Outcome, Rule
from tracer.frame import dot


def on_surface(evidence):
    """I12: which HITs do not lie on their primitive."""
    p, primitive = evidence("hit.p"), evidence("hit.primitive")
    off = evidence.brute.off_surface(p, primitive)
    # A ray that grazes the edge may meet a face beyond it by its rounding over the cosine.
    cos = np.abs(dot(evidence("hit.ng"), evidence("hit.wo"))) if evidence.has("hit.ng") else 1.0
    bad = ~(off <= 4.0 * evidence.off_point)
    edge = bad & (off <= 4.0 * evidence.off_point / np.maximum(cos, 1e-6))
    rows = np.arange(off.size)
    return Outcome("hit", rows, bad & ~edge, edge, off, np.zeros_like(off), "distance of p from its surface")


def geometric(evidence):
    """I11: ng against the surface's own normal."""
    primitive = evidence("hit.primitive")

    def value(p, primitive):
        return evidence.brute.normals(p, primitive)

    inputs = {"p": (evidence("hit.p"), evidence.off_point), "primitive": (primitive, 0.0)}
    rows = np.arange(primitive.size)
    return judged(evidence, "hit", rows, evidence("hit.ng"), value, inputs, "ng", absolute=evidence.off_unit)


def shading(evidence):
    """I11: n against the normal interpolated there, or ng."""
    primitive, brute = evidence("hit.primitive"), evidence.brute
    p, wo = evidence("hit.p"), evidence("hit.wo")

    def value(p, wo, primitive):
        return brute.shading(p, primitive, brute.normals(p, primitive), wo)

    inputs = {"p": (p, evidence.off_point), "wo": (wo, evidence.off_unit), "primitive": (primitive, 0.0)}
    rows = np.arange(primitive.size)
    return judged(evidence, "hit", rows, evidence("hit.n"), value, inputs, "n", absolute=evidence.off_unit)


def side(evidence):
    """The side that the ray came from."""
    primitive = evidence("hit.primitive")
    cos = dot(evidence.brute.normals(evidence("hit.p"), primitive), evidence("hit.wo"))
    front = evidence("hit.front").astype(bool)
    unsure = ~(np.abs(cos) > 4.0 * evidence.off_unit + _curved(evidence, primitive))
    bad = (front != (cos > 0.0)) & ~unsure
    return Outcome("hit", np.arange(bad.size), bad, unsure, front, cos > 0.0, "front")


def _curved(evidence, primitive):
    """How far the normal of a sphere turns within what points may be off, (N,)."""
    brute = evidence.brute
    if not brute.sphere.size:
        return 0.0
    radius = brute.radius.take(brute.column.take(primitive), mode="clip")
    return np.where(brute.is_sphere.take(primitive), 4.0 * evidence.off_point / radius, 0.0)


RULES = (
    Rule(
        "on-surface",
        "Vertices lie on surfaces",
        "A vertex lies on the surface that it is said to lie on.",
        "n . p = c, within the edges",
        ("hit.p", "hit.primitive"),
        on_surface,
    ),
    Rule(
        "normal",
        "The normal is that of the surface",
        "The geometric normal is that of the surface, on the side that the scene says.",
        "ng = n(p)",
        ("hit.ng", "hit.p", "hit.primitive"),
        geometric,
    ),
    Rule(
        "shading-normal",
        "The shading normal is the interpolated one",
        "The shading normal is that of the surface, or where vertices have normals, what lies between these, "
        "moved by the inverse transpose and made unit again.",
        "n = normalize(sum of b_i n_i)",
        ("hit.n", "hit.p", "hit.wo", "hit.primitive"),
        shading,
    ),
    Rule(
        "side",
        "The side is the one that the ray came from",
        "A surface is seen from its front if wo and the normal lie on one side.",
        "front = (ng . wo > 0)",
        ("hit.front", "hit.p", "hit.wo", "hit.primitive"),
        side,
    ),
)
