"""Tests over many events: what each gives, and how sure one may be.

A right trace fails any of them but once in 10 000 times (ALPHA), so each test, a cell, has Sidak's share of
that. At such small chances approximations fail first in their tails: where it can be had, the chance is exact
(Kolmogorov and Smirnov) or a bound (self-normalised sums); chi-square is asked of large counts only.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

ALPHA = 1e-4  # chance that a right trace breaks any statistical law
ENOUGH = 200.0  # a cell of a chi-square test expects at least so many
FEW = 0.5  # times the root of their number: so few of all events move no test by more than its own spread
FEWEST = 100  # with fewer events there is no test


@dataclass(frozen=True)
class Cell:
    """One test: the chance that a right tracer does as badly, what was found, in which events (rows)."""

    p: float
    words: str
    kind: str
    rows: np.ndarray
    facts: dict[str, Any] = field(default_factory=dict)


def uniform(values):
    """Chance that numbers (N,) uniform in [0, 1] are so far from evenly spread (Kolmogorov and Smirnov)."""
    from scipy.stats import kstwo

    values = np.sort(np.clip(values, 0.0, 1.0))
    n = values.size
    if not n:
        return 1.0
    grid = np.arange(n + 1) / n
    off = max((grid[1:] - values).max(), (values - grid[:-1]).max())
    return float(min(1.0, kstwo.sf(off, n)))


def same(a, b):
    """Chance that two samples (N,) and (M,) of one distribution are so far apart."""
    from scipy.stats import ks_2samp

    return float(ks_2samp(a, b, method="asymp").pvalue)


def counts(found, expected):
    """Chance of counts (K,) so far from what is expected (K,); those that expect few are put together."""
    from scipy.stats import chi2

    order = np.argsort(expected)
    found, expected = found[order].astype(float), expected[order]
    few = int(np.searchsorted(np.cumsum(expected), ENOUGH)) + 1
    found = np.concatenate(([found[:few].sum()], found[few:]))
    expected = np.concatenate(([expected[:few].sum()], expected[few:]))
    while found.size > 1 and expected[1] < ENOUGH:
        found = np.concatenate(([found[:2].sum()], found[2:]))
        expected = np.concatenate(([expected[:2].sum()], expected[2:]))
    if found.size < 2:
        return None
    return float(chi2.sf(((found - expected) ** 2 / expected).sum(), found.size - 1))


def square(a, b):
    """Chance that pairs of independent uniform numbers (N,) fill the square so unevenly; None for few."""
    side = int(min(8, np.sqrt(a.size / ENOUGH)))
    if side < 2:
        return None
    place = [np.minimum((np.clip(v, 0.0, 1.0) * side).astype(int), side - 1) for v in (a, b)]
    found = np.bincount(place[0] * side + place[1], minlength=side * side)
    return counts(found, np.full(side * side, a.size / side**2))


def unrelated(a, b):
    """Chance that independent uniform numbers (N,) are so correlated."""
    from scipy.stats import norm

    z = 12.0 * ((a - 0.5) * (b - 0.5)).sum() / np.sqrt(a.size)
    return float(2.0 * norm.sf(abs(z)))


def means(values, group):
    """Bound on the chance that independent uniform numbers (N,) have means so far from 1/2 in groups (N,), by
    number.

    x, the sum of 12 n (mean - 1/2)^2 over L groups, is chi-square but for its tail, which Chernoff's bound
    on that of chi-square holds, too: (x / L)^(L/2) exp((L - x) / 2). For uniform numbers have no larger
    moments than normal ones of their variance, so that E exp(s x) is at most (1 - 2 s)^(-L/2).
    """
    many = np.bincount(group)
    off = np.bincount(group, values - 0.5)[many > 0]
    x, groups = (12.0 * off * off / many[many > 0]).sum(), off.size
    if not x > groups:
        return 1.0
    return float(np.exp(0.5 * (groups - x + groups * np.log(x / groups))))


def balanced(differences):
    """Bound on the chance that independent differences (N,), each as likely as its negative, add up so far
    from 0 in units of the root of the sum of their squares: 2 exp(-t^2 / 2) (Efron 1969)."""
    spread = np.sqrt((differences * differences).sum())
    if not spread > 0.0:
        return 1.0
    t = differences.sum() / spread
    return float(min(1.0, 2.0 * np.exp(-0.5 * t * t)))


def share(hits, chances):
    """Chance that events (N,) bool with these chances (N,) happen so much too often or too seldom."""
    from scipy.stats import norm

    spread = np.sqrt((chances * (1.0 - chances)).sum())
    if not spread > 0.0:
        return 1.0 if (hits == (chances > 0.5)).all() else 0.0
    return float(2.0 * norm.sf(abs((hits - chances).sum()) / spread))
