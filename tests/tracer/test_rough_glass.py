"""Rough metal and rough glass: tables, Jacobians, what is conserved, and the smallest roughness."""

import numpy as np
import pytest
from rough import direction, facets, numbers
from stats import chi_square, sidak, z_limit
from truth import close, entry, keys

from tracer.bsdf import Conductor, Dielectric, RoughConductor, RoughDielectric
from tracer.bsdf.microfacet import DISTRIBUTIONS
from tracer.events import LOBES

pytestmark = pytest.mark.slow

ONES = np.ones((3, 1))
N = 100_000
kinds = pytest.mark.parametrize("kind", DISTRIBUTIONS)
both = pytest.mark.parametrize("dtype", (np.float32, np.float64))
TABLE = [key for key in keys("roughdiel.") if "etendue" not in key]


def glass(alpha, eta=1.5, kind="ggx", dtype=np.float64):
    columns = np.array([alpha]), np.array([alpha]), np.array([eta])
    return RoughDielectric(*columns, ONES, ONES, kind).astype(dtype)


def mirror(alpha, kind="ggx", dtype=np.float64):
    columns = np.array([alpha]), np.array([alpha]), ONES, np.full((3, 1), np.inf)
    return RoughConductor(*columns, ONES, kind).astype(dtype)


def uniform(seed, n, dtype=np.float64):
    """(3, n) numbers as the sampler gives them."""
    return np.stack((*numbers(seed, n, dtype), numbers(seed + 1, n, dtype)[0]))


def parts(material, wo, u):
    """Energy reflected and transmitted by each sample, two (N,)."""
    s = material.sample(wo, u)
    weight = (s.f[0] * np.abs(s.wi[2]) / np.where(s.pdf > 0, s.pdf, 1)).astype(np.float64)
    passed = s.lobe == LOBES.index("transmission")
    return np.where(passed, 0, weight), np.where(passed, weight, 0) * material.relative_eta(wo[2]) ** 2


@pytest.mark.statistical
@both
@pytest.mark.parametrize("key", TABLE)
def test_s42_reflected_and_transmitted_energy(suite_seed, key, dtype):
    """roughdiel.R, T and their sum, from outside and (with total reflection) from inside."""
    p, value = entry(key)
    down = "glass->air" in p["side"]
    wo = direction(p["mu"], N, dtype) * (-1 if down else 1)
    reflected, passed = parts(glass(p["alpha"], p["n"], dtype=dtype), wo, uniform(suite_seed, N, dtype))
    got = {"R": reflected, "T": passed, "sum": reflected + passed}[key.split(".")[1]]
    error = got.std() / np.sqrt(N)
    assert (reflected + passed).max() <= 1 + 64 * np.finfo(dtype).eps
    assert abs(got.mean() - value) < z_limit(2 * len(TABLE)) * error + 1e-6


@pytest.mark.statistical
def test_s42_an_index_three_hundredths_off_is_caught(suite_seed):
    """The broken twin."""
    p, value = entry("roughdiel.T.out.alpha=0.1.mu=0.2")
    wo = direction(p["mu"], 4 * N)
    _, passed = parts(glass(p["alpha"], 1.03 * p["n"]), wo, uniform(suite_seed, 4 * N))
    assert abs(passed.mean() - value) > z_limit(2 * len(TABLE)) * passed.std() / np.sqrt(4 * N)


@pytest.mark.statistical
def test_s42_as_much_light_gets_out_as_in(suite_seed):
    """T averaged over the hemisphere: from air it is n^2 times that from glass."""
    p, value = entry("roughdiel.etendue.alpha=0.5")
    rng, n = np.random.default_rng(suite_seed), 4 * N
    mu, phi = np.sqrt(rng.random(n)), 2 * np.pi * rng.random(n)
    r = np.sqrt(1 - mu * mu)
    material, u = glass(p["alpha"], p["n"]), uniform(suite_seed, n)
    for side, scale in ((1, 1.0), (-1, p["n"] ** 2)):
        _, passed = parts(material, np.stack((r * np.cos(phi), r * np.sin(phi), side * mu)), u)
        error = scale * passed.std() / np.sqrt(n)
        assert abs(scale * passed.mean() - value) < z_limit(2) * error


