"""How far two pictures' Features are apart, in units of their noise and of what harmless differences do."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tracer.doctor.picture.features import Features

# What other renderers, curves and sizes may do to a mean without being wrong.
RELATIVE, ABSOLUTE = 0.03, 0.004
ROUGH = 0.2  # relative, of a texture: it depends on the size of the picture, too
SHARE = 0.005  # absolute, of shares of pixels
SPECK = 0.25  # relative, of shares of pixels
WEIGHT = 2  # of a texture: few numbers beside many means
WORST = 16.0  # squared deviations count no more: one odd cell does not decide
BRIGHT = 1.0  # cells above it are compared by what files of 8 bits do not hold


@dataclass(frozen=True)
class Fit:
    """How far a picture is from what a tracer would give.

    off: sum of squared deviations, each at most 16, and count of them; spp: samples per pixel at which it
    fits best.
    """

    off: float
    count: int
    spp: float

    @property
    def typical(self):
        """Mean squared deviation: about 1 or less where it fits."""
        return self.off / max(self.count, 1)


@dataclass(frozen=True)
class Looks:
    """What the pictures of one tracer look like: Features by samples per pixel."""

    at: dict

    @cached_property
    def levels(self):
        """Pairs of samples per pixel and Features, with those in between as well."""
        known = sorted(self.at)
        found = [(float(known[0]), self.at[known[0]])]
        for low, high in zip(known, known[1:], strict=False):
            found.append(((low * high) ** 0.5, Features.between(self.at[low], self.at[high], 0.5)))
            found.append((float(high), self.at[high]))
        return found

    def near(self, spp):
        """Features at about that many samples."""
        return min(self.levels, key=lambda level: abs(np.log(level[0] / spp)))[1]


def fit(picture, looks, spp=None, cells=None):
    """The Fit of a picture's Features to the Looks of a tracer.

    spp: samples per pixel of the picture, if known. cells: (8, 8) bool, those to compare.
    """
    return fits(picture, {"": looks}, spp, cells)[""]


def fits(picture, many, spp=None, cells=None):
    """The Fit to each of {name: Looks}, as fit gives it."""
    found = {}
    levels = {name: looks.levels if spp is None else [(spp, looks.near(spp))] for name, looks in many.items()}
    known = Features.stacked([seen for each in levels.values() for _, seen in each])
    off, count = misfit(picture, known, cells)
    place = 0
    for name, each in levels.items():
        k = place + int(np.argmin(off[place : place + len(each)]))
        found[name] = Fit(float(off[k]), int(count[k]), each[k - place][0])
        place += len(each)
    return found


def misfit(picture, known, cells=None):
    """Sums and counts of squared deviations of a picture's Features from known ones, which may be stacked."""
    parts = [(apart, 1) for apart in _means(picture, known, cells)]
    parts.append((texture_deviation(picture, known.texture), WEIGHT))
    inner = (-3, -2, -1)
    off = sum(weight * np.nansum(np.minimum(apart**2, WORST), axis=inner) for apart, weight in parts)
    return off, sum(weight * np.isfinite(apart).sum(axis=inner) for apart, weight in parts)


def _means(picture, known, cells):
    here = True if cells is None else cells[..., None]
    apart = deviation(picture.mean, picture.error, known.mean, known.error)
    yield np.where(here, apart, np.nan)
    if np.isfinite(picture.bright).any():
        bright = np.maximum(picture.bright, known.bright) > BRIGHT
        apart = deviation(picture.bright, picture.bright_error, known.bright, known.bright_error)
        yield np.where(bright & here, apart, np.nan)


def deviation(a, error_a, b, error_b):
    """Means apart, in units of their noise and of what harmless differences do."""
    allowed = np.sqrt(error_a**2 + error_b**2 + (0.5 * RELATIVE * (a + b)) ** 2 + ABSOLUTE**2)
    return (a - b) / allowed


def texture_deviation(picture, known):
    """How far the texture of a picture's Features is from known ones (..., 2, 2, 4), in units of its own
    chance and of what harmless differences do."""
    a, pixels = picture.texture, picture.pixels / picture.texture[..., 0].size
    middle = 0.5 * (a + known)
    rough = ((ROUGH + 1.0 / np.sqrt(pixels)) * middle + SHARE)[..., :2]
    shares = (SPECK * middle + SHARE + np.sqrt(middle / pixels))[..., 2:]
    return (a - known) / np.concatenate((rough, shares), axis=-1)
