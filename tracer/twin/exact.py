"""Sums of floating point numbers without any rounding, so that the parts of a sum add up to it."""

from fractions import Fraction

import numpy as np

_MOST = 1 << 25  # numbers summed at once: so many halves of 27 bits each are whole numbers a float64 holds
_EXPONENTS = 1 << 12
_BIAS = 1 << 11


def exact_sums(cell, values, cells):
    """Fractions (cells,): the exact sums of finite values (N,) by the number of their cell (N,)."""
    totals = [Fraction(0)] * cells
    there = np.flatnonzero(values)
    for begin in range(0, there.size, _MOST):
        some = there[begin : begin + _MOST]
        mantissa, exponent = np.frexp(values[some].astype(np.float64))
        high = np.trunc(mantissa * 2.0**26)
        low = (mantissa * 2.0**26 - high) * 2.0**27
        keys, group = np.unique(
            cell[some].astype(np.int64) * _EXPONENTS + exponent + _BIAS, return_inverse=True
        )
        parts = (np.bincount(group, part, keys.size) for part in (high, low))
        for key, more, less in zip(keys.tolist(), *(part.tolist() for part in parts), strict=True):
            where, power = divmod(key, _EXPONENTS)
            scale = Fraction(2) ** (power - _BIAS - 53)
            totals[where] += ((int(more) << 27) + int(less)) * scale
    return totals


def exact_colours(cell, values, cells):
    """The same of colours (3, N), a list of (red, green, blue)."""
    return list(zip(*(exact_sums(cell, channel, cells) for channel in values), strict=True))
