"""What several mistakes at once may look like, guessed from how each looks alone. Only a render tells."""

import numpy as np

from tracer.doctor.picture.features import Features
from tracer.doctor.picture.fitting import WEIGHT, WORST, deviation, texture_deviation

_RIGHT = 1e-3  # cells darker than that are black


def guesses(picture, right, parts, singles, spp=None):
    """How far a picture's Features are from guesses at each of `parts` {ids: Looks} with one of `singles`
    {id: Looks} more: [(off, ids)], the nearest first.

    Effects are added, multiplied, or put together as light on light that is cut at 1. spp: as in fit.
    """
    found, names = {}, list(singles)
    for level in right.at if spp is None else (spp,):
        normal = right.near(level)
        alone = Features.stacked([singles[name].near(level) for name in names])
        for ids, looks in parts.items():
            off = _off(picture, normal, looks.near(level), alone)
            for name, value in zip(names, off.tolist(), strict=True):
                whole = tuple(sorted({*ids, name}, key=names.index))
                if len(whole) > len(ids):
                    found[whole] = min(value, found.get(whole, np.inf))
    return sorted((value, ids) for ids, value in found.items())


def _off(picture, normal, first, alone):
    """Sums (K,) of squared deviations, for the best of the guesses at what the first does with each of K."""
    r, a, b = normal.mean, first.mean, alone.mean
    ratio = np.where(r > _RIGHT, a * b / np.maximum(r, _RIGHT), a)
    screened = 1.0 - (1.0 - a) * (1.0 - b) / np.maximum(1.0 - r, _RIGHT)
    error = np.hypot(first.error, alone.error)
    apart = [
        _squares(deviation(picture.mean, picture.error, np.clip(mean, 0.0, 1.0), error))
        for mean in (ratio, a + b - r, screened)
    ]
    texture = np.clip(first.texture + alone.texture - normal.texture, 0.0, None)
    return np.min(apart, axis=0) + WEIGHT * _squares(texture_deviation(picture, texture))


def _squares(apart):
    return np.minimum(apart.reshape(apart.shape[0], -1) ** 2, WORST).sum(axis=1)
