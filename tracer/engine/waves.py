"""A picture cut into waves, and one wave traced.

Work goes block by block (16 samples of every pixel, then the next 16), so that a stopped render is a whole
picture with fewer samples. Waves end on block borders: that, and only that, ties them to the film's sums.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from tracer import film
from tracer.engine.memory import keep_freed
from tracer.integrator import ALL as INTEGRATORS
from tracer.integrator.wave import Wave

# Paths in a wave: enough to hide what a call costs in Python. What leaves the cache for it weighs less.
LANES = 1 << 17


class Task(NamedTuple):
    """Blocks of samples of some pixels, which are numbered line by line."""

    pixels: slice | np.ndarray  # from start to before stop, or (P,) numbers
    sample: int | np.ndarray  # first sample of each block, or (P,) first samples
    samples: int  # how many in a block, up to film.BLOCK

    @property
    def numbers(self):
        """Numbers (P,) of the pixels."""
        if isinstance(self.pixels, slice):
            return np.arange(self.pixels.start, self.pixels.stop)
        return self.pixels

    @property
    def paths(self):
        """Number of paths to trace."""
        return self.numbers.size * self.samples


class Result(NamedTuple):
    """What a task brings to the film."""

    task: Task
    block: film.Block | film.Film  # of a task that is a Part, all its sums
    rays: int
    dropped: int


def tasks(settings, lanes=None):
    """All tasks of a picture with the same number of samples everywhere, block by block."""
    pixels, lanes = settings.width * settings.height, lanes or LANES
    for sample in range(0, settings.spp, film.BLOCK):
        samples = min(film.BLOCK, settings.spp - sample)
        step = max(1, lanes // samples)
        for start in range(0, pixels, step):
            yield Task(slice(start, min(start + step, pixels)), sample, samples)


def rows(pixels, sample):
    """Tasks for whole blocks: of pixels (P,), from sample numbers (P,) on. A pixel's blocks come in order."""
    step = max(1, LANES // film.BLOCK)
    for start in range(0, pixels.size, step):
        yield Task(pixels[start : start + step], sample[start : start + step], film.BLOCK)


def trace(scene, settings, steps, task):
    """Trace one task and fold its samples."""
    keep_freed()
    numbers = task.numbers
    pixel = np.repeat(numbers, task.samples)
    first = np.broadcast_to(task.sample, numbers.shape)
    sample = (first[:, None] + np.arange(task.samples)).ravel()
    wave = Wave(pixel % settings.width, pixel // settings.width, sample, settings, steps)
    deque(events(scene, settings, wave), maxlen=0)
    block = film.block(wave.radiance.reshape(3, -1, task.samples), task.sample, settings.parts)
    return Result(task, block, wave.rays, wave.dropped)


def collect(sheet, result):
    """Add a result to the film."""
    if isinstance(result.block, film.Film):
        sheet.put(result.task.pixels, result.block)
        return
    pixels, sample, _ = result.task
    if np.ndim(sample) == 0:
        sheet.add(pixels, result.block)
        return
    for first in np.unique(sample):  # several blocks of one pixel are added one after the other
        here = sample == first
        sheet.add(pixels[here], result.block.take(here))


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
