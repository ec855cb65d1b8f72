"""Error bars of a low-discrepancy sampler: from independent replicates, or none, and everybody says so."""

from types import SimpleNamespace
from unittest.mock import patch

import numpy as np
import pytest
from cases import loaded
from scipy import stats
from suite import castray

import tracer
from tracer import Settings, TracerError, film
from tracer.sampler import Lattice
from tracer.testing import assert_same_picture, calibration, compare, z_test
from viewer.cli import main

LATTICE = {"sampler": "lattice"}
SENTENCE = "samples of a low-discrepancy sampler are not independent: give --replicates for error bars"
FURNACE = {"integrator": "walk", "roulette": "0.8", "max_depth": 8}
TRUTH = 2.0 * (1.0 - 0.5**8)


def filled(samples, replicates, firsts=None):
    """A film whose pixels got samples (3, P, n) in blocks of 16, the last one shorter."""
    sheet = film.Film(samples.shape[1], replicates)
    for start in range(0, samples.shape[2], film.BLOCK):
        sheet.add(slice(None), film.block(samples[:, :, start : start + film.BLOCK], start, replicates))
    return sheet


def drawn(seed, n, pixels=20):
    return np.random.default_rng(seed).lognormal(0.0, 2.0, (3, pixels, n)).astype(np.float32)


@pytest.mark.parametrize(("n", "replicates"), [(16, 2), (48, 3), (64, 4), (96, 32), (40, 5), (24, 24)])
def test_the_variance_is_that_of_the_means_of_the_replicates(suite_seed, n, replicates):
    samples = drawn(suite_seed, n)
    means = samples.astype(np.float64).reshape(3, -1, n // replicates, replicates).mean(axis=2)
    expected = means.var(axis=2, ddof=1) / replicates
    np.testing.assert_allclose(filled(samples, replicates).variance(), expected, rtol=1e-6)


@pytest.mark.parametrize(("n", "replicates"), [(16, 3), (32, 5), (16, 24)])
def test_replicates_of_unequal_size_when_a_picture_is_stopped(suite_seed, n, replicates):
    """Right to the fraction by which they differ: over many pixels, against the truth."""
    samples = np.random.default_rng(suite_seed).standard_normal((3, 4000, n))
    found = filled(samples, replicates).variance().mean(dtype=np.float64)
    assert found == pytest.approx(1.0 / n, rel=0.05)


def test_the_mean_is_that_of_any_film(suite_seed):
    samples = drawn(suite_seed, 40)
    usual = filled(samples, None)
    for replicates in (1, 4, 5):
        sheet = filled(samples, replicates)
        assert sheet.mean().tobytes() == usual.mean().tobytes()
        assert sheet.spread.tobytes() == usual.spread.tobytes()
        one = film.gather(samples[:, 3], replicates)
        assert one.variance().tobytes() == np.ascontiguousarray(sheet.variance()[:, 3:4]).tobytes()
    np.testing.assert_allclose(usual.sample_variance(), samples.var(axis=2, ddof=1, dtype=float), rtol=1e-9)


def test_one_replicate_says_nothing_and_equal_ones_have_no_variance():
    samples = np.full((3, 4, 40), 1e9 + 0.1, np.float32)
    assert np.isnan(filled(samples, 1).variance()).all()
    assert (
        np.isnan(film.Film(3, 4).variance()).all() and np.isnan(filled(samples[..., :1], 4).variance()).all()
    )
    assert (filled(samples, 4).variance() == 0.0).all()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"replicates": 4}, "replicates: 4 is for sampler lattice"),
        ({**LATTICE, "replicates": 0}, "replicates: 0 is not between 1 and 4096"),
        ({**LATTICE, "replicates": 5}, "spp: 16 is not a multiple of replicates, 5"),
        ({**LATTICE, "replicates": 32}, "spp: 16 is not a multiple of replicates, 32"),
    ],
)
def test_replicates_that_make_no_sense_are_refused(options, said):
    with pytest.raises(TracerError, match=said):
        Settings(**options)


