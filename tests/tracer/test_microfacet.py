"""Normals of rough surfaces: exact values, what they add up to, and that samples follow their density.

Sampling is tested by chi-square in the space of slopes, where the lobe has the same size at every roughness,
at a significance of 1 % shared out by Sidak's formula among all tests of the family.
"""

import numpy as np
import pytest
from rough import direction, facets, numbers
from stats import chi_square, sidak
from truth import ULPS, close, entry, keys

from tracer.bsdf.microfacet import DISTRIBUTIONS, Facets, mirrored, reflected, unit

DTYPES = (np.float32, np.float64)
ALPHAS = ((1e-3, 1e-3), (0.02, 0.02), (0.1, 0.4), (0.5, 0.5), (1.0, 1.0))
HEIGHTS = (1.0, 0.5, 0.05, 1e-3)  # cosines of wo
N = 40_000
CHI_TESTS = len(DISTRIBUTIONS) * len(ALPHAS) * len(HEIGHTS) * len(DTYPES)

kinds = pytest.mark.parametrize("kind", DISTRIBUTIONS)
alphas = pytest.mark.parametrize("alpha", ALPHAS, ids=lambda a: f"{a[0]:g}x{a[1]:g}")
heights = pytest.mark.parametrize("mu", HEIGHTS)
both = pytest.mark.parametrize("dtype", DTYPES)


def hemisphere(n_phi=256, n_z=160):
    """Nodes (3, K) and weights (K,) of an integral over the upper hemisphere."""
    z, w = np.polynomial.legendre.leggauss(n_z)
    z, w = 0.5 * z + 0.5, 0.5 * w
    phi = (np.arange(n_phi) + 0.5) * (2 * np.pi / n_phi)
    phi, z = (grid.ravel() for grid in np.meshgrid(phi, z, indexing="ij"))
    r = np.sqrt(1 - z * z)
    return np.stack((r * np.cos(phi), r * np.sin(phi), z)), np.tile(w, n_phi) * (2 * np.pi / n_phi)


def stretched(normals, f):
    """Normals (3, N) as directions of the surface of roughness 1."""
    return unit(np.stack((normals[0] / f.alpha_u, normals[1] / f.alpha_v, normals[2])).astype(np.float64))


def unstretched(m, f):
    """The way back, and the solid angle before over after: (3, K), (K,)."""
    normals = unit(np.stack((f.alpha_u * m[0], f.alpha_v * m[1], m[2])))
    return normals, f.alpha_u * f.alpha_v * (normals[2] / m[2]) ** 3


def point(key, dtype):
    """What the code makes of a truth value point.*.*, in one precision."""
    p, _ = entry(key)
    f = facets(p["kind"], p["alpha_x"], p["alpha_y"], dtype)
    wi, wo = ((np.array(p[w]) / np.linalg.norm(p[w]))[:, None].astype(dtype) for w in ("wi", "wo"))
    at = mirrored(f, wi, wo)
    quantities = {
        "D": lambda: f.D(at.m),
        "Lambda_i": lambda: f.hidden(wi) / wi[2],
        "G2": lambda: f.G2(wi, wo),
        "f": lambda: at.f,
        "pdf_vndf": lambda: at.pdf,
    }
    return quantities[key.rpartition(".")[2]]()[0]


POINTS = keys("point.ggx.", "point.beckmann.")


@pytest.mark.parametrize("key", POINTS)
def test_values_at_a_point(key):
    assert close(point(key, np.float64), entry(key)[1]), key


# In float32 an exponent of -23 turns an ulp of the slope into 1e-6, and exp(-178) is below every number.
LOST = {"point.beckmann.aniso.D": 1e-5, "point.beckmann.aniso.pdf_vndf": 1e-5}


@pytest.mark.parametrize("key", [k for k in POINTS if "side.a=0.1.Lambda" not in k])
def test_values_at_a_point_in_single_precision(key):
    got, want = point(key, np.float32), entry(key)[1]
    assert got.dtype == np.float32
    assert close(got, want, LOST.get(key, ULPS * np.finfo(np.float32).eps)), key


