"""The homework's Cornell box against region means from the homework's own framework, mended.

Every sample goes through its pixel's centre there, so the grid decides what a region's edge cuts off. The
regions are compared at the homework's 784 x 784 pixels, where that is nothing, and at the 196 x 196 that the
means were taken from. The mean of the whole picture is compared at 196 x 196 only: the lamp is 6.7 rows high
there and 6 rows have their centres on it, which is a tenth of the light in the picture. Allowed are 1 %, for
the reference's own noise, and 4 standard errors of ours.

The homework's means are not exact themselves: against two other tracers, Mitsuba 3 and this one, which agree
within their noise, they are off by 1 to 2 % on the side walls and the floor and by 4 % on the ceiling. So the
comparison with them is kept coarse, and a finer one is made with Mitsuba's means of the same scene.
"""

from functools import partial

import checks
import numpy as np
import pytest
from cases import loaded
from stats import mean_and_error

from lessons import zoo
from tracer import Settings

pytestmark = pytest.mark.statistical

REGIONS = [name for name in checks.HOMEWORK if name != "picture"]


def as_in_the_homework(suite_seed, side, spp):
    """Its light samples are uniform on the lamp's area, its camera rays go through the pixels' centres."""
    return Settings(
        width=side,
        height=side,
        spp=spp,
        seed=suite_seed,
        integrator="direct",
        light_sampling="area",
        max_depth=-1,
        jitter=False,
    )


@pytest.mark.parametrize(("side", "spp"), [(784, 4), (196, 6)])
@pytest.mark.parametrize("name", REGIONS)
def test_a_region_has_the_homeworks_brightness(suite_seed, name, side, spp):
    distance, mean, error = checks.homework(name, as_in_the_homework(suite_seed, side, spp), pixels=800)
    print(f"{name}: {mean}, relative standard error {error / mean}")
    assert distance <= 1.0, f"{mean} +- {error} is not {checks.HOMEWORK[name][1]}"


@pytest.mark.slow
def test_the_whole_picture_has_the_homeworks_brightness(suite_seed):
    distance, mean, error = checks.homework("picture", as_in_the_homework(suite_seed, 196, 16))
    print(f"picture: {mean}, relative standard error {error / mean}")
    assert distance <= 1.0, f"{mean} +- {error} is not {checks.HOMEWORK['picture'][1]}"


@pytest.mark.slow
@pytest.mark.parametrize("integrator", ["direct", "path"])
@pytest.mark.parametrize("name", checks.MITSUBA)
def test_a_region_has_the_brightness_that_mitsuba_gives_it(suite_seed, name, integrator):
    """Both used 64 samples a pixel of the same kind, so Mitsuba's standard error is taken to be ours."""
    settings = Settings(width=196, height=196, spp=64, seed=suite_seed, integrator=integrator)
    pixels = checks.region(name, 196, 196)
    mean, error = mean_and_error(checks.samples(loaded("cornell"), settings, pixels=pixels))
    print(f"{name}: {mean}, relative standard error {error / mean}")
    assert (error < 0.015 * mean).all()
    assert checks.off(mean, checks.MITSUBA[name], np.sqrt(2.0) * error) <= 1.0


def brighter(share, beta, f, cos, light, w):
    """Every light sample counts a little more."""
    return beta.dtype.type(1.0 + share) * zoo.RIGHT.light_term(beta, f, cos, light, w)


def test_light_samples_ten_percent_too_strong_are_caught(suite_seed):
    """The broken twin."""
    wrong = zoo.changed(light_term=partial(brighter, 0.1))
    settings = as_in_the_homework(suite_seed, 784, 4)
    assert max(checks.homework(name, settings, wrong, 800)[0] for name in REGIONS) > 1.0
