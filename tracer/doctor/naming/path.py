"""What breaks the laws of the way from vertex to vertex."""

import numpy as np

from tracer.doctor.naming.case import SHARE, Clue
from tracer.frame import dot, length


def chain(case):
    """Vertices beside their rays."""
    evidence, rows = case.evidence, case.rows
    o, d, source = (column[..., rows] for column in evidence.arrivals)
    taken = case.recorded
    behind = dot(taken, d) < -0.999
    if behind.mean() >= SHARE:
        return Clue("G02", "the next vertex lies behind the start of the ray: t < 0 counts as a hit")
    vertex = evidence.before("hit", "hit")[rows]
    later = vertex >= 0
    if later.mean() < SHARE:
        return None
    n, p, primitive = (evidence(f"hit.{name}")[..., vertex[later]] for name in ("n", "p", "primitive"))
    local = evidence.scene.frame(n, p, primitive).to_local(d[:, later])
    off = length(local - taken[:, later])
    if np.mean(off < 0.01) >= SHARE:
        return Clue("B05", "the ray goes along the local coordinates of wi, as if they were the world's")
    return None


def first_surface(case):
    """Vertices behind the first surface."""
    evidence, rows = case.evidence, case.rows
    along = case.recorded
    t = evidence("hit.t")[rows] if evidence.has("hit.t") else along
    skipped = (along - t) / case.right
    if np.mean(np.abs(skipped - 1.0) < 0.01) >= SHARE:
        return Clue(
            "B10",
            "t is measured from the surface that was skipped: the path goes on from the next hit's point, in "
            "the old direction",
        )
    return _never_met(case)


def _never_met(case):
    """The surfaces that rays go through are those that no ray of the trace meets at all."""
    evidence = case.evidence
    through = np.unique(case.outcome.facts["met"][case.outcome.wrong])
    flat = np.array([np.ptp(shape.outline(), axis=1).min() for shape in evidence.scene.shapes])
    primitive = evidence("hit.primitive")
    met = np.bincount(primitive[primitive >= 0], minlength=evidence.scene.shape_of.size)
    if met[through].any():
        return None
    names = ", ".join(sorted({evidence.scene.shapes[k].name for k in evidence.scene.shape_of[through]}))
    if (flat[evidence.scene.shape_of[through]] <= 1e-9 * evidence.scale).all():
        return Clue("G01", f"no ray meets {names}: their bounding boxes have no thickness, and are refused")
    return Clue(None, f"no ray meets {names}")


_OFTEN = 0.005  # share of the vertices that rays without any offset meet again, and more


def own_surface(case):
    """Rays that meet what they start on."""
    share = case.outcome.wrong.sum() / max(case.outcome.rows.size, 1)
    ball = case.evidence.brute.is_sphere.take(case["primitive"])
    words = f"{share:.2%} of the vertices lie on the surface that the ray starts on"
    if share < _OFTEN:
        return Clue(None, f"{words}: what keeps rays off it is not enough everywhere")
    words = f"{words}: it has no offset, no least t"
    if ball.mean() >= SHARE:
        return Clue("G08", words, ("G03",))
    return Clue("G03", words, ("G08",) if ball.any() else ())


def unit_direction(case):
    """Directions that are not unit."""
    if case.kind != "bounce" or case.outcome.facts["field"] != "wi":
        return None
    n, nan = case.vertex("n"), ~np.isfinite(case.recorded)
    if nan.mean() < SHARE:
        return None
    if case.has("delta") and case["delta"].all():
        eta = case.evidence.trace.column("bounce", "eta")
        cos = dot(n, case.vertex("wo"))
        if eta is not None and np.mean(1.0 - cos * cos >= eta[case.rows].astype(float) ** 2 - 1e-4) >= SHARE:
            return Clue("S02", "no number, where all light is reflected: the root of a negative number")
        return None
    along = np.abs(n).max(axis=0)
    axis = np.abs(n).argmax(axis=0)
    if (along > 1.0 - 1e-5).all() and np.unique(axis).size == 1:
        return Clue(
            "B17", f"no number wherever the normal is along {'xyz'[axis[0]]}: there the frame breaks down"
        )
    return None


NAMES = {
    "chain": chain,
    "first-surface": first_surface,
    "escape-free": _never_met,
    "own-surface": own_surface,
    "unit-direction": unit_direction,
}
