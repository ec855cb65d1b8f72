"""Random numbers as a pure function of (seed, pixel, sample, depth, use): no state anywhere.

Any path can therefore be traced again, alone or in any company, and is the same path. The hash is pcg4d
(Jarzynski and Olano 2020): 32-bit unsigned multiply, add, xor and shift only, so a GPU gives the same
integers.
"""

from dataclasses import dataclass

import numpy as np

# What numbers are used for, and how many each use takes. The order is part of the promise: it is hashed.
USES = {"film": 2, "lens": 2, "light": 3, "bsdf": 3, "roulette": 1}
_CODE = {use: np.uint32(code) for code, use in enumerate(USES)}

_MULTIPLIER = np.uint32(1664525)
_INCREMENT = np.uint32(1013904223)
_SIXTEEN = np.uint32(16)


def pcg4d(x, y, z, w):
    """Four 32-bit words, each (N,) or scalar arrays, to four well-mixed ones."""
    x = x * _MULTIPLIER + _INCREMENT
    y = y * _MULTIPLIER + _INCREMENT
    z = z * _MULTIPLIER + _INCREMENT
    w = w * _MULTIPLIER + _INCREMENT
    x = x + y * w
    y = y + z * x
    z = z + x * y
    w = w + y * z
    x = x ^ (x >> _SIXTEEN)
    y = y ^ (y >> _SIXTEEN)
    z = z ^ (z >> _SIXTEEN)
    w = w ^ (w >> _SIXTEEN)
    x = x + y * w
    y = y + z * x
    z = z + x * y
    w = w + y * z
    return x, y, z, w


def pack_pixel(x, y):
    """Pixel coordinates below 65536 in one 32-bit word, the same whatever the width of the picture."""
    return (np.asarray(y).astype(np.uint32) << _SIXTEEN) | np.asarray(x).astype(np.uint32)


@dataclass(frozen=True)
class Independent:
    """Independent uniform numbers in [0, 1)."""

    seed: int
    dtype: type = np.float32

    def __call__(self, pixel, sample, depth, use):
        """The numbers of one use, (k, N) with k = USES[use].

        pixel: (N,) uint32 from pack_pixel; sample: (N,) uint32; depth: (N,) int, 0 before the first hit
        and at it.
        """
        dimension = depth.astype(np.uint32) * np.uint32(len(USES)) + _CODE[use]
        seed = np.full(1, self.seed, np.uint32)
        words = pcg4d(pixel, sample, dimension, seed)[: USES[use]]
        if self.dtype == np.float32:  # 24 bits are what float32 holds without ever rounding up to 1
            return np.stack([(word >> np.uint32(8)).astype(np.float32) for word in words]) * np.float32(
                2.0**-24
            )
        return np.stack([word.astype(np.float64) for word in words]) * 2.0**-32
