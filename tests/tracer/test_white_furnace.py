"""How much light rough surfaces send back: the white furnace, against tables exact to ten digits and more.

Each test's significance is 1 % shared out by Sidak's formula among all keys of the table.
"""

import numpy as np
import pytest
from rough import direction, facets, numbers
from stats import z_limit
from truth import close, entry, keys

from tracer.bsdf import fresnel
from tracer.bsdf.microfacet import DISTRIBUTIONS, mirrored, reflected

kinds = pytest.mark.parametrize("kind", DISTRIBUTIONS)
both = pytest.mark.parametrize("dtype", (np.float32, np.float64))


def weights(f, mu, seed, n=100_000, phi=0.0, F=None, separable=False):
    """Weights f cos / pdf (n,) of reflection at the facets. F: their reflectance, 1 if None."""
    wo = direction(mu, n, phi=phi)
    wi = reflected(wo, f.visible(wo, numbers(seed, n, np.float64)))
    at = mirrored(f, wo, wi)
    weight = at.f * wi[2] / np.where(at.pdf > 0, at.pdf, 1)
    if separable:
        weight *= f.G1(wo) * f.G1(wi) / np.where(weight > 0, f.G2(wo, wi), 1)
    return weight if F is None else weight * F(at.cos)


def furnace(*arguments, bar, **options):
    """Mean weight and its standard error, from as many samples as bring that below a bar."""
    batches = []
    while True:
        batches.append(weights(*arguments, **{**options, "seed": options["seed"] + len(batches)}))
        weight = np.concatenate(batches)
        error = weight.std() / np.sqrt(weight.size)
        if error < bar:
            return weight.mean(), error


def reflectance(name):
    """The facets' reflectance in keys like albedo.ggx.NAME.*: a function of the cosine."""
    if name.startswith("schlick"):
        return lambda cos: fresnel.schlick(cos, float(name.removeprefix("schlick")))
    if name.startswith("diel"):
        eta = np.array([float(name.removeprefix("diel"))])
        return lambda cos: fresnel.dielectric_mean(cos, eta)[0]
    if name == "gold_like_650":
        return lambda cos: fresnel.conductor_mean(cos, np.full((1, 1), 0.166), np.full((1, 1), 3.15))[0]
    return None


def described(p):
    alpha = p.get("alpha"), p.get("alpha")
    f = facets(p.get("kind", "ggx"), *((p["alpha_x"], p["alpha_y"]) if "alpha_x" in p else alpha))
    return f, p["mu"], np.radians(p.get("phi_deg", 0.0))


ALBEDO = keys("albedo.")


@pytest.mark.statistical
@pytest.mark.parametrize("key", ALBEDO)
def test_s38_white_furnace(suite_seed, key):
    p, value = entry(key)
    f, mu, phi = described(p)
    options = {"phi": phi, "F": reflectance(key.split(".alpha=")[0].split(".", 2)[2])}
    options["separable"] = ".separable." in key
    bar = 0.0025 * value  # 4 standard errors are then within 1 %
    mean, error = furnace(f, mu, seed=suite_seed, bar=bar, **options)
    assert abs(mean - value) < z_limit(len(ALBEDO)) * error + 1e-9


@pytest.mark.statistical
def test_s38_the_other_masking_function_is_caught(suite_seed):
    """The broken twin: heights taken for independent, where they are correlated."""
    p, value = entry("albedo.ggx.separable.alpha=0.1.mu=0.5")
    f, mu, phi = described(p)
    mean, error = furnace(f, mu, seed=suite_seed, bar=0.0025, phi=phi, separable=True)
    assert abs(mean - value) < z_limit(len(ALBEDO)) * error
    p, value = entry("albedo.ggx.corr.alpha=1.0.mu=0.1")
    f, mu, phi = described(p)
    mean, error = furnace(f, mu, seed=suite_seed, bar=0.0025, phi=phi, separable=True)
    assert abs(mean - value) > z_limit(len(ALBEDO)) * error


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
def test_s41_what_goes_below_the_surface_is_what_the_furnace_lacks(suite_seed):
    """Weight 0, exactly, and counted: the samples below, and the shadowing above, are the deficit 1 - E."""
    f, n = facets("ggx", 1.0, 1.0), 200_000
    wo = direction(0.5, n)
    wi = reflected(wo, f.visible(wo, numbers(suite_seed, n, np.float64)))
    at = mirrored(f, wo, wi)
    below = wi[2] <= 0
    assert below.any() and not at.f[below].any() and not at.pdf[below].any()
    shadowed = 1 - f.G2(wo, wi)[~below] / f.G1(wo)[~below]
    lost = np.where(below, 1.0, 0.0)
    lost[~below] = shadowed
    lost_mean, error = lost.mean(), lost.std() / np.sqrt(n)
    mean, other = furnace(f, 0.5, seed=suite_seed + 1000, bar=0.002, phi=0.7)
    assert abs(lost_mean - (1 - mean)) < 4 * np.hypot(error, other)
