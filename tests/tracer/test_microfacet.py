"""Normals of rough surfaces: what they add up to, and their samples at the limits.

Values are in test_truth; that samples follow their density is in test_densities.
"""

import numpy as np
import pytest
from rough import direction, facets, numbers
from truth import close
from values.facets import hemisphere, projected, unstretched

from tracer.bsdf.microfacet import DISTRIBUTIONS, mirrored, reflected

DTYPES = (np.float32, np.float64)
ALPHAS = ((1e-3, 1e-3), (0.02, 0.02), (0.1, 0.4), (0.5, 0.5), (1.0, 1.0))
HEIGHTS = (1.0, 0.5, 0.05, 1e-3)  # cosines of wo

kinds = pytest.mark.parametrize("kind", DISTRIBUTIONS)
alphas = pytest.mark.parametrize("alpha", ALPHAS, ids=lambda a: f"{a[0]:g}x{a[1]:g}")
heights = pytest.mark.parametrize("mu", HEIGHTS)
both = pytest.mark.parametrize("dtype", DTYPES)


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