@kinds
@pytest.mark.parametrize("eta", [1.5, 1 / 1.5])
@pytest.mark.parametrize("side", [1, -1])
def test_densities_are_those_of_the_normal_through_the_map(suite_seed, kind, eta, side):
    """pdf(wi) = P(lobe) visible(m) |dm/dwi|, with the Jacobian by finite differences of the sampler's own
    map: a plain difference in three directions, independent of the formulas."""
    material, wo = glass(0.4, eta, kind), side * direction(0.6, 200)
    u, f = uniform(suite_seed, 200), facets(kind, 0.4, 0.4)
    base, h = material.sample(wo, u), 1e-5
    use = (base.pdf > 0) & (np.abs(base.wi[2]) > 0.1)
    m, _, F, _ = material._normal(wo, base.wi)
    step = []
    for k in (1, 2):
        moved = u.copy()
        moved[k] = np.where(u[k] > 0.5, u[k] - h, u[k] + h)
        s = material.sample(wo, moved)
        use &= (s.lobe == base.lobe) & (s.pdf > 0) & (u[1] > 0.01)
        step.append(((s.wi - base.wi) / h, (material._normal(wo, s.wi)[0] - m) / h))
    (wi_1, m_1), (wi_2, m_2) = step
    ratio = np.linalg.norm(np.cross(m_1, m_2, axis=0), axis=0) / np.linalg.norm(
        np.cross(wi_1, wi_2, axis=0), axis=0
    )
    chance = np.where(base.lobe == LOBES.index("reflection"), F, 1 - F)
    expected = chance * f.visible_pdf(side * wo, m) * ratio
    assert use.sum() > 100
    assert np.allclose(base.pdf[use], expected[use], rtol=0.02)
    assert np.median(np.abs(base.pdf[use] / expected[use] - 1)) < 1e-3


@pytest.mark.statistical
@both
@kinds
@pytest.mark.parametrize("alpha", [1e-3, 0.02])
@pytest.mark.parametrize("name", ["metal", "glass", "glass, inside"])
def test_directions_of_a_tiny_lobe_follow_their_density(suite_seed, name, alpha, kind, dtype):
    """The lobe is smaller than any cell of directions: its half vectors are tested, in slopes over alpha."""
    side = -1.0 if "inside" in name else 1.0
    wo = (side * direction(0.8, N)).astype(dtype)
    material = mirror(alpha, kind, dtype) if name == "metal" else glass(alpha, 1.5, kind, dtype)
    s = material.sample(wo, uniform(suite_seed, N, dtype))
    assert (s.pdf > 0).mean() > 0.999
    wi, wo = s.wi.astype(np.float64), wo.astype(np.float64)
    h = wo + wi if name == "metal" else material.astype(np.float64)._normal(wo, wi)[0]
    slopes = h[:2] / h[2] / alpha
    edges = np.linspace(-3, 3, 13)
    counts = np.histogram2d(*slopes, (edges, edges))[0]
    shares = slope_shares(facets(kind, alpha, alpha), side * wo[:, :1], edges, alpha)
    rest = N - counts.sum()
    p = chi_square(np.append(counts, rest), N * np.append(shares, 1 - shares.sum()))
    assert p > sidak(24)
    tilted = N * np.append(1.03 * shares, 1 - 1.03 * shares.sum())  # the broken twin: 3 % too narrow
    assert chi_square(np.append(counts, rest), tilted) < sidak(24)


