"""From paths to pixels."""

import numpy as np

from lessons.zoo.bug import Bug


def clamped(radiance):
    """White dots are cut off, and their light with them."""
    return np.minimum(radiance, 1.0).astype(radiance.dtype)


def curved(radiance):
    """Each sample is bent for the screen before the mean is taken."""
    return (np.maximum(radiance, 0.0) ** (1.0 / 2.2)).astype(radiance.dtype)


BUGS = (
    Bug(
        "F01",
        "Each sample clamped",
        "No white dots, and everything is too dark where rare paths bring the light.",
        "L = min(L, 1) per sample",
        "I14: a pixel is the mean of its samples",
        {"film": clamped},
    ),
    Bug(
        "F03",
        "Gamma before averaging",
        "The picture looks washed out, and its noise biases it.",
        "pow(L, 1/2.2) per sample",
        "I14: a pixel is the mean of its samples",
        {"film": curved},
    ),
)
