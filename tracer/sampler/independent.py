"""Independent uniform numbers: every one is hashed for itself."""

from dataclasses import dataclass

import numpy as np

from tracer.sampler.numbers import USES, common, dimension, pcg4d, uniform


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
        seed = np.full(1, self.seed, np.uint32)
        words = pcg4d(pixel, sample, dimension(common(depth), use), seed, USES[use])
        return uniform(words, self.dtype)
