"""Mean and variance of a pixel: stable, in one order, and nothing of the mean changed by the variance."""

import numpy as np
import pytest
from cases import loaded
from suite import castray

import tracer
from tracer import Settings, film


def filled(samples, sizes):
    """A film whose pixels got samples (3, P, n) in blocks of these sizes."""
    sheet, start = film.Film(samples.shape[1]), 0
    for size in sizes:
        sheet.add(slice(None), film.block(samples[:, :, start : start + size]))
        start += size
    assert start == samples.shape[2]
    return sheet


def sizes(n):
    """How n samples are cut into blocks."""
    return [min(film.BLOCK, n - start) for start in range(0, n, film.BLOCK)]


def drawn(seed, n, pixels=50):
    """Samples as paths bring them: mostly dark, some very bright."""
    return np.random.default_rng(seed).lognormal(0.0, 2.0, (3, pixels, n)).astype(np.float32)


@pytest.mark.parametrize("repeats", [1, 25])
def test_a_small_spread_about_a_large_mean_is_kept(repeats):
    """{4, 7, 13, 16} have the variance 30; that of E[x^2] - E[x]^2 in float64 at 1e9 is -170."""
    numbers = np.tile(1e9 + np.array([4.0, 7.0, 13.0, 16.0]), repeats)
    n = numbers.size
    expected = 90.0 * repeats / (n - 1)
    sheet = filled(np.broadcast_to(numbers, (3, 2, n)), sizes(n))
    assert (sheet.spread / (n - 1) == expected).all()
    naive = n / (n - 1) * ((numbers**2).mean() - numbers.mean() ** 2)
    assert abs(naive - expected) > 10.0  # the broken twin


@pytest.mark.parametrize("n", [2, 3, 16, 17, 100, 1000])
def test_the_variance_is_that_of_the_mean(suite_seed, n):
    samples = drawn(suite_seed, n)
    expected = samples.astype(np.float64).var(axis=2, ddof=1) / n
    np.testing.assert_allclose(filled(samples, sizes(n)).variance(), expected, rtol=1e-6)


def test_one_sample_says_nothing_about_its_variance(suite_seed):
    assert np.isnan(filled(drawn(suite_seed, 1), [1]).variance()).all()
    assert np.isnan(film.Film(3).variance()).all()


def test_samples_that_are_alike_have_no_variance():
    samples = np.full((3, 4, 40), 1e9 + 0.1, np.float32)
    assert (filled(samples, sizes(40)).variance() == 0.0).all()


@pytest.mark.parametrize("scale", [1e-30, 1e-20, 1e30])
def test_very_dark_and_very_bright_samples(suite_seed, scale):
    """Dark ones never look as if they did not vary; what is too bright for float32 is infinite, and quiet."""
    variance = filled(drawn(suite_seed, 20).astype(np.float64) * scale, sizes(20)).variance()
    assert (variance > 0.0).all()


def test_blocks_are_joined_in_their_order_and_the_mean_is_what_it_was(suite_seed):
    """Bit for bit: pixel by pixel or all together, and the mean is the plain sum of the plain block sums."""
    samples = drawn(suite_seed, 50)
    together = filled(samples, sizes(50))
    alone = [film.gather(samples[:, p]) for p in range(samples.shape[1])]
    assert together.variance().tobytes() == np.hstack([a.variance() for a in alone]).tobytes()
    total = np.zeros(samples.shape[:2])
    for start in range(0, 50, 16):
        block = np.zeros(samples.shape[:2])
        for s in range(start, min(start + 16, 50)):
            block = block + samples[:, :, s]
        total = total + block
    assert together.mean().tobytes() == (total / 50).astype(np.float32).tobytes()
    assert together.mean()[:, 3].tobytes() == film.fold(samples[:, 3]).tobytes()


def test_order_matters_to_the_last_bits_and_to_no_others(suite_seed):
    samples = drawn(suite_seed, 64, 500)
    ahead, back = (filled(s, sizes(64)).spread for s in (samples, samples[:, :, ::-1]))
    assert ahead.tobytes() != back.tobytes()
    np.testing.assert_allclose(ahead, back, rtol=1e-13)


def test_the_picture_has_the_variance_that_inspect_finds(suite_seed):
    settings = Settings(width=8, height=6, spp=20, seed=suite_seed)
    picture = tracer.render(loaded("cornell_unit"), settings)
    assert picture.variance.shape == (6, 8, 3) and picture.variance.dtype == np.float32
    for x, y in ((0, 0), (3, 4), (7, 5)):
        record = tracer.inspect(loaded("cornell_unit"), settings, x, y)
        assert record.variance.tobytes() == picture.variance[y, x].tobytes()
        radiance = np.stack([path.radiance for path in record.paths]).astype(np.float64)
        np.testing.assert_allclose(record.variance, radiance.var(axis=0, ddof=1) / 20, rtol=1e-6)
        assert record.as_dict(loaded("cornell_unit").at(settings))["variance"] == pytest.approx(
            record.variance.tolist()
        )


@pytest.mark.slow
def test_inspect_prints_the_error_of_the_pixel(suite_seed):
    """Standard error, from the samples that stand above it."""
    words = ("--size", "8", "6", "--pixel", "3", "4", "--seed", suite_seed)
    out = castray("inspect", "cornell_unit", *words, "--spp", "5").stdout
    settings = Settings(width=8, height=6, spp=5, seed=suite_seed)
    error = np.sqrt(tracer.inspect(loaded("cornell_unit"), settings, 3, 4).variance)
    (line,) = (line for line in out.splitlines() if "its error" in line)
    assert [float(word) for word in line.split()[2:]] == pytest.approx(error.tolist(), rel=0.05)
    assert "its error" not in castray("inspect", "cornell_unit", *words, "--spp", "1").stdout
