"""A rank-1 lattice in radical-inverse order, shifted at random: low discrepancy for the price of a product.

    u_j(k) = frac(g_j phi(k) + s_j)

phi(k) is the radical inverse of the sample's number k (its bits in reverse, behind the point), g_j the odd
component of the generating vector for coordinate j, s_j the random shift of that coordinate in this pixel
(Cranley and Patterson 1976). In this order any 2^m samples from a multiple of 2^m on are a whole lattice
(Hickernell et al. 2000), so pixels may stop at any number. A number is uniform because its shift
is, whatever the lattice: nothing is biased.

The shifts are the numbers of `Independent` for sample 0. With `replicates` R there are R lattices, each
shifted by the numbers of its own sample r: sample k is point k // R of lattice k % R, which no number of
samples changes. The R means are independent, and their spread gives the error that the spread of samples
does not. With as many lattices as samples nothing is left but `Independent`.

All numbers of a path up to vertex DEPTHS are coordinates of one lattice. After that its components come
again, all multiplied by an odd number that is hashed anew for each DEPTHS vertices and pixel: a random
lattice beside the first. `python tests/lattice.py` finds the components, `python tests/samplers.py` is how
this sampler was chosen; what that measured is in ARCHITECTURE.md.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from tracer.lanes import gather
from tracer.sampler.numbers import USES, common, dimension, pcg4d, uniform

_FILM = (1, 774611)
_LENS = (694217, 742165)
# Vertex by vertex: light (which one, point), bsdf (lobe, direction), roulette.
_VERTICES = (
    (706459, 242979, 50393, 156497, 308667, 938083, 598749),
    (852889, 963465, 696811, 758887, 472009, 684639, 676553),
    (758131, 411211, 37315, 644749, 102475, 255549, 287765),
    (144357, 398449, 295353, 857481, 189775, 242645, 221873),
    (750619, 54441, 366449, 26553, 862181, 700823, 398423),
    (197753, 271985, 49485, 402913, 213873, 844621, 951475),
    (329071, 332761, 869695, 21883, 500775, 726619, 361153),
    (1045651, 435875, 133103, 905619, 111249, 653191, 680569),
)
DEPTHS = len(_VERTICES)
_ALL = np.array(_VERTICES, np.uint32).T
COMPONENTS = {  # (k, DEPTHS) of each use
    "film": np.tile(np.array(_FILM, np.uint32)[:, None], DEPTHS),
    "lens": np.tile(np.array(_LENS, np.uint32)[:, None], DEPTHS),
    "light": _ALL[:3],
    "bsdf": _ALL[3:6],
    "roulette": _ALL[6:],
}


@dataclass(frozen=True)
class Lattice:
    """Uniform numbers in [0, 1) that are spread evenly over the samples of a pixel."""

    seed: int
    dtype: type = np.float32
    replicates: int = 1

    def __call__(self, pixel, sample, depth, use):
        """The numbers of one use, (k, N) with k = USES[use]; arguments as for Independent."""
        replicate, depth = np.zeros(1, np.uint32), common(depth)
        if self.replicates > 1:
            sample, replicate = np.divmod(sample, np.uint32(self.replicates))
        seed, point = np.full(1, self.seed, np.uint32), radical_inverse(sample)
        if depth.max(initial=0) >= DEPTHS:
            point = point * _multiplier(pixel, replicate, depth // DEPTHS, seed)
        shifts = pcg4d(pixel, replicate, dimension(depth, use), seed, USES[use])
        words = gather(COMPONENTS[use], depth % DEPTHS) * point
        for word, shift in zip(words, shifts, strict=True):
            word += shift
        return uniform(words, self.dtype)


def _multiplier(pixel, replicate, group, seed):
    """Odd numbers (N,), hashed for each group of DEPTHS vertices; 1 for the first."""
    # No use has a word as large as ~group: its depth would be beyond any max_depth.
    (hashed,) = pcg4d(pixel, replicate, ~group.astype(np.uint32), seed, 1)
    return np.where(group == 0, np.uint32(1), hashed | np.uint32(1))


def radical_inverse(number):
    """The bits of 32-bit numbers (N,) in reverse."""
    reverse = _reversed_halves()
    if number.max(initial=0) <= 0xFFFF:
        return gather(reverse, number)
    return gather(reverse, number & np.uint32(0xFFFF)) | (
        gather(reverse, number >> np.uint32(16)) >> np.uint32(16)
    )


@cache
def _reversed_halves():
    """The bits of every 16-bit number in reverse, in the upper half of a word."""
    number, found = np.arange(1 << 16, dtype=np.uint32), np.zeros(1 << 16, np.uint32)
    for bit in range(16):
        found |= ((number >> np.uint32(bit)) & np.uint32(1)) << np.uint32(31 - bit)
    return found
