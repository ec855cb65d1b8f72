"""A picture cut by pixels: all samples of some of them together, so that whoever traces a part can fold it.

A pixel's blocks are added in order, so sums of later blocks cannot be joined to sums of earlier ones bit for
bit; but a part that begins with a pixel's first sample is folded where it is traced, and what comes back is
one sum for each pixel, however many samples went into it.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from tracer import film
from tracer.engine import waves
from tracer.engine.memory import keep_freed
from tracer.integrator.wave import Wave


class Part(NamedTuple):
    """Samples of some pixels, which are numbered line by line."""

    number: int
    pixels: slice
    sample: int  # first of them
    samples: int  # of each pixel, in whole blocks of the film but for the last

    @property
    def paths(self):
        """Number of paths to trace."""
        return (self.pixels.stop - self.pixels.start) * self.samples


def whole(settings):
    """The whole picture as one Part."""
    return Part(0, slice(0, settings.width * settings.height), 0, settings.spp)


def cut(part, lanes):
    """Parts of about `lanes` paths each that make up a part, in the order of pixel and sample, numbered."""
    samples = part.samples
    if samples > lanes:
        samples = max(film.BLOCK, lanes // film.BLOCK * film.BLOCK)
    step, number, last = max(1, lanes // samples), 0, part.sample + part.samples
    for start in range(part.pixels.start, part.pixels.stop, step):
        for sample in range(part.sample, last, samples):
            pixels = slice(start, min(start + step, part.pixels.stop))
            yield Part(number, pixels, sample, min(samples, last - sample))
            number += 1


def wave(numbers, part, settings, steps):
    """The Wave of the part's samples of some pixels (P,)."""
    pixel = np.repeat(numbers, part.samples)
    sample = np.tile(np.arange(part.sample, part.sample + part.samples), numbers.size)
    return Wave(pixel % settings.width, pixel // settings.width, sample, settings, steps)


def folded(pixels, part, settings, radiance):
    """The part's samples (3, N) of a slice of pixels as the film wants them."""
    of_pixels = radiance.reshape(3, -1, part.samples)
    return [
        (pixels, film.block(of_pixels[:, :, s : s + film.BLOCK], part.sample + s, settings.parts))
        for s in range(0, part.samples, film.BLOCK)
    ]


def trace(scene, settings, steps, part):
    """The Result of a part that begins with its pixels' first sample, folded into a Film of its own."""
    keep_freed()
    begin = part.pixels.start
    sheet, rays, dropped = film.Film(part.pixels.stop - begin, settings.parts), 0, 0
    for piece in cut(part, waves.LANES):
        paths = wave(np.arange(piece.pixels.start, piece.pixels.stop), piece, settings, steps)
        deque(waves.events(scene, settings, paths), maxlen=0)
        here = slice(piece.pixels.start - begin, piece.pixels.stop - begin)
        for pixels, block in folded(here, piece, settings, paths.radiance):
            sheet.add(pixels, block)
        rays, dropped = rays + paths.rays, dropped + paths.dropped
    return waves.Result(part, sheet, rays, dropped)