@pytest.mark.parametrize("key", keys("norm.D."))
def test_the_normals_make_up_the_surface(key):
    """The integral of D cos is 1, over the hemisphere stretched to roughness 1."""
    p, value = entry(key)
    assert close(projected(facets("ggx", p["alpha"], p["alpha"])), value)


def projected(f):
    m, weight = hemisphere(64, 160)
    normals, change = unstretched(m, f)
    return (f.D(normals) * normals[2] * change * weight).sum()


@kinds
@alphas
def test_the_normals_of_any_roughness_make_up_the_surface(kind, alpha):
    assert close(projected(facets(kind, *alpha)), 1.0, 1e-9)


@kinds
@alphas
@pytest.mark.parametrize("mu", [1.0, 0.5, 0.05])
def test_what_is_visible_is_the_surface_itself(kind, alpha, mu):
    """The visible normals make up 1: the area facing w is cos (1 + Lambda)."""
    f, w = facets(kind, *alpha), direction(mu)
    m, weight = hemisphere()
    normals, change = unstretched(m, f)
    seen = f.visible_pdf(np.broadcast_to(w, m.shape), normals) * change * weight
    assert close(seen.sum(), 1.0, 2e-4)  # the kink at w.m = 0 limits the quadrature, not the formula


@pytest.mark.parametrize("key", keys("vndf.cdf.normal."))
def test_share_of_visible_normals_within_an_angle(key):
    p, value = entry(key)
    f = facets("ggx", p["alpha"], p["alpha"])
    x, weight = np.polynomial.legendre.leggauss(200)
    theta, weight = p["theta"] * (0.5 * x + 0.5), p["theta"] * 0.5 * weight
    m = np.stack((np.sin(theta), 0 * theta, np.cos(theta)))
    w = np.repeat([[0.0], [0.0], [1.0]], 200, axis=1)
    assert close((f.visible_pdf(w, m) * 2 * np.pi * np.sin(theta) * weight).sum(), value)


@pytest.mark.parametrize("key", keys("vndf.moment."))
def test_moments_of_visible_normals(key):
    """By a grid of numbers over the unit square put through the sampler; mends its own error at the edges."""
    p, value = entry(key)
    f, w = facets("ggx", p["alpha"], p["alpha"]), direction(p["mu"], 1, phi=0.0)
    side = (np.arange(1000) + 0.5) / 1000
    u = np.stack([grid.ravel() for grid in np.meshgrid(side, side)])
    m = f.visible(np.broadcast_to(w, (3, u.shape[1])), u)
    moment = {"mx": m[0], "mz": m[2], "mx2": m[0] ** 2}[p["moment"]].mean()
    assert close(moment, value, 1e-5)


def chi(f, density, w, u):
    """p-value of visible normals against a density, over a grid of the stretched hemisphere."""
    columns, rows, points = 12, 8, 24
    m = stretched(f.visible(w, u), f)
    counts = np.histogram2d(
        np.arctan2(m[1], m[0]) / (2 * np.pi) % 1.0, m[2], (columns, rows), ((0, 1), (0, 1))
    )[0]
    x, weight = np.polynomial.legendre.leggauss(points)
    phi = ((np.arange(columns)[:, None] + 0.5 * x + 0.5) / columns * 2 * np.pi).ravel()
    z = ((np.arange(rows)[:, None] + 0.5 * x + 0.5) / rows).ravel()
    grid_phi, grid_z = (grid.ravel() for grid in np.meshgrid(phi, z, indexing="ij"))
    r = np.sqrt(1 - grid_z * grid_z)
    wide = Facets(f.distribution, f.alpha_u.astype(np.float64), f.alpha_v.astype(np.float64))
    normals, change = unstretched(np.stack((r * np.cos(grid_phi), r * np.sin(grid_phi), grid_z)), wide)
    value = density(wide, np.broadcast_to(w[:, :1].astype(np.float64), normals.shape), normals) * change
    value = value.reshape(columns, points, rows, points)
    weight = 0.5 * weight
    shares = (value * weight[:, None, None] * weight).sum(axis=(1, 3)) * (2 * np.pi / (columns * rows))
    assert abs(shares.sum() - 1) < 3e-3
    return chi_square(counts, u.shape[1] * shares / shares.sum())


