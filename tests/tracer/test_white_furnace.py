"""How much light rough surfaces send back: the white furnace beside its tables, which test_truth has."""

import numpy as np
import pytest
from rough import direction, facets, numbers
from stats import z_limit
from truth import close, entry
from values.facets import albedo, weights
from values.registry import Estimate

from tracer.bsdf.microfacet import DISTRIBUTIONS, mirrored, reflected

kinds = pytest.mark.parametrize("kind", DISTRIBUTIONS)
both = pytest.mark.parametrize("dtype", (np.float32, np.float64))


@pytest.mark.statistical
@both
def test_s38_the_roughest_surface_sends_back_1_minus_ln_2(suite_seed, dtype):
    p, value = entry("albedo.ggx.exact.alpha=1.mu=1")
    assert close(value, 1 - np.log(2))
    found = Estimate.of(weights(facets("ggx", 1.0, 1.0, dtype), p["mu"], suite_seed, 400_000, dtype=dtype))
    assert abs(found.mean - value) < 4 * found.error and not abs(1.02 * found.mean - value) < 4 * found.error


@pytest.mark.statistical
def test_s38_the_other_masking_function_is_caught(suite_seed):
    """The broken twin: heights taken for independent, where they are correlated."""
    for key, right in (("separable.alpha=0.1.mu=0.5", True), ("corr.alpha=1.0.mu=0.1", False)):
        given, value = entry(f"albedo.ggx.{key}")
        found = Estimate.of(albedo(f"albedo.ggx.{key}", given, 64, suite_seed, 200_000, separable=True))
        assert (abs(found.mean - value) < z_limit(2) * found.error) == right


@kinds
@both
def test_s37_the_smoothest_surface_is_a_mirror(suite_seed, kind, dtype):
    """At alpha = 1e-4 the height of D is right to rounding, and all light stays near the mirror direction."""
    f = facets(kind, 1e-4, 1e-4, dtype)
    up = direction(1.0, 1, dtype)
    assert close(f.D(up)[0], 1 / (np.pi * 1e-8), 1e-12 if dtype == np.float64 else 4 * np.finfo(dtype).eps)
    wo = direction(0.6, 20_000, dtype)
    wi = reflected(wo, f.visible(wo, numbers(suite_seed, 20_000, dtype)))
    far = np.hypot(wi[0] + wo[0], wi[1] + wo[1])
    assert np.median(far) < 3e-4 and (wi[2] > 0).mean() > 0.999
    at = mirrored(f, wo, wi)
    assert np.isfinite(at.f).all() and np.isfinite(at.pdf).all()


@pytest.mark.statistical
@both
def test_s41_what_goes_below_the_surface_is_what_the_furnace_lacks(suite_seed, dtype):
    """Weight 0, exactly, and counted: the samples below, and the shadowing above, are the deficit 1 - E."""
    f, n = facets("ggx", 1.0, 1.0, dtype), 200_000
    wo = direction(0.5, n, dtype)
    wi = reflected(wo, f.visible(wo, numbers(suite_seed, n, dtype)))
    at = mirrored(f, wo, wi)
    below = wi[2] <= 0
    assert below.any() and not at.f[below].any() and not at.pdf[below].any()
    shadowed = 1 - f.G2(wo, wi)[~below] / f.G1(wo)[~below]
    lost = np.where(below, 1.0, 0.0)
    lost[~below] = shadowed
    lost_mean, error = lost.mean(), lost.std() / np.sqrt(n)
    kept = Estimate.of(weights(f, 0.5, suite_seed + 1000, n, phi=0.7, dtype=dtype))
    together = np.hypot(error, kept.error)
    assert abs(lost_mean - (1 - kept.mean)) < 4 * together
    # The broken twin: what goes below is not counted.
    assert abs(np.where(below, 0.0, lost).mean() - (1 - kept.mean)) > 4 * together
