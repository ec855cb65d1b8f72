"""Every BSDF keeps the same promises; adding one to bsdf.ALL tests it.

Sampling is tested by chi-square over a grid of the sphere, at a significance of 1 % shared out by Sidak's
formula among all materials, directions and precisions.
"""

import numpy as np
import pytest
from stats import chi_square, sidak

from tracer.bsdf import (
    ALL,
    Conductor,
    Dielectric,
    Diffuse,
    Plastic,
    RoughConductor,
    RoughDielectric,
    RoughPlastic,
    ThinDielectric,
    TwoSided,
)
from tracer.bsdf.table import BsdfTable
from tracer.events import LOBES

# The loops keep NumPy's warnings quiet too: infinities and NaN are looked for where they matter.
pytestmark = pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")

DTYPES = (np.float32, np.float64)


def column(*values):
    return np.array(values, np.float64).reshape(3, 1)


def rough(alpha_u, alpha_v):
    return np.array([alpha_u]), np.array([alpha_v])


GOLD = column(0.2, 0.92, 1.1), column(3.9, 2.45, 2.14)
EXAMPLES = {
    Diffuse: [
        Diffuse(column(0.9, 0.5, 0.1)),
        Diffuse(column(0.9, 0.5, 0.1), hemisphere="uniform"),
    ],
    Conductor: [
        Conductor(column(0.2, 0.92, 1.1), column(3.9, 2.45, 2.14), column(1, 1, 1)),
        Conductor(column(1, 1, 1), column(np.inf, np.inf, np.inf), column(1, 0.8, 0.5)),
    ],
    Dielectric: [
        Dielectric(np.array([1.5]), column(1, 1, 1), column(1, 1, 1)),
        Dielectric(np.array([1 / 1.33]), column(1, 0.9, 0.8), column(0.7, 1, 1)),
        Dielectric(np.array([1.0]), column(1, 1, 1), column(1, 1, 1)),
        Dielectric(np.array([1.5]), column(1, 1, 1), column(1, 1, 1), "schlick"),
    ],
    RoughConductor: [
        RoughConductor(*rough(0.3, 0.3), *GOLD, column(1, 1, 1)),
        RoughConductor(*rough(0.4, 0.15), *GOLD, column(1, 1, 1), "beckmann"),
        RoughConductor(*rough(0.2, 0.7), *GOLD, column(1, 0.8, 0.5), "ggx", "schlick"),
    ],
    RoughDielectric: [
        RoughDielectric(*rough(0.5, 0.5), np.array([1.5]), column(1, 1, 1), column(1, 1, 1)),
        RoughDielectric(
            *rough(0.3, 0.6), np.array([1.33]), column(1, 0.9, 0.8), column(0.7, 1, 1), "beckmann"
        ),
        RoughDielectric(
            *rough(0.4, 0.4), np.array([1 / 1.5]), column(1, 1, 1), column(1, 1, 1), "ggx", "schlick"
        ),
    ],
    ThinDielectric: [ThinDielectric(np.array([1.5]), column(1, 0.9, 0.8), column(0.7, 1, 1))],
    Plastic: [
        Plastic.coated(np.array([1.5]), column(0.9, 0.5, 0.1), column(1, 1, 1)),
        Plastic.coated(np.array([1.9]), column(1, 1, 1), column(1, 0.8, 0.5), True, "schlick"),
        Plastic.coated(np.array([1 / 1.3]), column(0.9, 0.5, 0.1), column(1, 1, 1)),
    ],
    RoughPlastic: [
        RoughPlastic.coated(np.array([0.3]), np.array([1.5]), column(1, 0.5, 0.1), column(1, 1, 1)),
        RoughPlastic.coated(
            np.array([0.5]), np.array([1.9]), column(1, 1, 1), column(1, 0.8, 0), True, "beckmann"
        ),
    ],
}
EXAMPLES[TwoSided] = [
    TwoSided(EXAMPLES[Diffuse][0]),
    TwoSided(EXAMPLES[Conductor][0]),
    TwoSided(EXAMPLES[RoughConductor][1]),
    TwoSided(EXAMPLES[Plastic][0]),
]
EVERY = [material for family in EXAMPLES.values() for material in family]
SMOOTH = [material for material in EVERY if not material.delta]  # with lobes that are not Dirac ones
DIRAC = [material for material in EVERY if material.delta]
TILTS = (0.0, 0.7, 1.2, 1.55)  # angles of wo from the normal

