"""Maps from the unit square: carried back by the known distribution, their points fill it evenly."""

import numpy as np
from lamps import numbers

from densities.sampler import Sampler, even, longitude, square
from tracer import warp

N = 100_000
CELLS = 16
CONE = 0.3  # 1 - cos of its half angle

# Each map, and where its points land in the unit square.
BACK = {
    "concentric_disk": (warp.concentric_disk, lambda p: (longitude(p), p[0] ** 2 + p[1] ** 2)),
    "cosine_hemisphere": (warp.cosine_hemisphere, lambda w: (longitude(w), 1 - w[2] ** 2)),
    "uniform_hemisphere": (warp.uniform_hemisphere, lambda w: (longitude(w), w[2])),
    "uniform_sphere": (warp.uniform_sphere, lambda w: (longitude(w), 0.5 * w[2] + 0.5)),
    "uniform_cone": (
        lambda u: warp.uniform_cone(u, u.dtype.type(CONE)),
        lambda w: (longitude(w), (1 - w[2]) / CONE),
    ),
    "uniform_triangle": (
        warp.uniform_triangle,
        lambda b: ((1 - b[0]) ** 2, b[1] / np.maximum(1 - b[0], 1e-30)),
    ),
}


def landed(there, back, seed, dtype):
    """How many points land in each cell."""
    points = there(numbers(seed, N, dtype, 2))
    assert points.dtype == dtype
    return square(np.stack(back(points.astype(np.float64))), CELLS, CELLS)


def samplers():
    for name, (there, back) in BACK.items():
        for dtype in (np.float32, np.float64):
            yield Sampler(
                f"warp {name} {np.dtype(dtype)}",
                lambda seed, there=there, back=back, dtype=dtype: landed(there, back, seed, dtype),
                even(CELLS, CELLS),
            )
