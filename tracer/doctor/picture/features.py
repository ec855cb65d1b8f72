"""What of a picture can be compared with another one: means cut where a screen cuts, and how rough it is."""

from dataclasses import dataclass

import numpy as np

from tracer.light.sample import luminance

CELLS = 8  # along each side
CUT = 1.0  # where files of 8 bits end; a mean of what is cut there says little about rare bright samples
MOST = 100.0  # above it a few samples would decide
BLACK = 5e-5  # luminance: below the first step of 8 bits
SALT = 4.0  # times the median of its four neighbours, and LIFT
LIFT = 0.05
_MANY = 36  # pixels in a cell: from fewer their spread is known too badly
PARTS = 2  # along each side: texture needs more pixels than a mean
TEXTURE = ("rough_x", "rough_y", "salt", "black")


@dataclass(frozen=True)
class Features:
    """Numbers of a picture that do not depend on its size.

    mean, error: (8, 8, 3) of pixels cut at 1, and the standard error of the mean; bright: (8, 8, 3) of pixels
    cut at 100, NaN where the file cannot hold them; texture: (2, 2, 4), see TEXTURE: the median difference of
    neighbours over their mean, along and across, the shares of single bright pixels and of black ones;
    pixels: how many there are in all the pictures that went into it.
    """

    mean: np.ndarray
    error: np.ndarray
    bright: np.ndarray
    bright_error: np.ndarray
    texture: np.ndarray
    pixels: float

    @classmethod
    def of(cls, parts):
        """Features of the six parts, in the order in which they are given."""
        mean, error, bright, bright_error, texture, pixels = parts
        return cls(mean, error, bright, bright_error, texture, pixels)

    @classmethod
    def between(cls, a, b, share):
        """Part of the way from a to b."""
        return cls.of(
            np.asarray(x) * (1.0 - share) + np.asarray(y) * share for x, y in zip(a, b, strict=True)
        )

    @classmethod
    def stacked(cls, many):
        """Several as one, with an axis more in front."""
        return cls.of(np.stack(values) for values in zip(*many, strict=True))

    def __iter__(self):
        return iter((self.mean, self.error, self.bright, self.bright_error, self.texture, self.pixels))


def features(rgb, eight_bits=False):
    """The Features of a picture (H, W, 3), linear. eight_bits: whether it ends at 1."""
    finite = np.isfinite(rgb).all(axis=2)
    known = np.where(finite[..., None], rgb, 0.0).astype(np.float64)
    cut, high = np.clip(known, 0.0, CUT), np.clip(known, 0.0, MOST)
    mean, error = _cells(cut, finite)
    bright, bright_error = _cells(high, finite)
    if eight_bits:
        bright, bright_error = np.full_like(bright, np.nan), np.full_like(bright, np.nan)
    return Features(mean, error, bright, bright_error, _texture(cut, finite), float(finite.sum()))


def resampled(values, height, width):
    """Means of a picture (H, W, ...) over height x width equal rectangles."""
    for axis, n in ((0, height), (1, width)):
        values = np.moveaxis(values, axis, 0)
        sums = np.concatenate((np.zeros_like(values[:1]), np.cumsum(values, axis=0)))
        place = np.linspace(0.0, len(values), n + 1)
        whole = np.minimum(place.astype(int), len(values) - 1)
        part = (place - whole).reshape(-1, *[1] * (values.ndim - 1))
        at = sums[whole] + part * values[whole]
        values = np.moveaxis(np.diff(at, axis=0) * (n / len(values)), 0, axis)
    return values


def _cells(values, finite):
    """Means of the cells and their standard errors, from how far neighbours differ."""
    count = resampled(finite.astype(np.float64)[..., None], CELLS, CELLS)
    mean = resampled(values, CELLS, CELLS) / np.maximum(count, 1e-9)
    total, pairs = np.zeros_like(values), np.zeros(finite.shape)
    for axis in (0, 1):
        first, second = _pair(axis)
        both = finite[first] & finite[second]
        total[first] += np.where(both[..., None], (values[first] - values[second]) ** 2, 0.0)
        pairs[first] += both
    pairs = np.maximum(resampled(pairs[..., None], CELLS, CELLS), 1e-9)
    variance = 0.5 * resampled(total, CELLS, CELLS) / pairs
    pixels = np.maximum(count * finite.size / CELLS**2, 1.0)
    if finite.size < _MANY * CELLS**2:
        variance = 0.5 * (variance + _smoothed(variance))
    return mean, np.sqrt(variance / pixels)


def _smoothed(cells):
    """Means over each cell and its neighbours."""
    around = np.pad(cells, ((1, 1), (1, 1), (0, 0)), mode="edge")
    return sum(around[y : y + CELLS, x : x + CELLS] for y in range(3) for x in range(3)) / 9.0


def _pair(axis):
    """Where a pixel and its next neighbour along an axis lie."""
    ahead = [slice(None), slice(None)]
    behind = [slice(None), slice(None)]
    behind[axis], ahead[axis] = slice(None, -1), slice(1, None)
    return tuple(behind), tuple(ahead)


def _texture(cut, finite):
    light = luminance(np.moveaxis(cut, 2, 0))
    quarters = []
    for rows in np.array_split(np.arange(light.shape[0]), PARTS):
        for columns in np.array_split(np.arange(light.shape[1]), PARTS):
            part = np.ix_(rows, columns)
            quarters.append(_of_part(light[part], finite[part]))
    return np.array(quarters).reshape(PARTS, PARTS, len(TEXTURE))


def _of_part(light, finite):
    rough = []
    for axis in (1, 0):
        first, second = _pair(axis)
        mean = 0.5 * (light[first] + light[second])
        used = finite[first] & finite[second] & (mean > 1e-3) & (mean < 0.98)
        rough.append(
            float(np.median(np.abs(light[first] - light[second])[used] / mean[used])) if used.any() else 0.0
        )
    inner = light[1:-1, 1:-1]
    around = [light[:-2, 1:-1], light[2:, 1:-1], light[1:-1, :-2], light[1:-1, 2:]]
    salt = inner > SALT * np.median(around, axis=0) + LIFT if inner.size else np.zeros(1)
    return (*rough, float(np.mean(salt)), float(np.mean(light[finite] < BLACK)) if finite.any() else 0.0)
