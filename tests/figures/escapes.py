"""Rays from inside closed meshes that meet nothing."""

import numpy as np
from escapes import AIMS, PLACES, escapes

from figures.figure import Figure

TITLE = "Escapes"
FINE = 5  # subdivisions of the mesh: 20480 triangles
BARS = {
    "anywhere": "Embree allows 2000 per 1e8; Vulkan 0",
    "edges": "Vulkan 0; Embree never aims there",
    "corners": "Vulkan 0; Embree never aims there",
}


def _escapes(aim, place, dtype, n):
    return lambda seed: {"escaped": escapes(place, aim, dtype, n, seed, fine=FINE)}


def none_escaped(n):
    """A judge: 0 of all rays, n a chunk, under the name `escaped`."""

    def judge(sums, chunks):
        bound = 3.0e8 / (n * chunks)  # 95 % confidence where none was seen
        seen = sums["escaped"] / (n * chunks) * 1e8
        return (f"{seen:.3g}" if seen else f"0 (< {bound:.3g})") + " per 1e8", sums["escaped"] == 0

    return judge


def figures():
    """Rays aimed at random, at edges and at vertices of a closed mesh, at the origin and far from it."""
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