def test_a_look_at_fewer_samples_is_always_possible():
    settings = Settings(**LATTICE, spp=64, replicates=16)
    assert settings.at_spp(4).replicates == 1 and settings.at_spp(32).replicates == 16


def furnace(seed, spp=64, replicates=8, side=32, **more):
    settings = Settings(
        width=side, height=side, spp=spp, seed=seed, replicates=replicates, **LATTICE, **FURNACE
    )
    return tracer.render(loaded("furnace"), settings, **more)


@pytest.mark.statistical
def test_it_is_unbiased(suite_seed):
    """Against the truth of the furnace; a lattice that is not shifted, the broken twin, is off."""
    assert z_test(furnace(suite_seed), TRUTH).same
    usual = Lattice.__call__

    def unshifted(self, pixel, sample, depth, use):
        return usual(self, np.zeros_like(pixel), sample, depth, use)

    with patch.object(Lattice, "__call__", unshifted):
        assert not z_test(furnace(suite_seed, 16, 2), TRUTH).same


@pytest.mark.slow
@pytest.mark.statistical
def test_95_of_100_error_bars_hold_the_truth(suite_seed):
    """Red only: the room is grey. Bars from the spread of samples, the broken twin, promise too little."""
    room, red = furnace(suite_seed, 128, 8), np.array([TRUTH, np.nan, np.nan])
    found = calibration(room, red)
    low, high = found.band(1e-3)
    assert found.intervals == 32 * 32 and low <= found.share <= high, found
    independent = Settings(width=32, height=32, spp=128, **FURNACE)
    twin = tracer.render(loaded("furnace"), independent)
    naive = SimpleNamespace(rgb=room.rgb, variance=twin.variance, samples=room.samples)
    assert calibration(naive, red).share > high


@pytest.mark.statistical
def test_the_same_light_as_with_independent_samples(suite_seed):
    options = {"width": 24, "height": 24, "max_depth": 5}
    scene = loaded("cornell_unit")
    one = tracer.render(scene, Settings(**options, spp=64, seed=suite_seed))
    other = tracer.render(scene, Settings(**options, **LATTICE, spp=64, seed=suite_seed + 1, replicates=4))
    assert_same_picture(one, other)
    assert other.variance.mean() < 0.5 * one.variance.mean()


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("replicates", [2, 4, 16])
def test_false_alarms_of_few_replicates(suite_seed, replicates):
    runs, alpha = 30, 0.05
    options = {"width": 16, "height": 16, "max_depth": 3, "spp": 16, "replicates": replicates, **LATTICE}
    rgb = [
        tracer.render(loaded("cornell_unit"), Settings(**options, seed=suite_seed + k))
        for k in range(2 * runs)
    ]
    alarms = sum(z_test(a, b).p_value < alpha for a, b in zip(rgb[::2], rgb[1::2], strict=True))
    assert alarms <= stats.binom.ppf(1.0 - 1e-4, runs, alpha)


def rmse(sampler, spp, seeds, **options):
    """Root mean square over pixels and seeds of the error, as the spread between seeds has it."""
    pictures = [
        tracer.render(loaded("cornell_unit"), Settings(**options, spp=spp, seed=seed, sampler=sampler)).rgb
        for seed in seeds
    ]
    return float(np.sqrt(np.var(pictures, axis=0, ddof=1, dtype=np.float64).mean()))


@pytest.mark.slow
@pytest.mark.statistical
def test_the_error_falls_faster_than_that_of_independent_samples(suite_seed):
    """RMSE ~ N^s on cornell_unit from 16 to 256 samples: s < -0.6, and -0.5 within 0.1 for the broken twin,
    independent samples. The noise of s is 0.03 and 0.02."""
    options, seeds = {"width": 20, "height": 20, "max_depth": 8}, range(suite_seed, suite_seed + 6)
    slope = {
        sampler: np.log(rmse(sampler, 256, seeds, **options) / rmse(sampler, 16, seeds, **options))
        / np.log(16)
        for sampler in ("lattice", "independent")
    }
    assert slope["lattice"] < -0.6 and abs(slope["independent"] + 0.5) < 0.1, slope


