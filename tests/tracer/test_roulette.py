"""Russian roulette keeps the mean and pays with the second moment, in one step and in the furnace."""

import numpy as np
import pytest

from lessons import zoo
from lessons.course.l15_roulette.claim import known_variance
from tracer import load, render
from tracer.integrator.steps import roulette
from tracer.settings import Settings

RHO = 0.5  # albedo of the furnace's walls, which shine with radiance 1
SPP = 64


def played(step, probability):
    """Weights (n,) after one roulette, 0 of those that are over, for even numbers u."""
    u = (np.arange(10_000) + 0.5) / 10_000
    survived, beta = step(np.full((3, u.size), 2.0), np.full(u.size, probability), u)
    return beta[0] * survived


@pytest.mark.parametrize("probability", [0.2, 0.5, 0.8, 1.0])
def test_the_mean_stays_and_the_second_moment_grows_by_one_over_the_probability(probability):
    after = played(roulette, probability)
    assert after.mean() == pytest.approx(2.0, rel=1e-9)
    assert (after**2).mean() == pytest.approx(4.0 / probability, rel=1e-9)


@pytest.mark.parametrize("bug", ["R01", "R03"])
def test_a_roulette_that_is_not_paid_for_is_caught(bug):
    assert played(zoo.steps(bug).roulette, 0.8).mean() != pytest.approx(2.0, rel=0.1)


def measured(suite_seed, **options):
    """Variance of single samples of the furnace, from the variances of its pixels."""
    settings = Settings(
        integrator="walk", width=16, height=16, spp=SPP, seed=suite_seed, roulette="0.8", **options
    )
    picture = render(load("furnace"), settings, steps=zoo.planted(settings))
    return picture.variance[..., 1].mean(dtype=float) * SPP


@pytest.mark.statistical
def test_the_furnace_has_the_variance_known(suite_seed):
    """Within 8 %: five standard errors of the variance of 16384 samples."""
    assert measured(suite_seed) == pytest.approx(known_variance(RHO, 0.8), rel=0.08)


@pytest.mark.statistical
def test_survivors_without_their_weight_have_another_variance(suite_seed):
    assert measured(suite_seed, bug="R01") != pytest.approx(known_variance(RHO, 0.8), rel=0.08)
