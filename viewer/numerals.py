"""Numbers as a person reads them: five significant digits, a dash for what does not apply; and colours."""

import math

import numpy as np

NOTHING = "–"
LUMINANCE = (0.2126, 0.7152, 0.0722)  # of red, green and blue (Rec. 709)


def short(value):
    """One number in at most five significant digits."""
    value = float(value)
    if math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    return f"{value:.5g}"


def several(values):
    """A vector or colour as its numbers, one space apart."""
    return "  ".join(short(v) for v in np.ravel(values))


def tex(value, digits=4):
    """One number for a formula."""
    value = float(value)
    if math.isnan(value):
        return r"\text{?}"
    if math.isinf(value):
        return r"\infty" if value > 0 else r"-\infty"
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    return rf"{mantissa} \times 10^{{{int(exponent)}}}" if exponent else mantissa


def srgb(linear):
    """Linear light as the screen wants it, 0..1 each."""
    c = np.clip(np.nan_to_num(np.asarray(linear, float)), 0.0, 1.0)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def css(linear):
    """Linear light as a CSS colour."""
    return "#" + "".join(f"{round(255 * v):02x}" for v in srgb(linear))


def luminance(rgb):
    """How bright a linear colour is to the eye."""
    return float(np.dot(np.asarray(rgb, float), LUMINANCE))


def near(recorded, right, share):
    """Whether every number is within a share of the largest right one, or is the right one (inf)."""
    with np.errstate(invalid="ignore"):  # inf - inf
        close = np.abs(recorded - right) <= share * np.abs(right).max()
    return bool((close | (recorded == right)).all())
