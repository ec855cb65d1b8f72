"""A picture of somebody's tracer, and the ways in which it may be meant."""

from dataclasses import dataclass

import numpy as np

from tracer.picture import from_srgb, read
from tracer.picture.turns import TURNS
from tracer.settings import TracerError

SRGB, GAMMA, NONE = (
    "srgb",
    0.6,
    1.0,
)  # the curves of files of 8 bits: the usual, the homework's, a forgotten one
STRETCHED, CUT = "stretched", "middle"
_SAME_SHAPE = 0.02  # relative, of width / height


@dataclass(frozen=True)
class Reading:
    """A linear picture (H, W, 3), read in one way.

    eight_bits: whether it ends at 1. curve: "srgb", or the exponent that light was raised to; None of files
    that are linear. turn: how it was the wrong way round, None if it was not. shape: what was done to one
    that has not the scene's shape, None if it has.
    """

    rgb: np.ndarray
    eight_bits: bool
    curve: object = None
    turn: str | None = None
    shape: str | None = None


def opened(path, gamma=None):
    """The numbers in a picture's file as they stand there, whether they are of 8 bits, and the curves that
    they may have, the likeliest first. gamma: the curve's exponent, None if it was not said. Raises
    TracerError.
    """
    if gamma is not None and not 0.05 <= gamma <= 20.0:
        raise TracerError(f"gamma: {gamma} is not an exponent from 0.05 to 20; the homework's is 0.6")
    stored = read(path, np.float64, raw=True)
    if min(stored.rgb.shape[:2]) < 8:
        height, width = stored.rgb.shape[:2]
        raise TracerError(f"{path}: {width} x {height} pixels are too few to be compared; at least 8 x 8")
    if not np.isfinite(stored.rgb).all(axis=2).any():
        raise TracerError(f"{path}: no pixel of it is a finite number")
    if gamma is not None:
        return stored.rgb, stored.eight_bits, (gamma,)
    return stored.rgb, stored.eight_bits, (SRGB, GAMMA, NONE) if stored.eight_bits else (None,)


def linear(values, curve):
    """Light that such a curve made these values of."""
    if curve is None or curve == NONE:
        return values
    if curve == SRGB:
        return from_srgb(values)
    return np.maximum(values, 0.0) ** (1.0 / curve)


def plain(values, eight_bits, curve, aspect):
    """The Reading of a picture as it is; aspect: width over height of the scene's picture."""
    odd = abs(values.shape[1] / values.shape[0] / aspect - 1.0) > _SAME_SHAPE
    return Reading(linear(values, curve), eight_bits, curve, None, STRETCHED if odd else None)


def others(values, eight_bits, curves, aspect):
    """Yield the other ways to read it: by other curves, turned, and its middle alone."""
    for curve in curves:
        for turn in (None, *TURNS):
            for shape in (STRETCHED, CUT):
                some = values if shape == STRETCHED else _middle(values, aspect)
                reading = plain(some, eight_bits, curve, aspect)
                if shape == CUT and some.shape == values.shape:
                    continue
                rgb = reading.rgb if turn is None else TURNS[turn](reading.rgb)
                yield Reading(rgb, eight_bits, curve, turn, CUT if shape == CUT else reading.shape)


def _middle(values, aspect):
    """The middle of a picture that is too wide or too high."""
    height, width = values.shape[:2]
    wide, high = min(width, max(8, round(height * aspect))), min(height, max(8, round(width / aspect)))
    x, y = (width - wide) // 2, (height - high) // 2
    return values[y : y + high, x : x + wide]
