"""A picture cut into waves, and one wave traced.

Work goes block by block (16 samples of every pixel, then the next 16), so that a stopped render is a whole
picture with fewer samples. Waves end on block borders: that, and only that, ties them to the film's sums.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from tracer import film
from tracer.integrator import ALL as INTEGRATORS
from tracer.integrator.wave import Wave

# Paths in a wave: enough to hide Python's cost per call, few enough to keep most arrays in the cache.
LANES = 1 << 15


class Task(NamedTuple):
    """One block of samples of a row of pixels, numbered line by line."""

    start: int  # first pixel
    stop: int  # after the last
    sample: int  # first sample
    samples: int  # how many


class Result(NamedTuple):
    """What a task brings to the film."""

    task: Task
    block: film.Block
    rays: int
    dropped: int


def tasks(settings, lanes=LANES):
    """All tasks of a picture, block by block."""
    pixels = settings.width * settings.height
    for sample in range(0, settings.spp, film.BLOCK):
        samples = min(film.BLOCK, settings.spp - sample)
        step = max(1, lanes // samples)
        for start in range(0, pixels, step):
            yield Task(start, min(start + step, pixels), sample, samples)


def trace(scene, settings, steps, task):
    """Trace one task and fold its samples."""
    pixel = np.repeat(np.arange(task.start, task.stop), task.samples)
    sample = np.tile(np.arange(task.sample, task.sample + task.samples), task.stop - task.start)
    wave = Wave(pixel % settings.width, pixel // settings.width, sample, settings, steps)
    deque(events(scene, settings, wave), maxlen=0)
    block = film.block(wave.radiance.reshape(3, -1, task.samples))
    return Result(task, block, wave.rays, wave.dropped)


def events(scene, settings, wave):
    """The events of a wave by the integrator that the settings name; NumPy's warnings stay quiet in there,
    because infinities and NaN are looked for where they matter."""
    loop = INTEGRATORS[settings.integrator](scene.at(settings), settings, wave)
    while True:
        with np.errstate(all="ignore"):
            event = next(loop, None)
        if event is None:
            return
        yield event
