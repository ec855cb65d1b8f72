"""Every BSDF keeps the same promises; adding one to bsdf.ALL tests it.

That its samples follow their density is in test_densities.
"""

import numpy as np
import pytest
from examples import DIRAC, EVERY, EXAMPLES, SMOOTH, column, names

from tracer.bsdf import ALL, Diffuse
from tracer.bsdf.table import BsdfTable
from tracer.events import LOBES

# The loops keep NumPy's warnings quiet too: infinities and NaN are looked for where they matter.
pytestmark = pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")

DTYPES = (np.float32, np.float64)


TILTS = (0.0, 0.7, 1.2, 1.55)  # angles of wo from the normal


def over(materials):
    """A test of each of these materials."""
    return pytest.mark.parametrize("material", materials, ids=names(materials))


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


def test_every_bsdf_has_an_example_here():
    assert set(EXAMPLES) == set(ALL)


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


@both
@every
def test_the_least_and_the_largest_random_numbers_give_finite_samples(material, dtype):
    """One sample in 2^24 at a rough surface seen from straight above was not."""
    ends = np.array([0.0, 0.5, 1.0 - 2.0 ** -(24 if dtype == np.float32 else 32)], dtype)
    u = np.stack(np.meshgrid(ends, ends, ends)).reshape(3, -1)
    for z in (1.0, 0.6, 1e-3, 1e-8, -0.5, -1.0):
        wo = np.repeat(np.array([[np.sqrt(1.0 - z * z)], [0.0], [z]], dtype), u.shape[1], axis=1)
        with np.errstate(all="ignore"):  # as in the loops
            sample = material.astype(dtype).sample(wo, u)
        assert np.isfinite(sample.wi).all() and np.isfinite(sample.f).all() and np.isfinite(sample.pdf).all()


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
