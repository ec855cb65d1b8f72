"""What the pixels around say: errors of neighbours, biases of regions and of the whole."""

import math

import numpy as np

AROUND = 2  # a pixel's neighbours: up to so many pixels away
WIDE = 4  # the same for the map of local biases
SMALLEST = np.finfo(np.float64).tiny


def mean(values, where):
    return np.where(where, values, 0.0).sum(axis=(0, 1)) / np.maximum(where.sum(axis=(0, 1)), 1)


def box(values, reach):
    """Sums (H, W, 3) of values over squares of 2 reach + 1 pixels, in one order."""
    for axis in (0, 1):
        widths = [(reach, reach) if k == axis else (0, 0) for k in range(3)]
        padded, n = np.pad(values, widths), values.shape[axis]
        values = sum(np.take(padded, np.arange(k, k + n), axis) for k in range(2 * reach + 1))
    return values


def around(variance, noisy):
    """Mean variance of a pixel's noisy neighbours, without itself; of the whole picture where it has none."""

    values = np.where(noisy, variance, 0.0)
    count = box(noisy.astype(np.float64), AROUND) - noisy
    everywhere = mean(variance, noisy)
    # Sum less own, not sum of the others: rounding may leave a little less than nothing.
    local = np.maximum(box(values, AROUND) - values, 0.0) / np.maximum(count, 1.0)
    return np.maximum(np.where(count > 0.0, local, everywhere), 1e-12 * everywhere + SMALLEST)


def weighed_bias(difference, variance, weights, known):
    """Z (3,) = sum w d / sqrt(sum w^2 v), the mean difference so weighed, and 3 standard errors of it.

    For w = 1 / error this is sum z / sqrt(P); right for any w that the pixels' own errors do not decide.
    """
    used, whole = weights > 0.0, weights.sum(axis=(0, 1))
    total = np.where(used, weights * difference, 0.0).sum(axis=(0, 1))
    error = np.sqrt(np.where(used, weights * weights * variance, 0.0).sum(axis=(0, 1)))
    Z = np.where(error > 0.0, total / np.maximum(error, SMALLEST), 0.0)
    difference = np.where(whole > 0.0, total / np.maximum(whole, SMALLEST), mean(difference, known))
    return Z, difference, 3.0 * error / np.maximum(whole, SMALLEST)


def worst_region(difference, variance, weights, z, across=8):
    """The region of across x across that is furthest off, and its Z; by its mean z where nothing varies."""
    rows, columns = (np.array_split(np.arange(n), min(across, n)) for n in z.shape[:2])
    worst = ((0, 0, z.shape[1], z.shape[0]), 0.0)
    for row in rows:
        for column in columns:
            part = slice(row[0], row[-1] + 1), slice(column[0], column[-1] + 1)
            found, _, _ = weighed_bias(difference[part], variance[part], weights[part], weights[part] > 0.0)
            if not (weights[part] > 0.0).any():
                found = np.nan_to_num(z[part]).sum(axis=(0, 1)) / math.sqrt(row.size * column.size)
            found = float(found[np.argmax(np.abs(found))])
            if abs(found) > abs(worst[1]):
                worst = (int(column[0]), int(row[0]), int(column[-1]) + 1, int(row[-1]) + 1), found
    return worst


def local_Z(difference, variance, weights):
    """Z (H, W, 3) of the square around each pixel; 0 where nothing varies."""
    used = weights > 0.0
    total = box(np.where(used, weights * difference, 0.0), WIDE)
    error = np.sqrt(box(np.where(used, weights * weights * variance, 0.0), WIDE))
    return np.where(error > 0.0, total / np.maximum(error, SMALLEST), 0.0)
