"""The z-test of pictures: as many false alarms as it says, and the smallest bias it claims to see is seen."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from cases import loaded, slow_but
from scipy import stats

import tracer
from lessons import zoo
from tracer import Settings, TracerError, film, tails
from tracer.testing import assert_same_picture, calibration, compare, z_test

pytestmark = pytest.mark.statistical

TOO_RARE = 1e-4  # a count of false alarms is wrong if chance gives one as large less often than this


def picture(samples):
    """A picture from samples (H, W, 3, n), folded as the film does it."""
    height, width, _, n = samples.shape
    sheet, flat = film.Film(height * width), samples.reshape(-1, 3, n).transpose(1, 0, 2)
    for start in range(0, n, film.BLOCK):
        sheet.add(slice(None), film.block(flat[:, :, start : start + film.BLOCK]))
    rgb, variance = (a.T.reshape(height, width, 3) for a in (sheet.mean(), sheet.variance()))
    return SimpleNamespace(rgb=rgb, variance=variance, samples=sheet.samples.reshape(height, width))


def drawn(rng, n, side=16, skew=1.0):
    """Noise as paths bring it: each pixel has its own level; larger skew means rarer and brighter paths."""
    shape = 1.0 / skew**2
    level = 1.0 + np.sin(np.arange(side))[:, None] ** 2 * np.ones((side, side))
    return picture(level[..., None, None] * rng.gamma(shape, 1.0 / shape, (side, side, 3, n)))


def noisy(rng, n, side=16, mean=1.0, sigma=0.5):
    return picture(rng.normal(mean, sigma, (side, side, 3, n)))


@cache
def rendered(seed, spp=16, side=24, **options):
    return tracer.render(
        loaded("cornell_unit"), Settings(width=side, height=side, spp=spp, seed=seed, **options)
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("n", "m", "skew"), [(16, 16, 0.5), (16, 16, 3.0), (2, 3, 1.0), (8, 128, 2.0), (64, 16, 4.0)]
)
def test_false_alarms_are_as_rare_as_they_are_said_to_be(suite_seed, n, m, skew):
    """At 5 %: the bias Z inside its binomial band on both sides, the pixels and all together not above it."""
    runs, alpha = 300, 0.05
    rng = np.random.default_rng(suite_seed)
    found = [z_test(drawn(rng, n, skew=skew), drawn(rng, m, skew=skew)) for _ in range(runs)]
    low, high = stats.binom.ppf([TOO_RARE, 1.0 - TOO_RARE], runs, alpha)
    assert low <= sum(c.p_bias < alpha for c in found) <= high
    assert sum(c.p_pixel < alpha for c in found) <= high
    assert sum(c.p_value < alpha for c in found) <= high


@pytest.mark.slow
@pytest.mark.parametrize(
    ("one", "other"),
    [
        ({"spp": 16}, {"spp": 16}),
        ({"spp": 4}, {"spp": 64}),
        ({"spp": 16, "integrator": "walk"}, {"spp": 16}),
        ({"spp": 16, "integrator": "direct"}, {"spp": 16}),
    ],
)
def test_false_alarms_of_renders(suite_seed, one, other):
    runs, alpha = 60, 0.05
    found = [
        z_test(rendered(suite_seed + 2 * k, **one), rendered(suite_seed + 2 * k + 1, **other))
        for k in range(runs)
    ]
    high = stats.binom.ppf(1.0 - TOO_RARE, runs, alpha)
    for kind in ("p_bias", "p_pixel", "p_value"):
        assert sum(getattr(c, kind) < alpha for c in found) <= high, kind


def test_the_plain_sum_of_z_would_cry_wolf(suite_seed):
    """The broken twin: weights from a pixel's own error, where noise is skewed and samples are few."""
    rng = np.random.default_rng(suite_seed)
    found = z_test(drawn(rng, 16, 32, skew=4.0), drawn(rng, 256, 32, skew=4.0))
    assert np.abs(found.shape["sum_z"]).min() > 6.0
    assert np.abs(found.Z).max() < 4.0 and found.same


