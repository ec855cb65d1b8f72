"""Two colours in turn."""

from dataclasses import dataclass, replace

import numpy as np

from tracer.texture.moved import moved


@dataclass(frozen=True)
class Checkerboard:
    """Mitsuba's `checkerboard`: four squares fill u, v from 0 to 1; color0 where both or neither pass 1/2."""

    color0: np.ndarray  # (3,)
    color1: np.ndarray  # (3,)
    to_uv: np.ndarray  # (2, 3)

    def mean(self):
        """Both colours cover the same area."""
        return 0.5 * (self.color0 + self.color1)

    def astype(self, dtype):
        """The same in another precision."""
        return replace(self, color0=self.color0.astype(dtype), color1=self.color1.astype(dtype))

    def at(self, uv):
        """The colour of the square that each point lies in, (3, N)."""
        u, v = moved(self.to_uv, uv)
        first = (u - np.floor(u) > 0.5) == (v - np.floor(v) > 0.5)
        return np.where(first, self.color0[:, None], self.color1[:, None])
