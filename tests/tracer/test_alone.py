"""A path traced alone is the path inside a full render, bit for bit; and watching changes nothing."""

from collections import deque
from functools import partial

import numpy as np
import pytest
from cases import INTEGRATORS, SCENES, loaded, slow_but

import tracer
from lessons import zoo
from tracer import Settings, film
from tracer.engine import processes, waves
from tracer.events import CAMERA, END
from tracer.integrator.steps import bounce
from tracer.integrator.wave import Wave
from tracer.recorder import record

SIDE = 16


def square(**options):
    return Settings(width=SIDE, height=SIDE, **options)


def wave_of(settings, pixel, sample, steps=zoo.RIGHT):
    pixel = np.asarray(pixel)
    return Wave(pixel % SIDE, pixel // SIDE, sample, settings, steps)


def story(scene, settings, wave):
    """Everything that happens to each path of a wave: a list of bytes per lane, event by event."""
    rows = [[] for _ in range(wave.x.size)]
    for event in waves.events(scene, settings, wave):
        for row, lane in enumerate(event.lane):
            rows[lane].append((event.kind.name, int(event.depth[row])))
            rows[lane] += [(name, c[..., row].tobytes()) for name, c in sorted(event.columns.items())]
    return rows


def all_of(settings):
    """Every pixel and sample of a picture, as two columns."""
    pixel, sample = np.divmod(np.arange(SIDE * SIDE * settings.spp), settings.spp)
    return pixel, sample


@pytest.mark.parametrize("precision", slow_but((32, 64), 32))
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("scene", slow_but((*SCENES, "coloured_glass"), "cornell_glass"))
def test_every_event_of_a_path_alone_is_that_of_the_path_in_the_wave(
    suite_seed, scene, integrator, precision
):
    settings = square(spp=4, integrator=integrator, precision=precision, seed=suite_seed)
    scene = loaded(scene).at(settings)
    pixel, sample = all_of(settings)
    together = story(scene, settings, wave_of(settings, pixel, sample))
    rng = np.random.default_rng(suite_seed)
    for lane in rng.permutation(pixel.size)[:12]:
        alone = story(scene, settings, wave_of(settings, pixel[[lane]], sample[[lane]]))
        assert alone[0] == together[lane], f"pixel {pixel[lane]}, sample {sample[lane]}"
    few = rng.permutation(pixel.size)[:37]
    in_company = story(scene, settings, wave_of(settings, pixel[few], sample[few]))
    assert in_company == [together[lane] for lane in few]


@pytest.mark.parametrize("precision", slow_but((32, 64), 32))
@pytest.mark.parametrize("integrator", slow_but(INTEGRATORS, "path"))
@pytest.mark.parametrize("scene", slow_but((*SCENES, "coloured_glass"), "cornell_glass"))
def test_neither_wave_nor_order_changes_a_path(suite_seed, scene, integrator, precision):
    settings = square(spp=3, integrator=integrator, precision=precision, seed=suite_seed)
    scene = loaded(scene).at(settings)
    pixel, sample = all_of(settings)

    def radiance(lanes):
        wave = wave_of(settings, pixel[lanes], sample[lanes])
        deque(waves.events(scene, settings, wave), maxlen=0)
        return wave.radiance

    whole = radiance(np.arange(pixel.size))
    shuffled = np.random.default_rng(suite_seed).permutation(pixel.size)
    assert radiance(shuffled).tobytes() == whole[:, shuffled].tobytes()
    for size in (1, 2, 5, 16, 101, 512):
        lanes = np.arange(min(pixel.size, 12 * size))
        parts = [radiance(lanes[start : start + size]) for start in range(0, lanes.size, size)]
        assert np.concatenate(parts, axis=1).tobytes() == whole[:, lanes].tobytes(), f"waves of {size}"


@pytest.mark.parametrize("lanes", [1, 50, 1000, 10**6])
@pytest.mark.parametrize("integrator", slow_but(INTEGRATORS, "path"))
@pytest.mark.parametrize("scene", slow_but(SCENES, "cornell_unit"))
def test_a_picture_does_not_depend_on_the_size_of_waves(suite_seed, monkeypatch, scene, integrator, lanes):
    side = 12 if lanes > 1 else 4
    settings = Settings(width=side, height=side, spp=18, integrator=integrator, seed=suite_seed, max_depth=5)
    usual = tracer.render(loaded(scene), settings)
    monkeypatch.setattr(waves, "tasks", partial(waves.tasks, lanes=lanes))
    other = tracer.render(loaded(scene), settings)
    assert other.rgb.tobytes() == usual.rgb.tobytes()
    assert (other.samples == 18).all()


@pytest.mark.slow
@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("bug", [None, "E01"])
def test_a_picture_does_not_depend_on_the_number_of_processes(suite_seed, monkeypatch, bug, precision):
    steps = zoo.steps(bug) if bug else zoo.RIGHT
    settings = square(spp=20, seed=suite_seed, precision=precision, max_depth=5)
    monkeypatch.setattr(waves, "tasks", partial(waves.tasks, lanes=400))
    monkeypatch.setattr(processes, "WORTH_A_START", -1.0)
    started = []
    monkeypatch.setattr(processes, "traced", partial(_noted, processes.traced, started))
    pictures = [tracer.render(loaded("cornell_unit"), settings, workers=n, steps=steps) for n in (1, 2, 3)]
    assert started == [2, 3]
    assert all(p.complete and (p.samples == 20).all() for p in pictures)
    assert len({(p.rgb.tobytes(), p.rays, p.dropped) for p in pictures}) == 1


def _noted(traced, started, job, tasks, workers):
    started.append(workers)
    return traced(job, tasks, workers)


@pytest.mark.parametrize("scene", slow_but(SCENES, "cornell_glass"))
def test_a_sample_does_not_depend_on_how_many_there_are(suite_seed, scene):
    few, many = square(spp=5, seed=suite_seed), square(spp=40, seed=suite_seed)
    for x, y in ((3, 4), (8, 8), (15, 0)):
        short = tracer.inspect(loaded(scene), few, x, y).paths
        long = tracer.inspect(loaded(scene), many, x, y).paths[:5]
        assert [p.radiance.tobytes() for p in short] == [p.radiance.tobytes() for p in long]
        lone = tracer.inspect(loaded(scene), few, x, y, sample=3)
        assert lone.paths[0].radiance.tobytes() == short[3].radiance.tobytes()


@pytest.mark.parametrize("precision", slow_but((32, 64), 32))
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("scene", slow_but((*SCENES, "coloured_glass"), "cornell_glass"))
def test_watching_changes_nothing(suite_seed, scene, integrator, precision):
    settings = square(spp=3, integrator=integrator, precision=precision, seed=suite_seed)
    rendered = tracer.render(loaded(scene), settings).rgb
    ready = loaded(scene).at(settings)
    pixel, sample = all_of(settings)
    wave = wave_of(settings, pixel, sample)
    with np.errstate(all="ignore"):
        paths = record(waves.events(ready, settings, wave), ready, wave)
    watched = np.stack([film.fold(wave.radiance[:, k : k + 3]) for k in range(0, pixel.size, 3)])
    assert watched.reshape(rendered.shape).tobytes() == rendered.tobytes()
    assert all(path.radiance.tobytes() == wave.radiance[:, k].tobytes() for k, path in enumerate(paths))


def frozen(event):
    """The event's arrays, made impossible to write to, each with a copy of what it holds now."""
    for array in (event.lane, event.depth, *event.columns.values()):
        copy, part = array.copy(), array
        while isinstance(part, np.ndarray):
            part.flags.writeable = False
            part = part.base
        yield array, copy


def written_again(scene, settings, steps=zoo.RIGHT):
    """Whether a loop changes what it has yielded, or tries to."""
    wave = wave_of(settings, *all_of(settings), steps)
    kept, kinds = [], set()
    try:
        for event in waves.events(scene.at(settings), settings, wave):
            kept += frozen(event)
            kinds.add(event.kind)
    except ValueError as error:
        assert "read-only" in str(error)
        return True
    assert {CAMERA, END} < kinds
    return any(array.tobytes() != copy.tobytes() for array, copy in kept)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("scene", [*SCENES, "coloured_glass"])
def test_a_yielded_array_is_never_written_again(suite_seed, scene, integrator):
    settings = square(spp=2, integrator=integrator, seed=suite_seed)
    assert not written_again(loaded(scene), settings)


def turns_the_hit(scene, hit, wo, u):
    """A bounce that borrows the hit's normal for its own sums."""
    hit.n[:] = -hit.n
    sample = bounce(scene, hit, wo, u)
    hit.n[:] = -hit.n
    return sample


def test_writing_to_a_yielded_array_is_seen(suite_seed):
    """The broken twin, even where the old numbers are put back."""
    settings = square(spp=2, integrator="path", seed=suite_seed)
    assert written_again(loaded("cornell_unit"), settings, zoo.changed(bounce=turns_the_hit))


def test_a_path_that_depends_on_its_company_is_seen(suite_seed):
    """The broken twin: one number of one path taken from the lane beside it."""
    settings = square(spp=1, integrator="path", seed=suite_seed)
    scene = loaded("cornell_unit").at(settings)
    steps = zoo.changed(throughput=_with_neighbour)
    pixel, sample = all_of(settings)
    together = story(scene, settings, wave_of(settings, pixel, sample, steps))
    alone = [story(scene, settings, wave_of(settings, [p], [0], steps))[0] for p in range(40)]
    assert alone != together[:40]


def _with_neighbour(beta, sample, cos):
    after = zoo.RIGHT.throughput(beta, sample, cos)
    return after + np.float32(1e-7) * np.roll(after, 1, axis=1) * (after.shape[1] > 1)