COLUMNS, ROWS = 16, 10  # of the grid: longitude, and cosine over the whole sphere
N = 60_000
CHI_TESTS = len(SMOOTH) * len(TILTS) * len(DTYPES)


def over(materials):
    """A test of each of these materials."""
    names = [f"{type(m).__name__}{k}" for k, m in enumerate(materials)]
    return pytest.mark.parametrize("material", materials, ids=names)


every, smooth, dirac = over(EVERY), over(SMOOTH), over(DIRAC)
both = pytest.mark.parametrize("dtype", DTYPES)


def tilted(tilt, n, dtype=np.float64):
    """n copies of the direction at an angle from the normal."""
    w = np.array([np.sin(tilt) * 0.6, np.sin(tilt) * -0.8, np.cos(tilt)])
    return np.repeat((w / np.linalg.norm(w)).astype(dtype)[:, None], n, axis=1)


def numbers(seed, n, dtype):
    """(3, n) uniform numbers below 1 in the precision asked for."""
    bits = 24 if dtype == np.float32 else 32
    return (np.random.default_rng(seed).integers(0, 2**bits, (3, n)) * 2.0**-bits).astype(dtype)


def directions(seed, n, dtype=np.float64):
    """(3, n) directions all over the sphere."""
    w = np.random.default_rng(seed).normal(size=(3, n))
    return (w / np.linalg.norm(w, axis=0)).astype(dtype)


def grid_of(wi, wo):
    """How many directions fall into each cell. The grid is made of signed roots, of the height and of the
    longitude from the mirror direction's, so that cells are narrow where grazing lobes are."""
    turn = np.arctan2(-wo[1, 0], -wo[0, 0])
    longitude = np.remainder(np.arctan2(wi[1], wi[0]) - turn + np.pi, 2 * np.pi) / np.pi - 1.0
    spread = [0.5 * np.copysign(np.sqrt(np.abs(x)), x) + 0.5 for x in (longitude, wi[2])]
    return np.histogram2d(*spread, (COLUMNS, ROWS), ((0, 1), (0, 1)))[0]


def cell_shares(pdf, wo):
    """What a density puts into each cell, by Gauss-Legendre with 24 x 48 points a cell."""
    (phi, w_phi), (height, w_height) = in_cells(COLUMNS, 24), in_cells(ROWS, 48)
    (phi, w_phi), (z, w_z) = _square(phi, w_phi), _square(height, w_height)
    phi, z = np.meshgrid(np.arctan2(-wo[1, 0], -wo[0, 0]) + np.pi * phi, z, indexing="ij")
    phi, z, r = phi.ravel(), z.ravel(), np.sqrt(1 - z.ravel() ** 2)
    density = pdf(np.stack((r * np.cos(phi), r * np.sin(phi), z))).reshape(w_phi.size, w_z.size)
    share = density * (np.pi * w_phi)[:, None] * w_z
    return share.reshape(COLUMNS, 24, ROWS, 48).sum(axis=(1, 3))


def _square(t, weight):
    """Nodes and weights over [0, 1] moved to x = s |s| over [-1, 1], s = 2 t - 1."""
    s = 2 * t - 1
    return s * np.abs(s), 4 * np.abs(s) * weight


def in_cells(cells, points):
    """Nodes and weights over [0, 1], `points` of them in each of `cells` equal parts."""
    x, w = np.polynomial.legendre.leggauss(points)
    return ((np.arange(cells)[:, None] + 0.5 * x + 0.5) / cells).ravel(), np.tile(0.5 * w / cells, cells)


