"""Do the error bars hold what they promise? The share of them that reach the truth."""

import math
from dataclasses import dataclass

import numpy as np

from tracer import tails
from tracer.testing.ztest import Estimate, plain_z


@dataclass(frozen=True)
class Calibration:
    """How many intervals held the truth."""

    inside: int
    intervals: int
    level: float  # what the intervals promise

    @property
    def share(self):
        """Share of the intervals that hold the truth."""
        return self.inside / max(self.intervals, 1)

    def band(self, alpha):
        """Lowest and highest share of independent intervals that chance explains, but for a chance alpha."""
        half = tails.normal_z(alpha) * math.sqrt(self.level * (1.0 - self.level) / max(self.intervals, 1))
        return self.level - half, self.level + half


def calibration(picture, truth, level=0.95):
    """Count the intervals mean +- t sqrt(variance) that hold the truth, pixel by pixel, channel by channel.

    t is Student's for the pixel's number of samples, or of replicates. truth: a number or (H, W, 3). Pixels
    without variance (one sample, or all samples alike) have no interval and are left out. Channels of one
    pixel share their paths: for a band of independent intervals count one channel (truth NaN leaves one out).
    """
    estimate = Estimate.of(picture)
    exact = Estimate.of(truth, estimate.mean.shape)
    with np.errstate(all="ignore"):
        noisy = (estimate.variance > 0.0) & np.isfinite(estimate.variance) & np.isfinite(exact.mean)
        z = plain_z(estimate, exact, noisy)
    inside = np.abs(z[noisy]) <= tails.normal_z(1.0 - level)
    return Calibration(int(inside.sum()), int(noisy.sum()), level)
