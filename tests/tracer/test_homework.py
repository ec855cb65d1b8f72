"""The homework's Cornell box against region means from the homework's own framework, mended.

Every sample goes through its pixel's centre there, so the grid decides what a region's edge cuts off. The
regions are compared at the homework's 784 x 784 pixels, where that is nothing, and at the 196 x 196 that the
means were taken from. The mean of the whole picture is compared at 196 x 196 only: the lamp is 6.7 rows high
there and 6 rows have their centres on it, which is a tenth of the light in the picture. Allowed are 1 %, for
the reference's own noise, and 4 standard errors of ours.
"""

from functools import partial

import checks
import pytest

from lessons import zoo
from tracer import Settings

pytestmark = pytest.mark.statistical

REGIONS = [name for name in checks.HOMEWORK if name != "picture"]


def as_in_the_homework(suite_seed, side, spp):
    return Settings(
        width=side, height=side, spp=spp, seed=suite_seed, integrator="direct", max_depth=-1, jitter=False
    )


@pytest.mark.parametrize(("side", "spp"), [(784, 4), (196, 16)])
@pytest.mark.parametrize("name", REGIONS)
def test_a_region_has_the_homeworks_brightness(suite_seed, name, side, spp):
    distance, mean, error = checks.homework(name, as_in_the_homework(suite_seed, side, spp), pixels=2500)
    print(f"{name}: {mean}, relative standard error {error / mean}")
    assert distance <= 1.0, f"{mean} +- {error} is not {checks.HOMEWORK[name][1]}"


@pytest.mark.slow
def test_the_whole_picture_has_the_homeworks_brightness(suite_seed):
    distance, mean, error = checks.homework("picture", as_in_the_homework(suite_seed, 196, 16))
    print(f"picture: {mean}, relative standard error {error / mean}")
    assert distance <= 1.0, f"{mean} +- {error} is not {checks.HOMEWORK['picture'][1]}"


def brighter(share, beta, f, cos, light, w):
    """Every light sample counts a little more."""
    return beta.dtype.type(1.0 + share) * zoo.RIGHT.light_term(beta, f, cos, light, w)


def test_light_samples_six_percent_too_strong_are_caught(suite_seed):
    """The broken twin."""
    wrong = zoo.changed(light_term=partial(brighter, 0.06))
    settings = as_in_the_homework(suite_seed, 784, 4)
    assert max(checks.homework(name, settings, wrong, 2500)[0] for name in REGIONS) > 1.0
