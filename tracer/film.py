"""From samples to pixels, in one defined order, so that every way of adding them up gives the same bits.

A pixel is its samples added in float64 in blocks of 16 samples, the blocks added in order, divided by their
number, and rounded to float32 once. Beside the sum goes the spread: the squared distances of the samples from
their mean, each block's about its own mean, blocks joined in the same order (Chan et al. 1983). It never
subtracts two squares, so nothing cancels where samples are bright and alike.

The spread gives the error of the mean where samples are independent. Those of a low-discrepancy sampler are
not: there a pixel has `replicates` independent parts, sample k in part k mod replicates, and the error comes
from the means of the parts. One part alone says nothing of its error.
"""

from typing import NamedTuple

import numpy as np

BLOCK = 16


class Block(NamedTuple):
    """Up to 16 samples of each of P pixels, added up."""

    total: np.ndarray  # (3, P) float64 sum
    spread: np.ndarray  # (3, P) float64 sum of squared distances from the block's mean
    samples: int
    parts: np.ndarray | None = None  # (replicates, 3, P) float64 sum of each part

    def take(self, pixels):
        """The Block of some of the pixels."""
        parts = None if self.parts is None else self.parts[..., pixels]
        return Block(self.total[:, pixels], self.spread[:, pixels], self.samples, parts)


def block(radiance, first=0, replicates=None):
    """The Block of samples (3, P, S), S up to 16, added in order.

    first: number of the first sample, or (P,) of each pixel's. replicates: independent parts of a pixel; None
    where samples are independent.
    """
    total = np.zeros(radiance.shape[:2])
    for s in range(radiance.shape[2]):
        total = total + radiance[:, :, s]
    mean, spread = total / radiance.shape[2], np.zeros(total.shape)
    with np.errstate(over="ignore", invalid="ignore"):  # squares of what only just fits
        for s in range(radiance.shape[2]):
            distance = radiance[:, :, s] - mean
            spread += distance * distance
    parts = None
    if replicates is not None and replicates > 1:
        parts = _parts(radiance, np.broadcast_to(first, radiance.shape[1:2]) % replicates, replicates)
    return Block(total, spread, radiance.shape[2], parts)


def _parts(radiance, first, replicates):
    """Sums (replicates, 3, P) of samples (3, P, S), of which the pixel's first is of part `first` (P,)."""
    parts = np.zeros((replicates, *radiance.shape[:2]))
    for start in np.unique(first):
        pixels = np.flatnonzero(first == start)
        for s in range(radiance.shape[2]):
            parts[(start + s) % replicates][:, pixels] += radiance[:, pixels, s]
    return parts


def gather(radiance, replicates=None):
    """The Film of one pixel with samples (3, n), in order of sample number."""
    film = Film(1, replicates)
    for start in range(0, radiance.shape[1], BLOCK):
        film.add(slice(0, 1), block(radiance[:, None, start : start + BLOCK], start, replicates))
    return film


def fold(radiance):
    """The pixel (3,) float32 that samples (3, n), in order of sample number, add up to."""
    return gather(radiance).mean()[:, 0]


class Film:
    """Sums of samples for a row of pixels; blocks of one pixel must be added in order.

    replicates: independent parts of a pixel; None where its samples are independent.
    """

    def __init__(self, pixels, replicates=None):
        self.total = np.zeros((3, pixels))
        self.spread = np.zeros((3, pixels))
        self.samples = np.zeros(pixels, np.int64)
        self.replicates = replicates
        self.parts = np.zeros((replicates, 3, pixels)) if replicates and replicates > 1 else None

    def add(self, where, part):
        """Add one Block to a slice of pixels."""
        before = self.samples[where]
        with np.errstate(over="ignore", invalid="ignore"):
            # (Chan et al. 1983): joined, two groups also spread by the distance of their means.
            apart = part.total / part.samples - self.total[:, where] / np.maximum(before, 1)
            share = before * (part.samples / (before + part.samples))
            self.spread[:, where] += part.spread + share * (apart * apart)
        self.total[:, where] = self.total[:, where] + part.total
        if self.parts is not None:
            self.parts[..., where] += part.parts
        self.samples[where] += part.samples

    def put(self, where, sheet):
        """Put in the Film of a slice of pixels of which nothing was added yet."""
        self.total[:, where], self.spread[:, where] = sheet.total, sheet.spread
        self.samples[where] = sheet.samples
        if self.parts is not None:
            self.parts[..., where] = sheet.parts

    def mean(self):
        """Every pixel's mean (3, P) as float32; 0 where nothing was added."""
        return (self.total / np.maximum(self.samples, 1)).astype(np.float32)

    def variance(self):
        """Variance (3, P) float32 of every pixel's mean; NaN where it is not known.

        Of independent samples spread / (n - 1) / n, not known for n < 2. Of R independent parts, each with a
        share w of the samples, R / (R - 1) sum w^2 (mean of the part - mean)^2, not known for R < 2. Above 0
        it stays above 0 in float32.
        """
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):
            if self.replicates is None:
                free = np.where(self.samples > 1, self.samples * (self.samples - 1.0), np.nan)
                exact = self.spread / free
            elif self.parts is None:
                exact = np.full(self.spread.shape, np.nan)
            else:
                exact = self._variance_of_parts()
            rounded = exact.astype(np.float32)
        rounded[(rounded == 0.0) & (exact > 0.0)] = np.finfo(np.float32).tiny
        return rounded

    def _variance_of_parts(self):
        n, r = self.samples, np.arange(self.replicates)[:, None, None]
        size = n // self.replicates + (r < n % self.replicates)
        mean, whole = self.total / np.maximum(n, 1), np.minimum(n, self.replicates)
        apart = (self.parts - size * mean) / np.maximum(n, 1)
        return (apart * apart).sum(axis=0) * (whole / np.where(whole > 1, whole - 1.0, np.nan))

    def sample_variance(self):
        """Variance (3, P) float64 of single samples about their pixel's mean, independent or not; NaN, not
        known, where n < 2."""
        return self.spread / np.where(self.samples > 1, self.samples - 1.0, np.nan)
