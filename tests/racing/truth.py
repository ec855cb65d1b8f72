"""What the error is measured against: the mean of long renders of both programs, kept piece by piece."""

import hashlib
from types import SimpleNamespace

import numpy as np

from tracer.testing import z_test
from tracer.testing.efficiency import Reference

FIRST_SEED = 1_000_000  # of the pieces; the race itself uses small ones


class LongRender:
    """Pieces of one program's long render: their mean, and how they scatter (Chan et al. 1983)."""

    def __init__(self, path, key):
        self.path, self.key = path, hashlib.sha256(key.encode()).hexdigest()
        self.pieces, self.mean, self.squares = 0, np.zeros(()), np.zeros(())
        if path.exists():
            with np.load(path) as kept:
                if str(kept["key"]) == self.key:
                    self.pieces, self.mean, self.squares = int(kept["pieces"]), kept["mean"], kept["squares"]

    def add(self, rgb):
        """One more piece, an independent picture (H, W, 3); kept at once."""
        self.pieces += 1
        away = rgb.astype(np.float64) - self.mean
        self.mean = self.mean + away / self.pieces
        self.squares = self.squares + away * (rgb - self.mean)
        beside = self.path.with_suffix(".partial.npz")
        np.savez(beside, key=self.key, pieces=self.pieces, mean=self.mean, squares=self.squares)
        beside.replace(self.path)

    @property
    def picture(self):
        """As z_test takes it: each piece counts as one sample."""
        variance = self.squares / (self.pieces - 1) / self.pieces
        samples = np.full(self.mean.shape[:2], self.pieces)
        return SimpleNamespace(rgb=self.mean, variance=variance, samples=samples)


def grow(render, contestant, pieces, spp, how, say):
    """Add the pieces that are missing."""
    for k in range(render.pieces, pieces):
        say(f"reference, {render.path.stem}: {k + 1} of {pieces}")
        render.add(contestant.render(spp, FIRST_SEED + k, **how).rgb)


def agreement(ours, theirs):
    """The z-test of two LongRenders."""
    return z_test(ours.picture, theirs.picture)


def reference(ours, theirs):
    """Both together, each with half the weight."""
    a, b = ours.picture, theirs.picture
    return Reference(0.5 * (a.rgb + b.rgb), 0.25 * (a.variance + b.variance), "long renders of both")