def follows(material, pdf, wo, u):
    """p-value of sampled directions against a density, and the share of samples that carry nothing.

    A density may integrate to less than 1: the rest is samples without one (below the surface, or of a
    Dirac lobe), which are a cell of their own.
    """
    sample = material.sample(wo, u)
    n = wo.shape[1]
    shares = cell_shares(lambda wi: pdf(np.repeat(wo[:, :1], wi.shape[1], axis=1), wi), wo.astype(np.float64))
    assert shares.sum() < 1.0 + 1e-3, "the density integrates to more than 1"
    has = (sample.pdf > 0) & ~sample.delta
    counts = np.append(
        grid_of(sample.wi[:, has].astype(np.float64), wo.astype(np.float64)), n - np.count_nonzero(has)
    )
    rest = 1.0 - shares.sum()
    if rest < 1e-3 and counts[-1] == 0:  # nothing is lost: what is missing is the integral's error
        counts, rest, shares = counts[:-1], None, shares / shares.sum()
    return chi_square(counts, n * (shares.ravel() if rest is None else np.append(shares, rest)))


def test_every_bsdf_has_an_example_here():
    assert set(EXAMPLES) == set(ALL)


@pytest.mark.slow
@pytest.mark.statistical
@both
@pytest.mark.parametrize("tilt", TILTS)
@smooth
def test_sample_follows_pdf(suite_seed, material, tilt, dtype):
    wo, u = tilted(tilt, N, dtype), numbers(suite_seed, N, dtype)
    material = material.astype(dtype)
    assert follows(material, material.pdf, wo, u) > sidak(CHI_TESTS)


@pytest.mark.statistical
def test_a_wrong_density_is_caught(suite_seed):
    """The broken twin: cosine-weighted directions against a density that is 5 % uniform."""
    material = SMOOTH[0]
    wo, u = tilted(0.7, N), numbers(suite_seed, N, np.float64)

    def flatter(wo, wi):
        return 0.95 * material.pdf(wo, wi) + 0.05 * (wi[2] > 0) / (2 * np.pi)

    assert follows(material, flatter, wo, u) < sidak(CHI_TESTS)


@both
@smooth
def test_sample_reports_its_own_eval_and_pdf(suite_seed, material, dtype):
    wo = np.concatenate([tilted(t, 1000, dtype) for t in TILTS], axis=1)
    material = material.astype(dtype)
    sample = material.sample(wo, numbers(suite_seed, wo.shape[1], dtype))
    has = (sample.pdf > 0) & ~sample.delta
    assert has.any()
    assert np.array_equal(sample.f[:, has], material.eval(wo, sample.wi)[:, has])
    assert np.array_equal(sample.pdf[has], material.pdf(wo, sample.wi)[has])
    assert not sample.f[:, ~has & ~sample.delta].any()
    assert np.abs(np.sqrt((sample.wi**2).sum(axis=0)) - 1).max() < 4 * np.finfo(dtype).eps


@dirac
def test_a_dirac_lobe_has_no_value_elsewhere(suite_seed, material):
    wo, wi = directions(suite_seed, 1000), directions(suite_seed + 1, 1000)
    assert not material.eval(wo, wi).any()
    assert not material.pdf(wo, wi).any()
    assert material.sample(wo, numbers(suite_seed, 1000, np.float64)).delta.all()


@smooth
def test_reciprocity(suite_seed, material):
    wo, wi = directions(suite_seed, 1000), directions(suite_seed + 1, 1000)
    there, back = material.eval(wo, wi), material.eval(wi, wo)
    if hasattr(
        material, "relative_eta"
    ):  # radiance over the square of its index is reciprocal (Veach 1997, 5.2)
        there = there * np.where(wo[2] * wi[2] < 0, material.relative_eta(wo[2]) ** 2, 1.0)
    assert np.allclose(there, back, rtol=1e-12, atol=1e-14)  # 1 - F has no digits where F nears 1


