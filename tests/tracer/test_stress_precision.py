"""Stress case S63: single against double precision; what is compared stands in precisions.py."""

import numpy as np
import pytest
from cases import INTEGRATORS, loaded, slow_but
from precisions import SIDE, SPP, compared

import tracer
from lessons import zoo
from tracer import Settings

pytestmark = pytest.mark.filterwarnings("error")


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("name", slow_but(tracer.built_in_scenes(), "cornell_unit"))
def test_s63_both_precisions_walk_the_same_paths(suite_seed, name, integrator):
    if integrator == "walk" and loaded(name).unmeetable:
        return  # refused, with lamps that no ray meets
    settings = Settings(width=SIDE, height=SIDE, spp=SPP, seed=suite_seed, integrator=integrator)
    same, difference = compared(loaded(name), settings)
    assert same > 0.999 and difference < 1e-5


def coarse(scene, hit, wi):
    """Rays that start where half precision would put them."""
    return hit.p.astype(np.float16).astype(hit.p.dtype) if hit.p.dtype == np.float32 else hit.p, wi


def test_s63_a_precision_that_is_not_enough_is_seen(suite_seed):
    """The broken twin."""
    settings = Settings(width=SIDE, height=SIDE, spp=SPP, seed=suite_seed, max_depth=4)
    same, difference = compared(loaded("cornell_unit"), settings, zoo.changed(next_ray=coarse))
    assert not (same > 0.999 and difference < 1e-5)