def test_z_is_distributed_as_it_should_be(suite_seed):
    rng = np.random.default_rng(suite_seed)
    shape = z_test(noisy(rng, 32, 64), noisy(rng, 32, 64)).shape
    least = tails.shared(1e-3, 6)
    assert least < min(*shape["chi2_p"], *shape["ks_p"]) and max(shape["chi2_p"]) <= 1.0
    a, b = noisy(rng, 32, 64), noisy(rng, 32, 64)
    a.variance *= 0.8  # the broken twin: error bars too short, and too long
    b.variance *= 0.8
    assert max(z_test(a, b).shape["chi2_p"]) < least
    a.variance *= 1.5
    b.variance *= 1.5
    assert max(z_test(a, b).shape["chi2_p"]) < least


def test_the_smallest_bias_of_one_pixel_is_seen(suite_seed):
    """4 standard errors above what all pixels together may show; the same in no pixel is not seen."""
    rng = np.random.default_rng(suite_seed)
    a, b = noisy(rng, 64, 32), noisy(rng, 64, 32)
    limit = tails.normal_z(tails.shared(tails.shared(0.01, 3), 32 * 32 * 3))
    assert z_test(a, b).p_pixel > 0.01
    a.rgb[20, 7, 1] = b.rgb[20, 7, 1] + np.float32((limit + 4.0) * 0.5 * np.sqrt(2 / 64))
    found = z_test(a, b)
    assert not found.same and found.worst == (7, 20, 1) and found.p_pixel < 0.01


def test_the_bias_of_a_whole_picture_is_seen_long_before_that_of_a_pixel(suite_seed):
    """A uniform bias of 7 standard errors of the mean, at 64 x 64 pixels a tenth of one pixel's."""
    rng, side = np.random.default_rng(suite_seed), 64
    a, b = noisy(rng, 64, side), noisy(rng, 64, side)
    assert z_test(a, b).same
    error = 0.5 * np.sqrt(2 / 64)
    found = z_test(SimpleNamespace(**{**vars(a), "rgb": a.rgb + np.float32(7.0 * error / side)}), b)
    assert not found.same and found.p_bias < 0.01 < found.p_pixel
    assert (np.abs(found.bias - 7.0 * error / side) < found.bound * 4 / 3).all()
    per_pixel = tails.normal_z(tails.shared(tails.shared(0.01, 3), side * side * 3))
    whole = tails.normal_z(tails.shared(tails.shared(0.01, 3), 3))
    assert per_pixel / (whole / side) > 1.3 * side


SEEN = [("E01", {}), ("F01", {"integrator": "direct"})]


@pytest.mark.parametrize(("bug", "options"), slow_but(SEEN, SEEN[0]))
def test_a_bug_of_the_zoo_is_seen(suite_seed, bug, options):
    settings = Settings(width=24, height=24, spp=32, seed=suite_seed, **options)
    wrong = tracer.render(loaded("cornell_unit"), settings, steps=zoo.steps(bug))
    assert not z_test(wrong, rendered(suite_seed + 1, 32, **options)).same
    assert z_test(rendered(suite_seed, 32, **options), rendered(suite_seed + 1, 32, **options)).same


def furnace(seed, spp, side=32):
    """Light of a closed room with roulette from the start: bounded noise about a known mean."""
    options = {"max_depth": 8, "integrator": "walk", "roulette": "0.8"}
    settings = Settings(width=side, height=side, spp=spp, seed=seed, **options)
    return tracer.render(tracer.load("furnace"), settings), 2.0 * (1.0 - 0.5**8)


def test_95_of_100_error_bars_hold_the_truth(suite_seed):
    """Red only: the room is grey, its channels are one."""
    room, truth = furnace(suite_seed, 128)
    red = np.array([truth, np.nan, np.nan])
    found = calibration(room, red)
    low, high = found.band(1e-3)
    assert found.intervals == 32 * 32 and low <= found.share <= high, found
    short = SimpleNamespace(rgb=room.rgb, variance=0.6 * room.variance, samples=room.samples)
    assert calibration(short, red).share < low  # the broken twin


def test_a_picture_against_a_truth(suite_seed):
    room, truth = furnace(suite_seed, 64)
    found = z_test(room, truth)
    assert found.same
    assert not z_test(room, truth + 2.5 * found.bound[0]).same


def still(value, n=16, side=12):
    return picture(np.full((side, side, 3, n), value, np.float32))


