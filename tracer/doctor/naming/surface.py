"""What breaks the laws of the surface that is met: its place, its normals."""

import numpy as np

from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.frame import dot, length

_SOME = 0.05  # share of the vertices from which on a surface is worth its name
_FEW_NORMALS = 64  # circles of two degrees around so many cover a fiftieth of the sphere
_SAME = 0.9994  # cosine of two degrees


def on_surface(case):
    """Vertices that do not lie on their surfaces."""
    scene = case.evidence.scene
    shape, count = np.unique(scene.shape_of.take(case["primitive"]), return_counts=True)
    most = np.argsort(-count, kind="stable")[: np.count_nonzero(count >= _SOME * count.sum())]
    names = ", ".join(scene.shapes[k].name for k in shape[most])
    return Clue(None, f"mostly on {names}, half of them by more than {np.median(case.recorded):.3g}")


def normal(case):
    """Normals that are not the surface's."""
    size = length(case.recorded)
    turned = dot(case.recorded, case.right) < -0.999 * size
    if (turned & (dot(case.recorded, case["wo"]) > 0.0)).mean() >= SHARE:
        return Clue(
            None, "recorded = -right wherever the back is seen: it is turned to where the ray comes from"
        )
    named = first(
        case,
        [
            (
                "N01",
                "the normal is the zero vector: the mesh has none, and none was made",
                bool((size < 1e-6).mean() >= SHARE),
            ),
            (
                "N02",
                "recorded = -right: the winding is turned over",
                bool((turned & (size > 0.5)).mean() >= SHARE),
            ),
        ],
    )
    return named or _of_others(case)


def _of_others(case):
    """A table of normals that is read at a wrong place, or the record of another hit: told where the scene
    has so few normals that meeting one is no chance."""
    every = case.evidence.brute.n
    own = every[:, np.unique(every.round(2) + 0.0, axis=1, return_index=True)[1]]
    clear = dot(case.recorded, case.right) < _SAME * length(case.recorded)
    if own.shape[1] > _FEW_NORMALS or clear.mean() < 0.5:
        return None
    recorded = case.recorded[:, clear]
    met = (own.T @ recorded >= _SAME * length(recorded)).any(axis=0)
    return Clue(None, "recorded are the normals of other surfaces") if met.mean() >= SHARE else None


def shading(case):
    """Shading normals that are not the interpolated ones."""
    clue = normal(case)
    if clue:
        return clue
    stretch = case.recorded / case.right
    big = (np.abs(case.right) > 0.1).all(axis=0)
    stretch = (stretch / stretch[:1])[:, big]
    if big.sum() > 8 and (np.ptp(stretch, axis=1) < 0.01).all() and np.abs(stretch - 1.0).max() > 0.01:
        x, y, z = (f"{v:.3g}" for v in np.median(stretch, axis=1))
        return Clue(
            "N03", f"x, y, z are stretched like {x} : {y} : {z}: moved by M, not its inverse transpose"
        )
    return None


_NEVER_UNIT = 1e-3  # farther from 1 no rounding brings a length


def unit_normal(case):
    """Normals whose length is not 1."""
    size, evidence = case.recorded, case.evidence
    if (size < 1e-6).mean() >= SHARE:
        return Clue("N01", "the normal is the zero vector")
    field = case.outcome.facts["field"]
    if (
        field == "n"
        and evidence.is_unit("hit.ng").all()
        and evidence.scene.has_smooth_normals
        and size.max() < 1.0
    ):
        return Clue(
            "N04", "only interpolated normals are too short: what lies between two unit vectors is shorter"
        )
    off = np.abs(size - 1.0)
    if not np.median(off) > _NEVER_UNIT:
        return Clue(None, f"lengths off by up to {off.max():.2g}")
    return Clue("B18", f"lengths from {size.min():.3g} to {size.max():.3g}: the normal was never made unit")


NAMES = {
    "on-surface": on_surface,
    "normal": normal,
    "shading-normal": shading,
    "unit-normal": unit_normal,
}
