"""Lobes smaller than any cell of directions: their half vectors, in slopes over the roughness."""

from functools import cache, partial

import numpy as np
from rough import direction, facets
from values.facets import glass, three

from densities.sampler import Sampler, nodes
from tracer.bsdf import RoughConductor, RoughPlastic
from tracer.bsdf.microfacet import DISTRIBUTIONS
from tracer.events import LOBES

N = 60_000
# Roughness, and cosines of wo from which next to nothing goes below the surface.
HEIGHTS = {1e-3: (1.0, 0.8, 0.3, 0.1), 0.02: (1.0, 0.8, 0.5)}
MATERIALS = ("metal", "plastic", "glass", "glass, inside")
CELLS, WIDE = 12, 3.0  # slopes over alpha from -WIDE to WIDE
ONES = np.ones((3, 1))


@cache
def made(name, alpha, kind):
    """The material in float64."""
    column = np.array([alpha])
    if name == "metal":
        return RoughConductor(column, column, ONES, np.full((3, 1), np.inf), ONES, kind)
    if name == "plastic":
        return RoughPlastic.coated(column, np.array([1.5]), 0.01 * ONES, ONES, distribution=kind)
    return glass(alpha, 1.5, kind)


def half_vectors(name, material, wo, wi):
    """Of light that is reflected or, in glass, refracted: (3, N)."""
    return material._normal(wo, wi)[0] if "glass" in name else wo + wi


def count(name, alpha, mu, kind, dtype, seed):
    """Slopes of the samples that facets sent on, and how many lie outside the cells: steeper ones, among them
    all that sent light to the wrong side."""
    material = made(name, alpha, kind)
    wo = ((-1.0 if "inside" in name else 1.0) * direction(mu, N)).astype(dtype)
    with np.errstate(all="ignore"):
        s = material.astype(dtype).sample(wo, three(seed, N, dtype))
    of_facets = s.lobe != LOBES.index("diffuse")
    right = of_facets & (s.pdf > 0)
    wo, wi = (w[:, right].astype(np.float64) for w in (wo, s.wi))
    h = half_vectors(name, material, wo, wi)
    edges = np.linspace(-WIDE, WIDE, CELLS + 1)
    counts = np.histogram2d(*(h[:2] / h[2] / alpha), (edges, edges))[0]
    return np.append(counts, of_facets.sum() - counts.sum())


@cache
def expect(alpha, mu, kind, wider=1.0):
    """What the visible normals put into each cell of slopes over alpha; wider: of another roughness."""
    x, weight = nodes(CELLS, 10)
    x, weight = alpha * WIDE * (2.0 * x - 1.0), alpha * WIDE * 2.0 * weight
    a, b = (grid.ravel() for grid in np.meshgrid(x, x, indexing="ij"))
    m = np.stack((a, b, np.ones_like(a))) / np.sqrt(1.0 + a * a + b * b)
    w = np.broadcast_to(direction(mu), m.shape)
    value = facets(kind, wider * alpha, wider * alpha).visible_pdf(w, m) * m[2] ** 3
    value = value.reshape(x.size, x.size) * weight[:, None] * weight
    return value.reshape(CELLS, 10, CELLS, 10).sum(axis=(1, 3)).ravel()


def samplers():
    for name in MATERIALS:
        for alpha, heights in HEIGHTS.items():
            for mu in heights:
                for kind in DISTRIBUTIONS:
                    for dtype in (np.float32, np.float64):
                        yield Sampler(
                            f"lobe {name} {kind} {alpha:g} cos {mu:g} {np.dtype(dtype)}",
                            partial(count, name, alpha, mu, kind, dtype),
                            partial(expect, alpha, mu, kind),
                            (("roughness 5 % off", partial(expect, alpha, mu, kind, 1.05)),),
                        )
