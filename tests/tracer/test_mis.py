"""The weights of two techniques for one direction: their formulas, their sum, and where only one has it."""

import numpy as np
import pytest

from lessons import zoo
from tracer import Settings
from tracer.integrator.steps import emission_weight, light_weight

HEURISTICS = ("balance", "power")


def densities(seed, n=1000):
    """Two densities (n,) each over twelve orders of magnitude."""
    return 10.0 ** np.random.default_rng(seed).uniform(-6.0, 6.0, (2, n))


@pytest.mark.parametrize(("heuristic", "power"), [("balance", 1), ("power", 2)])
def test_each_heuristic_is_its_formula(suite_seed, heuristic, power):
    by_light, by_bounce = densities(suite_seed)
    found = emission_weight(Settings(heuristic=heuristic), "mis", by_bounce, by_light)
    assert np.allclose(found, by_bounce**power / (by_light**power + by_bounce**power), rtol=1e-12)


@pytest.mark.parametrize("heuristic", HEURISTICS)
def test_the_weights_of_one_direction_sum_to_1(suite_seed, heuristic):
    assert np.allclose(sums(suite_seed, heuristic, zoo.RIGHT), 1.0, rtol=1e-12)


def test_weights_of_another_sampler_do_not(suite_seed):
    assert not np.allclose(sums(suite_seed, "power", zoo.steps("M01")), 1.0, atol=0.1)


def sums(seed, heuristic, steps):
    (by_light, by_bounce), settings = densities(seed), Settings(heuristic=heuristic)
    return steps.light_weight(settings, "mis", by_light, by_bounce) + steps.emission_weight(
        settings, "mis", by_bounce, by_light
    )


@pytest.mark.parametrize("heuristic", HEURISTICS)
def test_what_only_one_technique_can_find_counts_in_full(heuristic):
    settings, one, none = Settings(heuristic=heuristic), np.full(1, 3.0), np.zeros(1)
    assert emission_weight(settings, "mis", np.full(1, np.inf), one) == 1.0  # camera, mirror
    assert emission_weight(settings, "mis", one, none) == 1.0
    assert light_weight(settings, "mis", one, none) == 1.0
    with np.errstate(all="ignore"):
        assert light_weight(settings, "mis", none, one) == 0.0
