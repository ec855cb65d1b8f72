"""Samples go where they are needed, and no pixel's own samples decide on how many it gets."""

import numpy as np
import pytest
from cases import loaded
from stats import z_limit
from suite import castray

import tracer
from tracer import Settings, film
from tracer.engine import plan, processes, waves

SMALL = {"width": 32, "height": 32, "max_depth": 4}
FLAT_FURNACE = {"integrator": "walk", "roulette": "off", "max_depth": 8}


def render(scene="cornell_unit", **options):
    words = {k: options.pop(k) for k in ("until_error", "adaptive", "workers", "progress") if k in options}
    return tracer.render(loaded(scene), Settings(**SMALL | options), **words)


@pytest.mark.parametrize("goal", ["mse", "relmse"])
def test_an_adaptive_picture_spends_what_was_asked(goal):
    picture = render(spp=64, adaptive=goal)
    assert abs(picture.samples.mean() / 64 - 1) < 0.01
    assert picture.samples.min() == 16 and picture.samples.max() > 64
    assert (picture.samples % film.BLOCK == 0).all()


@pytest.mark.slow
@pytest.mark.parametrize("words", [{"adaptive": "mse"}, {"adaptive": "relmse"}, {"until_error": 0.1}])
def test_a_pixel_with_its_own_number_of_samples_is_inspected_bit_for_bit(words):
    picture = render(spp=128, **words)
    for n in np.unique(picture.samples)[:: max(1, np.unique(picture.samples).size // 6)]:
        y, x = np.argwhere(picture.samples == n)[-1]
        record = tracer.inspect(loaded("cornell_unit"), Settings(**SMALL, spp=int(n)), int(x), int(y))
        assert record.value.tobytes() == picture.rgb[y, x].tobytes(), n


@pytest.mark.slow
@pytest.mark.parametrize("words", [{"adaptive": "mse"}, {"until_error": 0.1}])
def test_neither_waves_nor_processes_change_it(monkeypatch, words):
    usual = render(spp=64, **words)
    monkeypatch.setattr(waves, "LANES", 999)
    monkeypatch.setattr(processes, "WORTH_A_START", -1.0)
    other = render(spp=64, workers=2, **words)
    assert other.rgb.tobytes() == usual.rgb.tobytes()
    assert other.samples.tobytes() == usual.samples.tobytes()


@pytest.mark.slow
def test_where_nothing_varies_one_block_is_enough():
    """The furnace without noise, and all of a lamp but its edge."""
    picture = render("furnace", spp=1024, until_error=1e-3, **FLAT_FURNACE)
    assert (picture.samples == film.BLOCK).all() and picture.saved == 1 - 1 / 64
    picture = render("cornell", spp=32, until_error=1e-3, width=128, height=128, integrator="direct")
    on_lamp = picture.rgb[..., 0] > 47.8
    within = on_lamp[1:-1, :-2] & on_lamp[1:-1, 2:] & on_lamp[:-2, 1:-1] & on_lamp[2:, 1:-1]
    assert within.sum() > 10 and (picture.samples[1:-1, 1:-1][within] == film.BLOCK).all()
    assert (picture.samples == 32).sum() > 0.5 * picture.samples.size


def test_every_tile_comes_under_the_error_asked_for():
    asked = 0.12
    picture = render(spp=4096, width=48, height=40, until_error=asked)
    relative = (picture.variance / (picture.rgb.astype(float) ** 2 + plan.DARK)).mean(axis=2)
    for y in (0, 16):
        for x in (0, 16, 32):
            part = relative[y : y + 16 if y == 0 else None, x : x + 16]
            assert np.sqrt(part.mean()) < 1.25 * asked
    assert 0.5 < picture.saved < 1.0


def bernoulli(p, n_pixels, seed):
    """A tracer whose samples are 1 with probability p, else 0, by pixel and sample."""
    rng = np.random.default_rng(seed)
    return (rng.random((n_pixels, 4096)) < p).astype(np.float64)


def played(settings, drawn, rounds, sheet):
    """The film after all rounds of a plan, from samples (P, S) that stand ready."""
    for tasks in rounds:
        for task in tasks:
            first = np.broadcast_to(task.sample, task.numbers.shape)
            radiance = drawn[task.numbers[:, None], first[:, None] + np.arange(task.samples)]
            block = film.block(np.broadcast_to(radiance, (3, *radiance.shape)))
            waves.collect(sheet, waves.Result(task, block, 0, 0))
    return sheet


def selfish(settings, sheet, error):
    """The broken twin: a pixel is sampled until its own error is small."""
    going, sample = np.arange(sheet.samples.size), 0
    while sample < settings.spp and going.size:
        yield plan._rows(going, np.ones(going.size, np.int64), sample)
        sample += film.BLOCK
        variance = sheet.variance().astype(np.float64)
        going = np.flatnonzero(plan.relative_spread(sheet, variance) > error * error)


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("which", ["until_error", "mse", "relmse", "selfish"])
def test_no_plan_darkens_rare_light(suite_seed, which):
    """Samples that are seldom 1: the mean over 40 pictures of 24 x 24, two-sided z at 1 % over the plans; a
    pixel that stops when it looks good itself is too dark, and is caught."""
    settings, p = Settings(width=24, height=24, spp=256), 0.02
    pixels, means = 24 * 24, []
    for run in range(40):
        sheet = film.Film(pixels)
        words = {"until_error": 0.3} if which == "until_error" else {"adaptive": which}
        rounds = (
            selfish(settings, sheet, 0.3) if which == "selfish" else plan.rounds(settings, sheet, **words)
        )
        played(settings, bernoulli(p, pixels, suite_seed + run), rounds, sheet)
        means.append(sheet.mean()[0].astype(np.float64).mean())
    z = (np.mean(means) - p) / (np.std(means, ddof=1) / np.sqrt(len(means)))
    assert (abs(z) > z_limit(3)) == (which == "selfish"), z


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--until-error", "0"), "until_error: 0.0 is not a number above 0"),
        (("--until-error", "nan"), "until_error: nan is not a number above 0"),
        (("--until-error", "0.1", "--spp", "20"), "spp: 20; until_error works in blocks of 16"),
        (("--adaptive", "mse", "--spp", "16"), "spp: 16; adaptive works in blocks of 16: 32 or more"),
        (
            ("--adaptive", "yes", "--spp", "32"),
            "adaptive: 'yes' is not known; choose one of off, mse, relmse",
        ),
        (("--adaptive", "mse", "--until-error", "1"), "adaptive: cannot be had with until_error"),
    ],
)
def test_a_plan_that_makes_no_sense_is_refused_in_one_line(tmp_path, words, said):
    done = castray("render", "furnace", "--size", 8, 8, *words, "-o", tmp_path / "no.png")
    assert done.returncode == 2 and not list(tmp_path.iterdir())
    assert said in done.stderr and done.stderr.count("\n") == 1
