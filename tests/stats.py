"""Statistics of the tests: what a test may conclude from random numbers, and how sure it is."""

import numpy as np
from scipy import stats

ALPHA = 0.01  # chance that a family of tests fails though all is right; Sidak shares it out among them
FEWEST = 5.0  # a chi-square cell expects at least so many


def sidak(tests, alpha=ALPHA):
    """Significance of each of `tests` tests so that all together fail by chance with probability alpha."""
    return 1.0 - (1.0 - alpha) ** (1.0 / tests)


def z_limit(tests, alpha=ALPHA):
    """How many standard errors a family of two-sided tests may be off."""
    return stats.norm.isf(0.5 * sidak(tests, alpha))


def chi_square(counts, expected):
    """p-value of counts against what is expected; small cells are put together.

    A count where nothing at all is expected gives 0.
    """
    counts, expected = np.ravel(counts).astype(float), np.ravel(expected).astype(float)
    if counts[expected <= 0.0].any():
        return 0.0
    order = np.argsort(expected)
    counts, expected = counts[order], expected[order]
    small = np.count_nonzero(expected < FEWEST)
    if small:
        counts = np.concatenate(([counts[:small].sum()], counts[small:]))
        expected = np.concatenate(([expected[:small].sum()], expected[small:]))
        if expected[0] < FEWEST and expected.size > 1:
            counts = np.concatenate(([counts[:2].sum()], counts[2:]))
            expected = np.concatenate(([expected[:2].sum()], expected[2:]))
    statistic = ((counts - expected) ** 2 / expected).sum()
    return float(stats.chi2.sf(statistic, max(expected.size - 1, 1)))


def uniform(values, bins):
    """p-value of numbers in [0, 1) being uniform: values (k, N) fill a grid of bins per axis."""
    values = np.atleast_2d(values)
    grid = np.histogramdd(values.T, bins=bins, range=[(0.0, 1.0)] * values.shape[0])[0]
    return chi_square(grid, np.full(grid.shape, values.shape[1] / grid.size))


def mean_and_error(samples):
    """Mean (C,) and standard error (C,) of samples (C, P, S): S independent ones in each of P pixels."""
    pixels, n = samples.shape[1:]
    error = np.sqrt(samples.var(axis=2, ddof=1).sum(axis=1) / n) / pixels
    return samples.mean(axis=(1, 2)), error
