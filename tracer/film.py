"""From samples to pixels, in one defined order, so that every way of adding them up gives the same bits.

A pixel is its samples added in float64 in blocks of 16 samples, the blocks added in order, divided by their
number, and rounded to float32 once.
"""

import numpy as np

BLOCK = 16


def block_sum(radiance):
    """Samples (3, P, S) of one block, S up to 16, added in order in float64: (3, P)."""
    total = np.zeros(radiance.shape[:2])
    for s in range(radiance.shape[2]):
        total = total + radiance[:, :, s]
    return total


def fold(radiance):
    """The pixel (3,) float32 that samples (3, n), in order of sample number, add up to."""
    film = Film(1)
    for start in range(0, radiance.shape[1], BLOCK):
        block = radiance[:, None, start : start + BLOCK]
        film.add(slice(0, 1), block_sum(block), block.shape[2])
    return film.mean()[:, 0]


class Film:
    """Sums of samples for a row of pixels; blocks of one pixel must be added in order."""

    def __init__(self, pixels):
        self.total = np.zeros((3, pixels))
        self.samples = np.zeros(pixels, np.int64)

    def add(self, where, total, samples):
        """Add one block's sum (3, P) of `samples` samples a pixel to a slice of pixels."""
        self.total[:, where] = self.total[:, where] + total
        self.samples[where] += samples

    def mean(self):
        """Every pixel's mean (3, P) as float32; 0 where nothing was added."""
        return (self.total / np.maximum(self.samples, 1)).astype(np.float32)
