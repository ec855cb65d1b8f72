"""Smooth boundaries: Snell's law, the choice of the lobe, radiance in glass; values are in test_truth."""

import numpy as np
import pytest
from stats import chi_square, sidak
from truth import entry, keys

from tracer.bsdf import Conductor, Dielectric, fresnel
from tracer.bsdf.dielectric import LOBES
from tracer.warp import reflect

ONES = np.ones((3, 1))


@pytest.mark.parametrize("key", keys("brewster.deg."))
def test_at_brewsters_angle_nothing_is_reflected_of_one_polarisation(key):
    given, degrees = entry(key)
    _, rp, _ = fresnel.dielectric(np.cos(np.radians([degrees])), np.array([given["n"]]))
    assert rp[0] < 1e-30


def test_equal_indices_reflect_exactly_nothing():
    for dtype in (np.float32, np.float64):
        cos = np.linspace(0, 1, 100, dtype=dtype)
        rs, rp, cos_t = fresnel.dielectric(cos, np.ones(100, dtype))
        assert not rs.any() and not rp.any() and np.array_equal(cos_t, cos)


@pytest.mark.parametrize("eta", [1.5, 1 / 1.5, 1.33, 1 / 2.4, 1.0001])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_refraction_obeys_snell_on_both_sides(eta, dtype):
    theta = np.linspace(1e-3, np.pi - 1e-3, 4001)
    wo = np.stack((np.sin(theta) * 0.8, np.sin(theta) * -0.6, np.cos(theta))).astype(dtype)
    u = np.full((3, theta.size), 1.0 - 2.0**-24, dtype)  # the last number: refract wherever that can be
    sample = Dielectric(np.array([eta], dtype), ONES.astype(dtype), ONES.astype(dtype)).sample(wo, u)
    passed = sample.lobe == LOBES.index("transmission")
    relative = np.where(wo[2] > 0, eta, 1 / eta)
    sine = np.hypot(wo[0].astype(float), wo[1].astype(float))
    undecided = (np.abs(sine - relative) < 1e-3) | (np.abs(wo[2]) < 1e-3)  # critical or grazing
    assert np.array_equal(passed[~undecided], (sine < relative)[~undecided])
    sine_t = np.hypot(sample.wi[0].astype(float), sample.wi[1].astype(float))
    eps = np.finfo(dtype).eps
    assert np.abs(sine_t * relative - sine)[passed].max() < 8 * eps
    assert (sample.wi[2] * wo[2] < 0)[passed].all()
    across = sample.wi[:2] * wo[:2]
    assert (across[:, passed] <= 0).all(), "the refracted ray goes on across the normal"
    assert np.abs((sample.wi.astype(float) ** 2).sum(axis=0) - 1).max() < 16 * eps


@pytest.mark.parametrize("eta", [1.5, 2.4])
def test_beyond_the_critical_angle_everything_is_reflected(suite_seed, eta):
    sine = np.linspace(1 / eta + 1e-9, 1.0, 1000)
    wo = np.stack((sine, np.zeros(1000), -np.sqrt(np.maximum(1 - sine * sine, 1e-30))))
    u = np.random.default_rng(suite_seed).random((3, 1000))
    sample = Dielectric(np.array([eta]), ONES, ONES).sample(wo, u)
    assert (sample.lobe == LOBES.index("reflection")).all()
    assert np.array_equal(sample.wi, reflect(wo))
    assert (sample.pdf == 1).all() and (sample.f == 1).all()


@pytest.mark.parametrize("eta", [1.5, 1 / 1.5, 1.01])
def test_radiance_changes_by_the_square_of_the_index_and_back(suite_seed, eta):
    """f towards glass is (1 - F) / eta^2; the way back has the same F and the square the other way up."""
    glass = Dielectric(np.array([eta]), ONES, ONES)
    theta = np.linspace(0.01, 1.5, 500)
    wo = np.stack((np.sin(theta), np.zeros(500), np.cos(theta)))
    u = np.full((3, 500), 1.0 - 2.0**-32)
    there = glass.sample(wo, u)
    passed = np.flatnonzero(there.lobe == LOBES.index("transmission"))
    back = glass.sample(there.wi[:, passed], u[:, passed])
    F = glass.reflectance_at(wo[2])[:, passed]
    assert np.allclose(there.f[:, passed] * eta**2, 1 - F, rtol=1e-12)
    assert np.allclose(back.f / eta**2, 1 - F, rtol=1e-9)
    assert np.allclose(back.wi, wo[:, passed], atol=1e-12)


@pytest.mark.statistical
@pytest.mark.parametrize("tilt", [0.0, 0.8, 1.3, np.pi - 0.5, np.pi - 0.7])
def test_the_two_lobes_of_glass_are_chosen_with_their_probabilities(suite_seed, tilt):
    n = 100_000
    wo = np.repeat(np.array([[np.sin(tilt)], [0.0], [np.cos(tilt)]]), n, axis=1)
    glass = Dielectric(np.array([1.5]), ONES, ONES)
    sample = glass.sample(wo, np.random.default_rng(suite_seed).random((3, n)))
    mirrored = sample.lobe == LOBES.index("reflection")
    F = glass.reflectance_at(wo[2, :1])[0, 0]
    assert np.allclose(sample.pdf, np.where(mirrored, F, 1 - F), rtol=1e-12)
    assert chi_square([mirrored.sum(), n - mirrored.sum()], [n * F, n * (1 - F)]) > sidak(5)
    wrong = 1.1 * F  # the broken twin: a Fresnel reflectance 10 % too high
    assert tilt == 0.0 or chi_square(
        [mirrored.sum(), n - mirrored.sum()], [n * wrong, n * (1 - wrong)]
    ) < sidak(5)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_mirror_sends_light_where_it_should(suite_seed, dtype):
    wo = np.random.default_rng(suite_seed).normal(size=(3, 1000))
    wo[2] = np.abs(wo[2])
    wo = (wo / np.linalg.norm(wo, axis=0)).astype(dtype)
    for eta, k in ((1.0, np.inf), (0.2, 3.9)):
        metal = Conductor(np.full((3, 1), eta, dtype), np.full((3, 1), k, dtype), ONES.astype(dtype))
        sample = metal.sample(wo, np.zeros((3, 1000), dtype))
        assert np.array_equal(sample.wi, np.stack((-wo[0], -wo[1], wo[2])))
        assert (sample.pdf == 1).all()
        assert k != np.inf or (sample.f == 1).all()