@pytest.fixture
def pictures(tmp_path, monkeypatch, suite_seed):
    """one.exr without error bars, four.exr and again.exr with 4 replicates, plain.exr independent."""
    options = {"width": 16, "height": 16, "max_depth": 3, "spp": 16}
    for k, (name, more) in enumerate(
        {
            "one": LATTICE,
            "four": {**LATTICE, "replicates": 4},
            "again": {**LATTICE, "replicates": 4},
            "plain": {},
        }.items()
    ):
        settings = Settings(**options, **more, seed=suite_seed + k)
        tracer.write(tracer.render(loaded("cornell_unit"), settings), tmp_path / f"{name}.exr")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def diff(*words):
    with pytest.raises(SystemExit) as ended:
        main(["diff", *words])
    return ended.value.code


def test_diff_gives_no_p_value_where_the_error_is_not_known_and_says_why(pictures, capsys):
    assert diff("one.exr", "plain.exr") == 1
    out = capsys.readouterr().out
    assert f"No p-value is possible, because of one.exr: {SENTENCE}." in out and "p =" not in out
    assert diff("four.exr", "again.exr") == 0 and diff("plain.exr", "four.exr") == 0
    assert "p-value of it all" in capsys.readouterr().out


def test_a_picture_from_a_file_is_tested_by_its_replicates(pictures):
    four, plain, one = (tracer.read(f"{name}.exr") for name in ("four", "plain", "one"))
    assert z_test(four, plain).same and compare(four, plain).z is not None
    for refused in (lambda: z_test(one, plain), lambda: calibration(one, 1.0)):
        with pytest.raises(TracerError, match=SENTENCE):
            refused()
    assert compare(one, one).same and compare(one, plain).z is None


@pytest.mark.parametrize(
    ("words", "said", "row"),
    [
        ((), f"its error is not known; {SENTENCE}", False),
        (("--replicates", "4"), "its error comes from the spread of 4 replicates", True),
    ],
)
def test_inspect_shows_an_error_only_where_it_is_known(capsys, words, said, row):
    with pytest.raises(SystemExit):
        size = ("--size", "8", "8", "--pixel", "3", "4", "--spp", "8", "--max-depth", "3")
        main(["inspect", "cornell_unit", *size, "--sampler", "lattice", *words])
    lines = capsys.readouterr().out.splitlines()
    assert said in lines
    assert any(line.strip().startswith("its error  ") for line in lines) == row


def test_samples_are_given_where_the_error_is_only_if_it_is_known():
    settings = Settings(width=32, height=32, spp=256, max_depth=4, **LATTICE)
    with pytest.raises(TracerError, match="until_error: samples of sampler lattice are not independent"):
        tracer.render(loaded("cornell_unit"), settings, until_error=0.1)
    known = Settings(**{**settings.as_dict(), "replicates": 4})
    picture = tracer.render(loaded("cornell_unit"), known, until_error=0.1)
    assert 0.0 < picture.saved < 1.0
    adaptive = tracer.render(loaded("cornell_unit"), settings.at_spp(64), adaptive="mse")
    assert adaptive.samples.max() > 64 and abs(adaptive.samples.mean() / 64 - 1) < 0.02
    assert np.isnan(adaptive.variance).all()


@pytest.mark.slow
def test_the_options_of_the_command_line(tmp_path):
    words = ("--size", 8, 8, "--spp", 8, "--max-depth", 3, "--sampler", "lattice")
    done = castray("render", "furnace", *words, "--replicates", 2, "-o", tmp_path / "a.exr", "--json")
    assert done.returncode == 0, done.stderr
    assert tracer.read(tmp_path / "a.exr").notes["settings"]["replicates"] == 2
    done = castray("render", "furnace", *words, "--replicates", 3, "-o", tmp_path / "b.exr")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "replicates" in done.stderr
