"""Rays from inside closed meshes that meet nothing."""

from importlib.util import find_spec

import numpy as np
from escapes import AIMS, PLACES, closed_mesh, escapes

from figures.figure import Figure
from tracer.shape.embree_kernel import EmbreeKernel

TITLE = "Escapes"
FINE = 5  # subdivisions of the mesh: 20480 triangles
ALLOWED = 2000 / 1e8  # what Embree asks of itself
WORST = 0.01  # at corners it asks nothing of itself
NOTES = """
The lines of `--accel embree` are what Embree, in float32, does not find: there castray takes it at its word,
and says so here. Rays that bounce at random are aimed at no corner.
"""
BARS = {
    "anywhere": "Embree allows 2000 per 1e8; Vulkan 0",
    "edges": "Vulkan 0; Embree never aims there",
    "corners": "Vulkan 0; Embree never aims there",
}


def _escapes(aim, place, dtype, n):
    return lambda seed: {"escaped": escapes(place, aim, dtype, n, seed, fine=FINE)}


def _by_embree(aim, place, n):
    def measure(seed):
        kernel = EmbreeKernel(closed_mesh(place, np.float32, FINE)[0])
        return {"escaped": escapes(place, aim, np.float32, n, seed, kernel, FINE)}

    return measure


def none_escaped(n, most=0.0):
    """A judge: 0 of all rays, n a chunk, under the name `escaped`; or at most that share of them."""

    def judge(sums, chunks):
        bound = 3.0e8 / (n * chunks)  # 95 % confidence where none was seen
        seen = sums["escaped"] / (n * chunks) * 1e8
        return (f"{seen:.3g}" if seen else f"0 (< {bound:.3g})") + " per 1e8", sums[
            "escaped"
        ] <= most * n * chunks

    return judge


def figures():
    """Rays aimed at random, at edges and at vertices of a closed mesh, at the origin and far from it; also
    with `accel` embree, where it is installed."""
    n = 50_000
    for place, where in zip(PLACES, ("origin", "far"), strict=True):
        for aim in AIMS:
            for dtype in (np.float32, np.float64):
                bits = np.dtype(dtype).itemsize * 8
                yield Figure(
                    f"escapes-{aim}-{where}-{bits}",
                    f"escapes of rays aimed at {aim}, {where}, 20480 triangles",
                    "0",
                    BARS[aim],
                    f"float{bits}",
                    200,
                    n,
                    _escapes(aim, place, dtype, n),
                    none_escaped(n),
                )
    for place, where in zip(PLACES, ("origin", "far"), strict=True) if find_spec("embreex") else ():
        for aim in AIMS:
            most = WORST if aim == "corners" else ALLOWED
            yield Figure(
                f"escapes-{aim}-{where}-embree",
                f"escapes of rays aimed at {aim}, {where}, 20480 triangles, accel embree",
                f"{1e8 * most:.3g} per 1e8",
                BARS[aim],
                "float32",
                40,
                n,
                _by_embree(aim, place, n),
                none_escaped(n, most),
            )


def notes():
    """What to read from the table."""
    return NOTES