def slope_shares(f, wo, edges, alpha):
    """What the visible normals put into each cell of slopes over alpha."""
    x, weight = np.polynomial.legendre.leggauss(10)
    width = edges[1] - edges[0]
    nodes = (edges[:-1, None] + width * (0.5 * x + 0.5)).ravel()
    a, b = (alpha * grid.ravel() for grid in np.meshgrid(nodes, nodes, indexing="ij"))
    m = np.stack((a, b, np.ones_like(a))) / np.sqrt(1 + a * a + b * b)
    value = f.visible_pdf(np.broadcast_to(wo, m.shape), m) * m[2] ** 3 * alpha * alpha
    value = value.reshape(len(edges) - 1, 10, len(edges) - 1, 10)
    weight = 0.5 * width * weight
    return (value * weight[:, None, None] * weight).sum(axis=(1, 3))


@pytest.mark.statistical
@kinds
@pytest.mark.parametrize("mu", [1.0, 0.5, 0.1])
def test_s37_rough_glass_and_metal_tend_to_the_smooth_ones(suite_seed, kind, mu):
    """At alpha = 1e-4 energy is that of the Dirac lobes, and directions are theirs to a few alpha."""
    wo, u = direction(mu, N), uniform(suite_seed, N)
    reflected, passed = parts(glass(1e-4, kind=kind), wo, u)
    smooth = Dielectric(np.array([1.5]), ONES, ONES)
    F = smooth.reflectance_at(wo[2, :1])[0, 0]
    for got, want in ((reflected, F), (passed, 1 - F)):
        assert abs(got.mean() - want) < z_limit(12) * got.std() / np.sqrt(N) + 1e-4
    s, sharp = mirror(1e-4, kind).sample(wo, u), Conductor(ONES, np.inf * ONES, ONES).sample(wo, u)
    assert np.median(np.abs(s.wi - sharp.wi).max(axis=0)) < 5e-4


@both
@kinds
@pytest.mark.parametrize("mu", [1e-2, 1e-4, 1e-8])
@pytest.mark.parametrize("side", [1, -1])
def test_s40_grazing_rough_glass(suite_seed, kind, mu, side, dtype):
    with np.errstate(all="raise", under="ignore"):
        for alpha in (1e-4, 0.1, 1.0):
            wo = side * direction(mu, 5000, dtype)
            for material in (glass(alpha, 1.5, kind, dtype), glass(alpha, 1 / 2.4, kind, dtype)):
                s = material.sample(wo, uniform(suite_seed, 5000, dtype))
                assert np.isfinite(s.f).all() and np.isfinite(s.pdf).all() and (s.pdf >= 0).all()
                assert np.isfinite(s.wi).all()


@both
@kinds
def test_no_energy_is_made_by_any_sample(suite_seed, kind, dtype):
    """G2 / G1 is at most 1, so no sample of rough glass carries more than it was given."""
    for alpha in (1e-3, 0.1, 0.5, 1.0):
        for eta in (1.5, 1 / 1.5, 1.0003):
            for mu in (1.0, 0.3, 0.01, -0.2, -0.9):
                wo = np.sign(mu) * direction(abs(mu), 4000, dtype)
                reflected, passed = parts(
                    glass(alpha, eta, kind, dtype), wo, uniform(suite_seed, 4000, dtype)
                )
                assert (reflected + passed).max() <= 1 + 1e3 * np.finfo(dtype).eps, (alpha, eta, mu)


def test_a_rough_mirror_reflects_everything_in_front_and_nothing_behind():
    """k = inf: F = 1, and at cosines of a half f is D G2."""
    wo, wi = direction(0.5, 10), direction(0.5, 10, phi=0.7 + np.pi)
    f = facets("ggx", 0.3, 0.3)
    assert close(mirror(0.3).eval(wo, wi)[0, 0], (f.D(direction(1.0)) * f.G2(wo, wi))[0])
    assert not mirror(0.3).eval(-wo, wi).any() and not mirror(0.3).pdf(wo, -wi).any()
