"""One picture against another, pixel by pixel, as what is laid over the picture."""

import numpy as np

from tracer.picture import to_srgb
from viewer import overlay
from viewer.diff import largest

SURE = 5.0  # standard errors at which the colours are full
MOST_RATIO, LEAST_RATIO = 16.0, 1.25  # at the ends of the scale of ratios
VIEWS = ("difference", "ratio", "z")


def possible(verdict):
    """The views that a Verdict has numbers for."""
    return VIEWS if verdict.z is not None else VIEWS[:-1]


def view(name, a, b, verdict):
    """The Overlay of a view of two pictures, of the channel that is furthest off."""
    if name == "z":
        return overlay.signed("compare", "compare.map_z", _furthest(verdict.z.z), most=SURE)
    one, other = (_numbers(picture, verdict) for picture in (a, b))
    if name == "difference":
        with np.errstate(invalid="ignore"):
            return overlay.signed("compare", "compare.map_difference", _furthest(one - other))
    return _ratio(one, other)


def _numbers(picture, verdict):
    """A picture's numbers in the unit in which both are compared."""
    rgb = to_srgb(picture.rgb) / 255.0 if verdict.errors.unit == "sRGB" else picture.rgb
    samples = getattr(picture, "samples", None)
    there = True if samples is None else (samples > 0)[..., None]  # a log may leave out pixels
    return np.where(there, np.asarray(rgb, np.float64), np.nan)


def _furthest(difference):
    """Of three channels (H, W, 3) the number furthest from 0; NaN where none is known."""
    return np.where(np.isfinite(difference).any(axis=2), largest(difference), np.nan)


def _ratio(one, other):
    """a / b of the channel in which they are furthest apart, on a scale that is even in the logarithm."""
    with np.errstate(all="ignore"):
        logs = np.log(one) - np.log(other)
    logs = np.where(np.isfinite(logs), logs, 0.0)
    ratio = np.exp(largest(logs))
    either = ((one > 0.0) & (other > 0.0)).any(axis=2)
    ratio = np.where(either, ratio, np.nan)
    apart = np.exp(np.abs(np.log(ratio[either])))
    reach = float(np.clip(np.quantile(apart, 0.995) if apart.size else 0.0, LEAST_RATIO, MOST_RATIO))
    return overlay.Overlay(
        "compare", "compare.map_ratio", ratio.astype(np.float32), "difference", 1.0 / reach, reach, log=True
    )
