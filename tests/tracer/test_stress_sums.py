"""Stress cases S58 to S62: radiance of any size, long sums, and sums in any company."""

import copy
import pickle
from functools import partial

import numpy as np
import pytest
from cases import loaded, slow_but

import tracer
from tracer import Settings, TracerError, film
from tracer.engine import processes, waves
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave

both = pytest.mark.parametrize("precision", [32, 64])
pytestmark = pytest.mark.filterwarnings("error")

ROOM = {
    "sensor": {
        "type": "perspective",
        "fov": 40,
        "to_world": [{"look_at": {"origin": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}],
        "film": {"width": 5, "height": 5},
    },
    "floor": {
        "type": "rectangle",
        "to_world": [{"scale": 5}, {"rotate": [1, 0, 0], "angle": -90}, {"translate": [0, -1, 0]}],
    },
}


def lamp(Le, x=0.0):
    """A square lamp two metres wide that reflects nothing."""
    return {
        "type": "rectangle",
        "to_world": [{"translate": [x, 0, 0]}],
        "bsdf": {"type": "diffuse", "reflectance": 0.0},
        "emitter": {"type": "area", "radiance": Le},
    }


def lit(*lamps):
    return tracer.load_dict(copy.deepcopy(ROOM) | {f"lamp{k}": table for k, table in enumerate(lamps)})


def radiances(scene, settings):
    """What every path of a picture brings back, (3, N) in the path's own precision."""
    settings = settings.at_size_of(scene)
    pixel, sample = np.divmod(np.arange(settings.width * settings.height * settings.spp), settings.spp)
    wave = Wave(pixel % settings.width, pixel // settings.width, sample, settings)
    for _ in waves.events(scene, settings, wave):
        pass
    assert wave.dropped == 0
    return wave.radiance


@pytest.mark.parametrize("integrator", ["walk", "direct", "path"])
@pytest.mark.parametrize(
    ("precision", "powers"), [(64, (-133, -997, 60)), (32, (-60, -100, 60))], ids=["64", "32"]
)
def test_s58_light_of_any_size_scales_exactly(integrator, precision, powers):
    """To 1e-40 and 1e-300 in float64: no dim lamp is taken for black, no bright one for infinite."""
    settings = Settings(spp=16, precision=precision, integrator=integrator, max_depth=4)
    one = radiances(lit(lamp(1.0)), settings)
    assert one.any()
    for power in powers:
        scaled = radiances(lit(lamp(2.0**power)), settings)
        assert scaled.tobytes() == (one * one.dtype.type(2.0**power)).tobytes(), power


@pytest.mark.parametrize("Le", [1e-40, 1e-300])
def test_s58_what_single_precision_cannot_hold_it_refuses(Le):
    for scene in (lit(lamp(Le)), lit(lamp(1.0, 2.0), lamp([0.0, Le, 0.0]))):
        with pytest.raises(TracerError, match=r"lamp.\.emitter: .* single precision .*use precision 64"):
            tracer.render(scene, Settings(spp=1))
        picture = tracer.render(scene, Settings(spp=1, precision=64))
        assert picture.dropped == 0 and ((picture.rgb > 0).any() or Le < 1e-45)  # a picture is float32
    paths = tracer.inspect(lit(lamp(Le)), Settings(spp=1, precision=64), 2, 2).paths
    assert paths[0].radiance == pytest.approx([Le] * 3, rel=1e-15, abs=0.0)


@both
def test_s59_the_brightest_beside_the_dimmest(precision):
    picture = tracer.render(
        lit(lamp(1e30, -1.0), lamp(1e-10, 1.0)), Settings(spp=64, precision=precision, max_depth=4)
    )
    bright, shared, dim = picture.rgb[2, 1], picture.rgb[2, 2], picture.rgb[2, 3]
    assert (bright == np.float32(1e30)).all() and (dim == np.float32(1e-10)).all()
    share = shared / np.float32(1e30)
    assert ((0.3 < share) & (share < 0.7)).all() and np.allclose(share * 64, np.round(share * 64), rtol=1e-6)
    assert picture.dropped == 0 and np.isfinite(picture.rgb).all() and (picture.rgb >= 0).all()
    # The square of 1e30 is more than float32 holds; that the mean is not sure is said, and by no NaN.
    assert (picture.variance[2, 3] < 1e-37).all() and not np.isnan(picture.variance).any()
    with pytest.raises(TracerError, match="radiance.*1e.31.*1e.30"):
        lit(lamp(1e31))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_s60_two_hundred_thousand_samples_alike_have_their_mean(dtype):
    n, value = 200_000, dtype(0.1)
    sheet, part = film.Film(1), film.block(np.full((3, 1, film.BLOCK), value))
    for _ in range(n // film.BLOCK):
        sheet.add(slice(0, 1), part)
    assert np.abs(sheet.total / n / float(value) - 1.0).max() < 1e-12
    assert (sheet.mean() == np.float32(value)).all() and (sheet.variance() < 1e-30).all()
    naive = np.cumsum(np.full(n, value, np.float32), dtype=np.float32)[-1]  # the broken twin
    assert abs(naive / n / float(value) - 1.0) > 1e-3


def test_s60_a_sum_of_ones_goes_on_where_single_precision_stops():
    sheet = film.Film(1)
    sheet.total[:], sheet.samples[:] = 2.0**24, 2**24
    sheet.add(slice(0, 1), film.block(np.ones((3, 1, 3), np.float32)))
    assert (sheet.total == 2.0**24 + 3).all() and np.float32(2.0**24) + np.float32(1) == np.float32(2.0**24)


TILED = Settings(width=14, height=14, spp=50, max_depth=4)


def sheet_of(results, sheet=None):
    sheet = sheet or film.Film(TILED.width * TILED.height)
    for result in results:
        waves.collect(sheet, result)
    return sheet


@pytest.mark.parametrize("tiles", slow_but((1, 2, 7), 2))
@both
def test_s62_tiles_of_any_number_in_any_order_give_the_same_picture(suite_seed, tiles, precision):
    """Blocks of one pixel in order, pixels in any: mean and variance to the last bit."""
    settings = Settings(**TILED.as_dict() | {"seed": suite_seed, "precision": precision})
    usual = tracer.render(loaded("cornell_unit"), settings)
    scene, lanes = loaded("cornell_unit").at(settings), TILED.width * TILED.height * film.BLOCK // tiles
    results = [waves.trace(scene, settings, RIGHT, task) for task in waves.tasks(settings, lanes)]
    assert len(results) > 3 * tiles
    rng = np.random.default_rng(suite_seed)
    for _ in range(3):
        rng.shuffle(results)
        results.sort(key=lambda result: result.task.sample)  # stable: only the order of blocks is kept
        sheet = sheet_of(results)
        assert sheet.mean().T.tobytes() == usual.rgb.tobytes()
        assert sheet.variance().T.tobytes() == usual.variance.tobytes()


def test_s62_a_sum_that_was_put_away_goes_on_as_if_nothing_had_been(suite_seed):
    settings = Settings(**TILED.as_dict() | {"seed": suite_seed})
    scene = loaded("cornell_unit").at(settings)
    results = [waves.trace(scene, settings, RIGHT, task) for task in waves.tasks(settings, 1000)]
    whole = sheet_of(results)
    for stop in (1, 5, len(results) - 1):
        kept = pickle.loads(pickle.dumps(sheet_of(results[:stop])))
        again = sheet_of(results[stop:], kept)
        assert again.mean().tobytes() == whole.mean().tobytes()
        assert again.variance().tobytes() == whole.variance().tobytes()


def test_s62_blocks_in_the_wrong_order_are_seen(suite_seed):
    """The broken twin: sums of other order differ in their last bits."""
    blocks = [film.block(b) for b in np.random.default_rng(suite_seed).lognormal(0, 2, (40, 3, 500, 16))]
    ahead, back = film.Film(500), film.Film(500)
    for one, other in zip(blocks, blocks[::-1], strict=True):
        ahead.add(slice(None), one)
        back.add(slice(None), other)
    assert ahead.total.tobytes() != back.total.tobytes()
    assert np.allclose(ahead.total, back.total, rtol=1e-13)


@pytest.mark.slow
def test_s62_neither_processes_nor_waves_nor_a_stop_change_a_bit(suite_seed, monkeypatch):
    settings = Settings(**TILED.as_dict() | {"seed": suite_seed})
    usual = tracer.render(loaded("cornell_unit"), settings)
    monkeypatch.setattr(processes, "WORTH_A_START", -1.0)
    for lanes, workers in ((300, 1), (1000, 2), (700, 3)):
        monkeypatch.setattr(waves, "tasks", partial(waves.tasks, lanes=lanes))
        other = tracer.render(loaded("cornell_unit"), settings, workers=workers)
        assert other.rgb.tobytes() == usual.rgb.tobytes()
        assert other.variance.tobytes() == usual.variance.tobytes()
