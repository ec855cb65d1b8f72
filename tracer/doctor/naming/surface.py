"""What breaks the laws of the surface that is met: its place, its normals."""

import numpy as np

from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.frame import dot, length


def on_surface(case):
    """Vertices that do not lie on their surfaces."""
    scene = case.evidence.scene
    names = sorted({scene.shapes[k].name for k in np.unique(scene.shape_of.take(case["primitive"]))})
    return Clue(None, f"on {', '.join(names)}, by up to {case.recorded.max():.2g}")


def normal(case):
    """Normals that are not the surface's."""
    size = length(case.recorded)
    turned = dot(case.recorded, case.right) < -0.999 * size
    if (turned & (dot(case.recorded, case["wo"]) > 0.0)).mean() >= SHARE:
        return Clue(
            None, "recorded = -right wherever the back is seen: it is turned to where the ray comes from"
        )
    return first(
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
