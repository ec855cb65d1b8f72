"""What samplers share: what numbers are for, the hash, and words as numbers.

The hash is pcg4d (Jarzynski and Olano 2020). All is 32-bit unsigned multiply, add, xor and shift, so a GPU
gives the same integers.
"""

import numpy as np

# What numbers are used for, and how many each use takes. The order is part of the promise: it is hashed.
USES = {"film": 2, "lens": 2, "light": 3, "bsdf": 3, "roulette": 1}
_CODE = {use: np.uint32(code) for code, use in enumerate(USES)}

_MULTIPLIER = np.uint32(1664525)
_INCREMENT = np.uint32(1013904223)
_SIXTEEN = np.uint32(16)


def pcg4d(x, y, z, w, count=4):
    """Four 32-bit words, (N,) or (1,), x the longest, to the first `count` of four well-mixed ones (N,)."""
    x, y, z, w = (v * _MULTIPLIER for v in (x, y, z, w))
    for v in (x, y, z, w):
        v += _INCREMENT
    x = x + y * w
    y = y + z * x
    z = z + x * y
    w = w + y * z
    for v in (x, y, z, w):
        v ^= v >> _SIXTEEN
    x += y * w
    if count > 1:
        y += z * x
    if count > 2:
        z += x * y
    if count > 3:
        w += y * z
    return (x, y, z, w)[:count]


def pack_pixel(x, y):
    """Pixel coordinates below 65536 in one 32-bit word, the same whatever the width of the picture."""
    return (np.asarray(y).astype(np.uint32) << _SIXTEEN) | np.asarray(x).astype(np.uint32)


def common(depth):
    """depth (N,), or its one value (1,) where all lanes have it: what follows is then worked out once."""
    return depth[:1] if depth.size > 1 and (depth == depth[0]).all() else depth


def dimension(depth, use):
    """The word that stands for a use at a depth, shaped as depth."""
    return depth.astype(np.uint32) * np.uint32(len(USES)) + _CODE[use]


def uniform(words, dtype):
    """Words, each (N,), as numbers (k, N) in [0, 1)."""
    u = np.empty((len(words), words[0].size), dtype)
    if dtype == np.float32:  # 24 bits are what float32 holds without ever rounding up to 1
        for row, word in zip(u, words, strict=True):
            row[:] = word >> np.uint32(8)
        u *= np.float32(2.0**-24)
        return u
    for row, word in zip(u, words, strict=True):
        row[:] = word
    u *= 2.0**-32
    return u
