"""Directions of materials over the whole sphere, of every example and from several angles."""

from functools import cache, partial

import numpy as np
from examples import SMOOTH, names
from lamps import numbers

from densities.sampler import Sampler, nodes
from tracer.bsdf import Plastic

MATERIALS = dict(zip(names(SMOOTH), SMOOTH, strict=True))

TILTS = (0.0, 0.7, 1.2, 1.55)  # angles of wo from the normal
COLUMNS, ROWS = 16, 10  # of the grid: longitude, and cosine over the whole sphere
N = 60_000  # samples that have a density, or a tenth of all


def tilted(tilt, n, dtype=np.float64):
    """n copies of the direction at an angle from the normal."""
    w = np.array([np.sin(tilt) * 0.6, np.sin(tilt) * -0.8, np.cos(tilt)])
    return np.repeat((w / np.linalg.norm(w)).astype(dtype)[:, None], n, axis=1)


def grid_of(wi, wo):
    """How many directions fall into each cell. The grid is made of signed roots, of the height and of the
    longitude from the mirror direction's, so that cells are narrow where grazing lobes are."""
    turn = np.arctan2(-wo[1, 0], -wo[0, 0])
    around = np.remainder(np.arctan2(wi[1], wi[0]) - turn + np.pi, 2 * np.pi) / np.pi - 1.0
    spread = [0.5 * np.copysign(np.sqrt(np.abs(x)), x) + 0.5 for x in (around, wi[2])]
    return np.histogram2d(*spread, (COLUMNS, ROWS), ((0, 1), (0, 1)))[0]


def count(name, tilt, dtype, seed):
    """Samples in each cell, and those that have no density: below the surface, or of a Dirac lobe."""
    n = int(N / max(float(expect(name, tilt).sum()), 0.1))
    wo = tilted(tilt, n, dtype)
    with np.errstate(all="ignore"):
        sample = MATERIALS[name].astype(dtype).sample(wo, numbers(seed, n, dtype))
    has = (sample.pdf > 0) & ~sample.delta
    grid = grid_of(sample.wi[:, has].astype(np.float64), wo.astype(np.float64))
    return np.append(grid, n - np.count_nonzero(has))


@cache
def expect(name, tilt):
    """What the density puts into each cell, by Gauss-Legendre with 24 x 48 points a cell."""
    wo = tilted(tilt, 1)
    (phi, w_phi), (z, w_z) = _square(*nodes(COLUMNS, 24)), _square(*nodes(ROWS, 48))
    phi, z = np.meshgrid(np.arctan2(-wo[1, 0], -wo[0, 0]) + np.pi * phi, z, indexing="ij")
    phi, z, r = phi.ravel(), z.ravel(), np.sqrt(1 - z.ravel() ** 2)
    wi = np.stack((r * np.cos(phi), r * np.sin(phi), z))
    with np.errstate(all="ignore"):
        density = MATERIALS[name].pdf(np.repeat(wo, wi.shape[1], axis=1), wi).reshape(w_phi.size, w_z.size)
    share = density * (np.pi * w_phi)[:, None] * w_z
    return share.reshape(COLUMNS, 24, ROWS, 48).sum(axis=(1, 3))


def _square(t, weight):
    """Nodes and weights over [0, 1] moved to x = s |s| over [-1, 1], s = 2 t - 1."""
    s = 2 * t - 1
    return s * np.abs(s), 4 * np.abs(s) * weight


def only_a_mirror(material, tilt):
    """Whether a coat reflects everything: one that is thinner than air, beyond its critical angle."""
    return isinstance(material, Plastic) and np.sin(tilt) >= material.eta[0]


def samplers():
    for name, material in MATERIALS.items():
        for tilt in TILTS:
            for dtype in () if only_a_mirror(material, tilt) else (np.float32, np.float64):
                yield Sampler(
                    f"bsdf {name} at {tilt:g} {np.dtype(dtype)}",
                    partial(count, name, tilt, dtype),
                    partial(expect, name, tilt),
                )
