"""One sampler and the density it claims: how many samples fall into each cell, and how many should."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from stats import chi_square

LEAN = 0.1  # the smallest fault that every sampler's test claims to see: a density that leans by a tenth
NOTHING = 1e-3  # a share that may be the integral's error


@dataclass(frozen=True)
class Sampler:
    """count(seed): samples in each cell (K,) or, with those that have no density, (K + 1,).

    expect(): what the density puts into each cell, (K,): shares of all samples. faults: other shares by name,
    that a test has to tell from it: the smallest fault it claims to see.
    """

    name: str
    count: Callable
    expect: Callable
    faults: tuple = ()

    def p(self, seed):
        """p-value of the samples under one seed."""
        return self.against(self.count(seed))

    def against(self, counts, fault=None):
        """p-value of counted samples, against the density or a wrong one."""
        shares = shares_of(self)
        if fault == "leaning":
            shares = leaning(shares)
        elif fault:
            shares = dict(self.faults)[fault]()
        return agreement(counts, shares)


@cache
def shares_of(sampler):
    """What the sampler expects, found once."""
    return np.ravel(sampler.expect()).astype(float)


def leaning(shares):
    """Shares, a tenth more at one end and less at the other, the cells in order of what they hold."""
    order = np.argsort(shares, kind="stable")
    below = np.cumsum(shares[order]) / shares.sum()
    tilted = shares.copy()
    tilted[order] *= 1.0 + LEAN * (2.0 * below - shares[order] / shares.sum() - 1.0)
    return tilted


def agreement(counts, shares):
    """p-value. A density may integrate to less than 1: the rest has none, and a cell of its own."""
    counts, shares = np.ravel(counts), np.ravel(shares)
    assert shares.sum() < 1.0 + NOTHING, "the density integrates to more than 1"
    if counts.size > shares.size:
        if counts[-1] or shares.sum() < 1.0 - NOTHING:
            shares = np.append(shares, 1.0 - shares.sum())
        else:
            counts = counts[:-1]
    if shares.sum() > 1.0 - NOTHING and shares[-1] >= 0.0:
        shares = shares / shares.sum()
    return chi_square(counts, counts.sum() * shares)


def nodes(cells, points):
    """Nodes and weights over [0, 1], `points` of Gauss and Legendre in each of `cells` equal parts."""
    x, w = np.polynomial.legendre.leggauss(points)
    return ((np.arange(cells)[:, None] + 0.5 * x + 0.5) / cells).ravel(), np.tile(0.5 * w / cells, cells)


def even(*shape):
    """Shares of cells that all hold the same."""
    return lambda: np.full(int(np.prod(shape)), 1.0 / np.prod(shape))


def square(places, columns, rows):
    """How many of places (2, N) in the unit square lie in each cell."""
    return np.histogram2d(*np.clip(places, 0.0, 1.0), (columns, rows), ((0, 1), (0, 1)))[0].ravel()


def longitude(w):
    """Angle around z, from 0 to 1."""
    return np.arctan2(w[1], w[0]) / (2.0 * np.pi) % 1.0