@pytest.mark.parametrize("n", [2, 4, 16, 1000])
def test_pictures_without_any_noise(n):
    assert z_test(still(2.0, n), still(2.0, n)).same
    assert z_test(still(2.0, n), still(2.0 * (1.0 + 1e-6), n)).same, "rounding"
    assert not z_test(still(2.0, n), still(2.0 * (1.0 + 1e-4), n)).same
    assert z_test(still(2.0, n), 2.0).same and not z_test(still(2.0, n), 2.001).same


def test_a_few_samples_that_are_all_alike_prove_little():
    """Two samples of a pixel at a lamp's edge may both hit it, and in the other picture both miss."""
    a, b = still(0.0, 2), still(0.0, 2)
    b.rgb[3, 4] = 18.0
    assert z_test(a, b).same
    a, b = still(0.0, 16), still(0.0, 16)
    b.rgb[3, 4] = 18.0
    found = z_test(a, b)
    assert not found.same and found.worst[:2] == (4, 3)


def test_pixels_that_are_not_finite(suite_seed):
    rng = np.random.default_rng(suite_seed)
    a, b = noisy(rng, 16), noisy(rng, 16)
    a.rgb[2, 3] = a.variance[2, 3] = np.nan
    found = z_test(a, b)
    assert found.invalid == 1 and not found.same and np.isnan(found.z[2, 3]).all()
    b.rgb[2, 3] = b.variance[2, 3] = np.nan
    found = z_test(a, b)
    assert found.invalid == 0 and found.same
    b.rgb[2, 3] = np.inf
    assert z_test(a, b).invalid == 1


def test_one_sample_a_pixel_cannot_be_tested(suite_seed):
    rng = np.random.default_rng(suite_seed)
    found = z_test(noisy(rng, 1), noisy(rng, 16))
    assert found.tested == 0 and found.unknown == 256 and found.same
    assert any("256 pixels" in note for note in compare(noisy(rng, 1), noisy(rng, 16)).notes)


def test_what_cannot_be_compared_is_refused(suite_seed):
    rng = np.random.default_rng(suite_seed)
    with pytest.raises(TracerError, match="sizes differ: 16 x 16 and 8 x 8"):
        z_test(noisy(rng, 4), noisy(rng, 4, 8))
    with pytest.raises(TracerError, match="without variance"):
        z_test(noisy(rng, 4), SimpleNamespace(rgb=np.ones((16, 16, 3)), variance=None, samples=None))


def test_files_are_pictures_and_what_is_none_is_told_so(suite_seed, tmp_path):
    one = rendered(suite_seed, 16)
    tracer.write(one, tmp_path / "one.exr")
    assert_same_picture(tmp_path / "one.exr", rendered(suite_seed + 1, 16))
    with pytest.raises(TracerError, match="a ndarray is no picture"):
        assert_same_picture(one.rgb, one)


def test_a_failed_assertion_says_where_to_look_and_what_to_run(suite_seed):
    a, b = rendered(suite_seed, 16), rendered(suite_seed + 1, 16)
    assert_same_picture(a, b)
    wrong = SimpleNamespace(rgb=a.rgb.copy(), variance=a.variance, samples=a.samples, settings=a.settings)
    wrong.rgb[10:16, 4:12] += 0.5
    with pytest.raises(AssertionError) as failed:
        assert_same_picture(wrong, b, scene="cornell_unit")
    text = str(failed.value)
    x, y = compare(wrong, b).worst[:2]
    assert 4 <= x < 12 and 10 <= y < 16
    for part in ("Z = ", f"Pixel ({x}, {y})", "region", "castray inspect cornell_unit --size 24 24"):
        assert part in text, text
    assert f"--seed {suite_seed}" in text and f"--pixel {x} {y}" in text


def test_a_mirrored_picture_is_called_so(suite_seed):
    a, b = rendered(suite_seed, 16), rendered(suite_seed + 1, 16)
    turned = SimpleNamespace(rgb=b.rgb[:, ::-1], variance=b.variance[:, ::-1], samples=b.samples)
    verdict = compare(a, turned)
    assert not verdict.same and any("left and right exchanged" in note for note in verdict.notes)
    assert not compare(a, b).errors.turned


def test_the_same_seed_is_mentioned(suite_seed):
    notes = compare(rendered(suite_seed, 16), rendered(suite_seed, 17)).notes
    assert any(f"seed {suite_seed}" in note for note in notes)
    assert compare(rendered(suite_seed, 16), rendered(suite_seed, 16)).same
