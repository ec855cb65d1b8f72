"""Tests over many events: their chances are chances, and each finds what it is for."""

import numpy as np
import pytest
from mutants import traced
from suite import suite_seed

from tracer.doctor import examine
from tracer.doctor.statistics import cells


@pytest.mark.statistical
@pytest.mark.parametrize("groups", [2, 60])
def test_means_of_groups_have_no_smaller_chances_than_they_should(groups):
    rng = np.random.default_rng(suite_seed())
    chances = np.array([cells.means(rng.random(500), rng.integers(0, groups, 500)) for _ in range(2000)])
    for low in (0.5, 0.1, 0.01):
        assert np.mean(chances < low) <= low


def test_one_number_for_the_group_and_for_the_place_in_it_is_seen_though_all_together_are_uniform():
    u = (np.arange(400) + 0.5) / 400
    assert cells.means(u, (u < 0.5).astype(int)) < 1e-20
    assert cells.uniform(u) > 0.5


@pytest.mark.statistical
def test_right_points_on_many_lamps_break_no_law():
    (verdict,) = [v for v in examine(traced("lamps", seed=suite_seed())).rules if v.rule.id == "lamp-points"]
    assert verdict.state == "clean" and verdict.checked > 3
