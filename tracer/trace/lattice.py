"""Which pixels have paths, where these are every so many columns and rows: logs of large pictures leave out
the others."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Lattice:
    """Pixels (first + k step, for k from 0 to count - 1) in x and in y; each is two whole numbers."""

    first: tuple
    step: tuple
    count: tuple

    def nearest(self, x, y):
        """The pixel of the lattice that is nearest to a pixel."""
        return tuple(int(self._along(axis, at)) for axis, at in enumerate((x, y)))

    def spread(self, values):
        """Values (H, W, ...) with those of the nearest pixel of the lattice everywhere."""
        height, width = values.shape[:2]
        return values[np.ix_(self._along(1, np.arange(height)), self._along(0, np.arange(width)))]

    def _along(self, axis, at):
        first, step, count = self.first[axis], self.step[axis], self.count[axis]
        return first + step * np.clip((at - first + step // 2) // step, 0, count - 1)


def lattice_of(trace):
    """The Lattice of a Trace's pixels; None where some columns and rows beside one another have paths, or but
    one has any."""
    found = []
    for name in "xy":
        there = np.unique(trace.paths[name])
        step = int(np.gcd.reduce(np.diff(there))) if there.size > 1 else 0
        if step < 2:
            return None
        found.append((int(there[0]), step, int(there[-1] - there[0]) // step + 1))
    return Lattice(*zip(*found, strict=True))
