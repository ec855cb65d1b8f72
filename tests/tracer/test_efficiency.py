"""Error against run time: it is the error against the truth, whatever the reference's own."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from cases import loaded

import tracer
from tracer import Settings
from tracer.testing import efficiency
from tracer.testing.efficiency import Estimator, Reference, Run
from tracer.testing.machine import kernel_seconds, machine, peak_bytes

TRUTH = np.linspace(0.1, 2.0, 32 * 32 * 3).reshape(32, 32, 3)
ONE = Estimator("path", "mis", "independent", 32)
SMALL = Settings(width=8, height=6, max_depth=4)


def picture(rgb, variance=None):
    return SimpleNamespace(rgb=rgb, variance=variance)


def runs(seed, exponent, bias=0.0, spps=(4, 16, 64, 256)):
    """Runs of an estimator with standard deviation N^exponent that takes a microsecond a sample."""
    random, reference = np.random.default_rng(seed), Reference.of(picture(TRUTH), "the truth")
    for k in range(5):
        for spp in spps:
            rgb = TRUTH + bias + spp**exponent * random.standard_normal(TRUTH.shape)
            mse = reference.errors(rgb)
            yield Run(ONE, spp, k, 1e-6 * spp, 1e-3, *mse, paths=1024 * spp, rays=2048 * spp, dropped=0)


@pytest.mark.statistical
@pytest.mark.parametrize("exponent", [-0.5, -0.75, -1.0])
def test_the_slope_is_that_of_the_estimator(suite_seed, exponent):
    points = efficiency.curve(list(runs(suite_seed, exponent)))
    # An RMSE of 3072 numbers is known to 1 / sqrt(2 * 3072) = 1.3 %, over a factor of 64 in N: 0.004.
    assert abs(efficiency.slope(points) - exponent) < 0.02
    assert [p.spp for p in points] == [4, 16, 64, 256]


@pytest.mark.statistical
def test_a_bias_shows_as_a_slope_that_ends(suite_seed):
    """The broken twin: an estimator that is wrong does not go on falling."""
    points = efficiency.curve(list(runs(suite_seed, -0.5, bias=0.2)))
    assert efficiency.slope(points) > -0.35


@pytest.mark.statistical
def test_efficiency_is_the_same_for_any_number_of_independent_samples(suite_seed):
    points = efficiency.curve(list(runs(suite_seed, -0.5)))
    assert np.ptp([p.efficiency for p in points]) < 0.1 * points[0].efficiency
    assert points[0].efficiency == pytest.approx(1e6, rel=0.1)  # 1 / (1e-6 N / N)


def test_a_point_has_median_smallest_and_largest():
    values = [Run(ONE, 4, k, float(k), 1e-3, k * k, 2.0 * k, 100, 300, k) for k in (3, 1, 2)]
    (point,) = efficiency.curve(values)
    assert point.seconds == (2, 1, 3) and point.mse == (4, 1, 9) and point.rel_mse == (4, 2, 6)
    assert point.rmse == (2, 1, 3) and point.efficiency == 1 / 8 and point.dropped == 6
    assert point.paths_per_second == 50 and point.rays_per_second == 150


def test_what_is_below_the_reference_is_no_number_and_no_slope():
    point = efficiency.curve([Run(ONE, 4, 0, 1.0, 1e-3, -1e-9, 0.0, 100, 300, 0)])[0]
    assert math.isnan(point.rmse[0]) and math.isnan(point.efficiency)
    assert math.isnan(efficiency.slope([point, point]))


@pytest.mark.statistical
def test_the_references_own_error_is_taken_off(suite_seed):
    """A reference as noisy as what it judges: with its variance the error is right, without it twice that."""
    random, scatter = np.random.default_rng(suite_seed), 0.01
    noisy = TRUTH + scatter * random.standard_normal(TRUTH.shape)
    rgb = TRUTH + scatter * random.standard_normal(TRUTH.shape)
    of_noisy = Reference.of(picture(noisy, np.full(TRUTH.shape, scatter**2)), "noisy").errors(rgb)
    of_truth = Reference.of(picture(TRUTH), "exact").errors(rgb)
    # (v - r)^2 has variance 2 (2 scatter^2)^2: over 3072 numbers 4 standard errors are 0.2 of scatter^2.
    assert of_noisy[0] == pytest.approx(scatter**2, rel=0.2)
    assert of_truth[0] == pytest.approx(scatter**2, rel=0.11)
    assert of_noisy[1] == pytest.approx(of_truth[1], rel=0.5)  # few dark pixels decide
    twice, _ = Reference.of(picture(noisy), "noisy").errors(rgb)
    assert twice == pytest.approx(2 * scatter**2, rel=0.2)


def test_a_variance_that_is_not_known_everywhere_is_not_known():
    variance = np.full(TRUTH.shape, 0.1)
    assert Reference.of(picture(TRUTH, variance), "").mse == pytest.approx(0.1)
    variance[0, 0] = np.nan
    assert Reference.of(picture(TRUTH, variance), "").variance is None
    with pytest.raises(tracer.TracerError, match="not finite"):
        Reference.of(picture(np.where(variance > 0, TRUTH, np.nan)), "holes.npy")


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ((), ["path-mis", "path-light", "path-bsdf", "direct", "walk"]),
        ((("walk",),), ["walk"]),
        (((), ("bsdf",)), ["path-bsdf"]),
        ((("walk", "path"), ("mis", "light")), ["walk", "path-mis", "path-light"]),
        ((("walk", "walk"), (), ("independent",), (32, 64)), ["walk", "walk"]),
    ],
)
def test_the_estimators_asked_for(words, names):
    assert [one.name for one in efficiency.estimators(*words)] == names


@pytest.mark.parametrize(
    "words", [(("guess",),), ((), ("guess",)), ((), (), ("guess",)), ((), (), (), (16,))]
)
def test_an_estimator_that_is_not_known(words):
    with pytest.raises(tracer.TracerError, match="choose one of"):
        efficiency.estimators(*words)


def test_seeds_and_estimators_take_turns():
    """So that what disturbs the machine disturbs all alike."""
    scene, asked = loaded("cornell_unit"), efficiency.estimators(("path",), ("mis", "bsdf"))
    reference = Reference.of(efficiency.long_render(scene, SMALL, 16), "made here")
    found = list(efficiency.measure(scene, asked, SMALL, (1, 2), range(1, 3), reference))
    order = [(run.seed, run.spp, run.estimator.strategy) for run in found]
    assert order == [(k, n, s) for k in (1, 2) for n in (1, 2) for s in ("mis", "bsdf")]
    assert all(run.seconds > 0 and run.kernel > 0 and run.paths == 48 * run.spp for run in found)


def test_the_reference_has_no_bug_and_says_how_sure_it_is():
    scene, asked = loaded("cornell_unit"), Settings(width=8, height=6, max_depth=4, bug="E01")
    long = efficiency.long_render(scene, asked, 16)
    assert long.settings.bug is None and long.settings.spp == 16
    reference = Reference.of(long, "made here")
    assert reference.mse == pytest.approx(float(long.variance.mean(dtype=np.float64)))


def test_memory_grows_with_the_picture_and_not_with_more_blocks_of_samples():
    scene = loaded("cornell_unit")
    small, more = (efficiency.memory(scene, ONE, SMALL, spp) for spp in (16, 64))
    large = efficiency.memory(scene, ONE, Settings(width=16, height=12, max_depth=4), 16)
    assert 0 < small == pytest.approx(more, rel=0.2) and large > 2 * small


def test_peak_bytes_is_the_peak():
    assert 8e6 <= peak_bytes(lambda: [np.ones(1_000_000) for _ in range(3)][:1] and None) < 30e6
    assert peak_bytes(lambda: None) < 1e5


def test_what_a_time_was_taken_on():
    assert {"processor", "cores", "system", "python", "numpy"} == machine().keys()
    assert machine()["cores"] >= 1 and kernel_seconds() > 0.0
