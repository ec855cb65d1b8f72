"""The same picture again: in other waves, on other processes, a pixel alone, in another precision."""

from functools import partial
from multiprocessing.connection import wait

import numpy as np
from cases import loaded
from precisions import SIDE, SPP, compared

import tracer
from figures.figure import Figure
from tracer import Settings, film
from tracer.engine import processes, waves
from tracer.integrator.steps import RIGHT

TITLE = "Reproducibility"
PIXELS = 4  # of each scene traced again
FLAT = ("cornell", "cornell_unit", "furnace")  # scenes of flat diffuse surfaces
OTHERS = "Falcor: tolerance 0.0"


def _settings(seed, side=SIDE, spp=18, **options):
    return Settings(width=side, height=side, spp=spp, seed=seed, **options)


def _in_waves(seed):
    """Pictures with waves of other sizes; the pixels that differ in any bit."""
    settings = _settings(seed)
    usual = tracer.render(loaded("cornell_unit"), settings).rgb
    job = partial(waves.trace, loaded("cornell_unit").at(settings), settings, RIGHT)
    parts = ([job(task) for task in waves.tasks(settings, lanes)] for lanes in (700, 5000))
    return {"differ": sum(_differ(usual, results) for results in parts)}


def _on_processes(seed):
    """The same on this process and another together."""
    settings = _settings(seed)
    usual = tracer.render(loaded("cornell_unit"), settings).rgb
    job = partial(waves.trace, loaded("cornell_unit").at(settings), settings, RIGHT)
    if not processes.started(2):
        wait(processes.crew(1).lines)  # until the other is there
    return {"differ": _differ(usual, processes.traced(job, waves.tasks(settings, 700), 2))}


def _differ(usual, results):
    """How many pixels are not those of the picture, bit for bit."""
    sheet = film.Film(SIDE * SIDE)
    for result in results:
        waves.collect(sheet, result)
    other = np.ascontiguousarray(sheet.mean().T).reshape(SIDE, SIDE, 3)
    return int((other.view(np.uint32) != usual.view(np.uint32)).any(axis=2).sum())


def _alone(seed):
    """Some pixels of every scene, traced again by themselves."""
    rng, differ = np.random.default_rng(seed), 0
    for name in tracer.built_in_scenes():
        settings = _settings(seed, 16)
        picture = tracer.render(loaded(name), settings)
        for x, y in rng.integers(0, 16, (PIXELS, 2)):
            record = tracer.inspect(loaded(name), settings, int(x), int(y))
            differ += record.value.tobytes() != picture.rgb[y, x].tobytes()
    return {"differ": differ}


def _none(sums, chunks):
    return str(sums["differ"]), sums["differ"] == 0


def _in_both_precisions(names):
    def measure(seed):
        found = {}
        for name in names:
            same, difference = compared(loaded(name), _settings(seed, spp=SPP))
            found[f"same {name}"], found[f"difference {name}"] = float(same), float(difference)
        return found

    return measure


def _judge_precisions(bar):
    return lambda sums, chunks: _precisions(sums, chunks, bar)


def _precisions(sums, chunks, bar):
    mean = {key: value / chunks for key, value in sums.items()}
    least, name = min((value, key[5:]) for key, value in mean.items() if key.startswith("same"))
    off, at = max((value, key[11:]) for key, value in mean.items() if key.startswith("difference"))
    text = f"{100 * least:.3f} % in {name}; pixels differ by {off:.1e} in {at}"
    return text, least > 0.999 and off < bar


def figures():
    """Bits that differ, and paths that differ between the precisions."""
    scenes = tuple(tracer.built_in_scenes())
    pixels, some = SIDE * SIDE, PIXELS * len(scenes)
    for key, what, chunks, n, measure in (
        ("waves", "pixels that change with the size of waves", 100, pixels, _in_waves),
        ("processes", "pixels that change with the number of processes", 100, pixels, _on_processes),
        ("alone", "pixels of all scenes that are others when traced alone", 20, some, _alone),
    ):
        yield Figure(key, what, "0", OTHERS, "float32", chunks, n, measure, _none)
    # Elsewhere a texel's border or a chain of curved mirrors may take any difference on.
    for key, where, names, bar in (
        ("same-paths-flat", "flat diffuse scenes", FLAT, 1e-5),
        ("same-paths", f"{len(scenes)} scenes", scenes, np.inf),
    ):
        yield Figure(
            key,
            f"least share of paths that both precisions take, {where}",
            "above 99.9 %" + ("; pixels of those within 1e-5 on average" if bar == 1e-5 else ""),
            "we know of none",
            "both",
            30,
            pixels * SPP * len(names),
            _in_both_precisions(names),
            _judge_precisions(bar),
        )
