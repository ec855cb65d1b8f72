"""Which pixel of two compared pictures to look at first: one that differs as its surroundings do."""

import numpy as np

from viewer.diff import largest

AROUND = 2  # pixels to each side whose differences have to agree


def pixel(a, b, verdict, same_numbers):
    """(x, y) in pictures a and b, of which a Verdict was given. same_numbers: whether both were made from the
    same random numbers, so that what differs is no noise."""
    if not same_numbers:
        z = verdict.z
        everywhere = z is not None and z.p_bias < z.alpha
        return (z.centre if everywhere else verdict.worst)[:2]
    return _systematic(a, b) or verdict.errors.worst[:2]


def _systematic(a, b):
    """Where a - b is largest both in the pixel and, by the median, around it; None where it is so nowhere.

    A single path that happens to meet a lamp makes the largest difference and the rarest: along a lamp's
    edge there is a line of them. The median does not see a line.
    """
    with np.errstate(invalid="ignore"):
        apart = largest(np.asarray(a.rgb, np.float64) - b.rgb)
    wide = np.pad(apart, AROUND, mode="reflect" if min(apart.shape) > AROUND else "edge")
    square = (2 * AROUND + 1,) * 2
    usual = np.median(np.lib.stride_tricks.sliding_window_view(wide, square), axis=(-2, -1))
    common = np.where(usual * apart > 0.0, np.minimum(np.abs(usual), np.abs(apart)), 0.0)
    y, x = np.unravel_index(np.argmax(common), common.shape)
    return (int(x), int(y)) if common[y, x] > 0.0 else None