@pytest.mark.statistical
@both
@heights
@alphas
@kinds
def test_visible_normals_follow_their_density(suite_seed, kind, alpha, mu, dtype):
    f = facets(kind, *alpha, dtype)
    p = chi(f, Facets.visible_pdf, direction(mu, N, dtype), numbers(suite_seed, N, dtype))
    assert p > sidak(CHI_TESTS)


@pytest.mark.statistical
@kinds
def test_a_roughness_5_percent_off_is_caught(suite_seed, kind):
    """The broken twin: normals of alpha = 1e-3 against the density of 1.05e-3."""

    def other(f, w, m):
        return Facets(kind, 1.05 * f.alpha_u, 1.05 * f.alpha_v).visible_pdf(w, m)

    f = facets(kind, 1e-3, 1e-3)
    w, u = direction(0.5, N), numbers(suite_seed, N, np.float64)
    assert chi(f, other, w, u) < sidak(CHI_TESTS)


@kinds
def test_the_inversion_of_visible_slopes_meets_its_numbers(kind):
    """Beckmann's slopes are found by Newton's method: what lies beyond the slope is what was asked for."""
    if kind == "ggx":
        return
    from scipy.special import erfc

    u0 = np.concatenate(([0.0, 2.0**-32, 1 - 2.0**-32], np.linspace(0, 1, 5000, endpoint=False)))
    for cot in (1e-8, 1e-2, 0.3, 1.0, 2.0, 10.0, 1e6):
        r, z = 1 / np.hypot(1, cot), cot / np.hypot(1, cot)
        w = np.repeat([[r], [0.0], [z]], u0.size, axis=1)
        x, _, _ = DISTRIBUTIONS[kind].visible(w, np.stack((u0, np.full(u0.size, 0.5))))
        beyond = z * erfc(x) + r * np.exp(-x * x) / np.sqrt(np.pi)
        low = -min(cot, 1e3)
        whole = z * erfc(low) + r * np.exp(-low * low) / np.sqrt(np.pi)
        assert np.abs(beyond / whole - (1 - u0)).max() < 1e-8


@both
@kinds
@pytest.mark.parametrize("mu", [1e-2, 1e-4, 1e-8, 0.0])
def test_s40_grazing_views_stay_finite(suite_seed, kind, mu, dtype):
    for alpha in (1e-4, 0.1, 1.0):
        f, wo = facets(kind, alpha, alpha, dtype), direction(mu, 20_000, dtype)
        m = f.visible(wo, numbers(suite_seed, 20_000, dtype))
        wi = reflected(wo, m)
        assert (m[2] > 0).all() and np.isfinite(m).all()
        at = mirrored(f, wo, wi)
        assert np.isfinite(at.pdf).all() and np.isfinite(at.f).all()
        weight = at.f * wi[2] / np.where(at.pdf > 0, at.pdf, 1)
        assert (weight >= 0).all() and weight.max() <= 1 + 8 * np.finfo(dtype).eps


@both
@kinds
@alphas
@heights
def test_no_weight_is_above_one(suite_seed, kind, alpha, mu, dtype):
    """f cos / pdf = G2 / G1 of a surface that reflects everything, sampled by its visible normals."""
    f, wo = facets(kind, *alpha, dtype), direction(mu, 5000, dtype)
    wi = reflected(wo, f.visible(wo, numbers(suite_seed, 5000, dtype)))
    at = mirrored(f, wo, wi)
    weight = at.f * wi[2] / np.where(at.pdf > 0, at.pdf, 1)
    assert weight.max() <= 1 + 8 * np.finfo(dtype).eps
    assert not at.f[wi[2] <= 0].any() and not at.pdf[wi[2] <= 0].any()
