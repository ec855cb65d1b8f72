"""From samples to pixels, in one defined order, so that every way of adding them up gives the same bits.

A pixel is its samples added in float64 in blocks of 16 samples, the blocks added in order, divided by their
number, and rounded to float32 once. Beside the sum goes the spread: the squared distances of the samples from
their mean, each block's about its own mean, blocks joined in the same order (Chan et al. 1983). It never
subtracts two squares, so nothing cancels where samples are bright and alike.
"""

from typing import NamedTuple

import numpy as np

BLOCK = 16


class Block(NamedTuple):
    """Up to 16 samples of each of P pixels, added up."""

    total: np.ndarray  # (3, P) float64 sum
    spread: np.ndarray  # (3, P) float64 sum of squared distances from the block's mean
    samples: int


def block(radiance):
    """The Block of samples (3, P, S), S up to 16, added in order."""
    total = np.zeros(radiance.shape[:2])
    for s in range(radiance.shape[2]):
        total = total + radiance[:, :, s]
    mean, spread = total / radiance.shape[2], np.zeros(total.shape)
    with np.errstate(over="ignore", invalid="ignore"):  # squares of what only just fits
        for s in range(radiance.shape[2]):
            distance = radiance[:, :, s] - mean
            spread += distance * distance
    return Block(total, spread, radiance.shape[2])


def gather(radiance):
    """The Film of one pixel with samples (3, n), in order of sample number."""
    film = Film(1)
    for start in range(0, radiance.shape[1], BLOCK):
        film.add(slice(0, 1), block(radiance[:, None, start : start + BLOCK]))
    return film


def fold(radiance):
    """The pixel (3,) float32 that samples (3, n), in order of sample number, add up to."""
    return gather(radiance).mean()[:, 0]


class Film:
    """Sums of samples for a row of pixels; blocks of one pixel must be added in order."""

    def __init__(self, pixels):
        self.total = np.zeros((3, pixels))
        self.spread = np.zeros((3, pixels))
        self.samples = np.zeros(pixels, np.int64)

    def add(self, where, part):
        """Add one Block to a slice of pixels."""
        before = self.samples[where]
        with np.errstate(over="ignore", invalid="ignore"):
            # (Chan et al. 1983): joined, two groups also spread by the distance of their means.
            apart = part.total / part.samples - self.total[:, where] / np.maximum(before, 1)
            share = before * (part.samples / (before + part.samples))
            self.spread[:, where] += part.spread + share * (apart * apart)
        self.total[:, where] = self.total[:, where] + part.total
        self.samples[where] += part.samples

    def mean(self):
        """Every pixel's mean (3, P) as float32; 0 where nothing was added."""
        return (self.total / np.maximum(self.samples, 1)).astype(np.float32)

    def variance(self):
        """Variance (3, P) float32 of every pixel's mean: that of its samples over their number n.

        spread / (n - 1) / n; NaN, not known, where n < 2. Above 0 it stays above 0 in float32.
        """
        free = np.where(self.samples > 1, self.samples * (self.samples - 1.0), np.nan)
        with np.errstate(over="ignore", under="ignore"):
            exact = self.spread / free
            rounded = exact.astype(np.float32)
        rounded[(rounded == 0.0) & (exact > 0.0)] = np.finfo(np.float32).tiny
        return rounded