@both
@every
def test_everything_is_of_one_precision_finite_and_not_negative(suite_seed, material, dtype):
    wo, wi = directions(suite_seed, 4000, dtype), directions(suite_seed + 1, 4000, dtype)
    material = material.astype(dtype)
    sample = material.sample(wo, numbers(suite_seed, 4000, dtype))
    for values in (material.eval(wo, wi), material.pdf(wo, wi), sample.f, sample.pdf):
        assert values.dtype == dtype
        assert np.isfinite(values).all() and (values >= 0).all()
    assert sample.wi.dtype == dtype
    assert ((sample.lobe >= 0) & (sample.lobe < len(LOBES))).all()


@every
def test_nothing_passes_an_opaque_surface(suite_seed, material):
    wo, wi = directions(suite_seed, 4000), directions(suite_seed + 1, 4000)
    if not material.one_sided:
        return
    below = (wo[2] <= 0) | (wi[2] <= 0)
    assert not material.eval(wo, wi)[:, below].any()
    assert not material.pdf(wo, wi)[below].any()
    sample = material.sample(wo, numbers(suite_seed, 4000, np.float64))
    carries = (sample.pdf > 0) & (sample.f > 0).any(axis=0)
    assert (sample.wi[2][carries] > 0).all() and (wo[2][carries] > 0).all()


def energy(material, wo, u):
    """Share of the light that goes on, per sample: f cos / pdf, without the change of radiance in glass."""
    sample = material.sample(wo, u)
    weight = np.where(sample.delta, 1.0, np.abs(sample.wi[2])) / np.where(sample.pdf > 0, sample.pdf, np.inf)
    compression = np.ones(wo.shape[1])
    if hasattr(material, "relative_eta"):
        passed = sample.wi[2] * wo[2] < 0
        compression = np.where(passed, material.relative_eta(wo[2]) ** 2, 1.0)
    return sample.f * weight * compression


@pytest.mark.parametrize("tilt", [*TILTS, np.pi - 0.7, np.pi - 1.2])
@every
def test_no_energy_is_created(suite_seed, material, tilt):
    """Importance sampling leaves hardly any variance, so each weight itself stays below 1, or their mean."""
    weights = energy(material, tilted(tilt, 20_000), numbers(suite_seed, 20_000, np.float64))
    mean, error = weights.mean(axis=1), weights.std(axis=1) / np.sqrt(20_000)
    assert (mean <= 1.0 + 4.0 * error + 1e-12).all()


def test_an_albedo_a_percent_above_one_is_caught(suite_seed):
    """The broken twin."""
    weights = energy(Diffuse(column(1.01, 1, 1)), tilted(0.7, 1000), numbers(suite_seed, 1000, np.float64))
    assert weights.mean(axis=1)[0] > 1.0 + 1e-12


@both
def test_a_table_answers_each_lane_by_its_own_material(suite_seed, dtype):
    n = 500
    which = np.random.default_rng(suite_seed).integers(0, len(EVERY), n)
    table = BsdfTable(EVERY, dtype, "cosine")
    wo, wi = directions(suite_seed, n, dtype), directions(suite_seed + 1, n, dtype)
    u = numbers(suite_seed, n, dtype)
    f, pdf, sample = table.eval(which, wo, wi), table.pdf(which, wo, wi), table.sample(which, wo, u)
    for number, material in enumerate(EVERY):
        lanes = np.flatnonzero(which == number)
        own = material.sampling("cosine").astype(dtype)
        assert np.array_equal(f[:, lanes], own.eval(wo[:, lanes], wi[:, lanes]))
        assert np.array_equal(pdf[lanes], own.pdf(wo[:, lanes], wi[:, lanes]))
        for got, want in zip(sample, own.sample(wo[:, lanes], u[:, lanes]), strict=True):
            assert np.array_equal(got[..., lanes], want)
