"""Visible normals of rough surfaces, stretched so that the lobe has one size at every roughness."""

from functools import cache, partial

import numpy as np
from rough import direction, facets, numbers
from values.facets import unstretched

from densities.sampler import Sampler, longitude, nodes, square
from tracer.bsdf.microfacet import DISTRIBUTIONS, unit

ALPHAS = ((1e-3, 1e-3), (0.02, 0.02), (0.1, 0.4), (0.5, 0.5), (1.0, 1.0))
HEIGHTS = (1.0, 0.5, 0.05, 1e-3)  # cosines of wo
N = 60_000
COLUMNS, ROWS, POINTS = 12, 8, 24


def stretched(normals, f):
    """Normals (3, N) as directions of the surface of roughness 1."""
    return unit(np.stack((normals[0] / f.alpha_u, normals[1] / f.alpha_v, normals[2])).astype(np.float64))


def count(kind, alpha, mu, dtype, seed):
    f = facets(kind, *alpha, dtype)
    m = stretched(f.visible(direction(mu, N, dtype), numbers(seed, N, dtype)), f)
    return square(np.stack((longitude(m), m[2])), COLUMNS, ROWS)


@cache
def expect(kind, alpha, mu, wider=1.0):
    """The density over a grid of the stretched hemisphere; wider: of another roughness than the grid's."""
    f = facets(kind, *alpha)
    (turn, w_turn), (z, w_z) = nodes(COLUMNS, POINTS), nodes(ROWS, POINTS)
    turn, z = (grid.ravel() for grid in np.meshgrid(2 * np.pi * turn, z, indexing="ij"))
    r = np.sqrt(1 - z * z)
    normals, change = unstretched(np.stack((r * np.cos(turn), r * np.sin(turn), z)), f)
    w = np.broadcast_to(direction(mu), normals.shape)
    value = facets(kind, *(wider * a for a in alpha)).visible_pdf(w, normals) * change
    value = value.reshape(w_turn.size, w_z.size) * (2 * np.pi * w_turn)[:, None] * w_z
    shares = value.reshape(COLUMNS, POINTS, ROWS, POINTS).sum(axis=(1, 3)).ravel()
    assert wider != 1.0 or abs(shares.sum() - 1) < 3e-3
    return shares / shares.sum()


def samplers():
    for kind in DISTRIBUTIONS:
        for alpha in ALPHAS:
            for mu in HEIGHTS:
                for dtype in (np.float32, np.float64):
                    yield Sampler(
                        f"normals {kind} {alpha[0]:g}x{alpha[1]:g} cos {mu:g} {np.dtype(dtype)}",
                        partial(count, kind, alpha, mu, dtype),
                        partial(expect, kind, alpha, mu),
                        (("roughness 5 % off", partial(expect, kind, alpha, mu, 1.05)),),
                    )
