"""Samples of one direction counted by their angle from the normal, beside what their density expects."""

from typing import NamedTuple

import numpy as np

from tracer.events import LOBES
from tracer.material_bench.energy import towards, weights


class Histogram(NamedTuple):
    """Samples of one direction wo by their angle from the normal, beside their density."""

    edges: np.ndarray  # (K+1,) degrees from the normal
    counted: np.ndarray  # (K,) share of the samples, of the lobes that are not Dirac ones
    expected: np.ndarray  # (K,) the density's share
    dirac: dict  # lobe -> (share of the samples, probability said by the first of them)
    lost: float  # share of the samples that carry nothing
    p: float  # of chi-square over the bins; NaN without such samples


def histogram(material, degrees, n=100_000, seed=0):
    """A Histogram of the samples of one direction."""
    edges = _edges(material, degrees, seed + 1000)
    _, _, sample = weights(material, towards(degrees, n), seed)
    good = (sample.pdf > 0.0) & (sample.f.max(axis=0) > 0.0)
    counted = np.histogram(_angle(sample.wi)[good & ~sample.delta], edges)[0]
    expected = _shares(material, degrees, edges)
    dirac = {}
    for code in np.unique(sample.lobe[good & sample.delta]):
        lanes = good & sample.delta & (sample.lobe == code)
        dirac[LOBES[code]] = float(lanes.mean()), float(sample.pdf[lanes][0])
    return Histogram(edges, counted / n, expected, dirac, float(1.0 - good.mean()), _p(counted, expected * n))


def _angle(w):
    """Degrees from the normal, (N,), with all digits near 0 and 180."""
    return np.degrees(np.arctan2(np.hypot(w[0], w[1]), w[2]))


def _edges(material, degrees, seed):
    """Borders of bins in degrees: even ones, and between them where samples of their own crowd."""
    even = np.linspace(0.0, 90.0 if material.one_sided else 180.0, 13)
    if material.delta:
        return even
    _, _, sample = weights(material, towards(degrees, 20_000), seed)
    angle = _angle(sample.wi)[(sample.pdf > 0.0) & ~sample.delta]
    parts = angle[angle < 90.0], angle[angle >= 90.0]
    crowded = [_quantiles(part, low) for part, low in zip(parts, (0.0, 90.0), strict=True) if part.size]
    return np.unique(np.concatenate((even, *crowded)))


def _quantiles(angle, low):
    """Borders for angles from low to low + 90: finer in the tails, and a little beyond what was seen."""
    tail = np.array([0.0, 0.001, 0.005, 0.015])
    ranks = np.concatenate((tail, np.linspace(0.0, 1.0, 21)[1:-1], np.flip(1.0 - tail)))
    borders = np.quantile(angle, ranks)
    below, above = borders[3] - borders[0], borders[-1] - borders[-4]
    beyond = borders[0] - below * np.array([1.0, 4.0]), borders[-1] + above * np.array([1.0, 4.0])
    return np.clip(np.concatenate((borders, *beyond)), low, low + 90.0)


def _shares(material, degrees, edges, points=24, turns=720):
    """What the density of wi puts between angles from the normal, by Gauss-Legendre and even longitudes."""
    if material.delta:
        return np.zeros(edges.size - 1)
    x, weight = np.polynomial.legendre.leggauss(points)
    theta = np.radians(edges[:-1, None] + np.diff(edges)[:, None] * (0.5 * x + 0.5)).ravel()
    # Even steps in the cube root of the longitude from the mirror direction's, where lobes are narrow.
    s = (np.arange(turns) + 0.5) * (2.0 / turns) - 1.0
    phi, stretch = np.pi * s**3 + 0.7 + np.pi, 3.0 * np.pi * s * s * (2.0 / turns)
    ring = np.empty(theta.size)
    wo = towards(degrees, turns)
    for k, angle in enumerate(theta):
        wi = np.stack(
            (np.sin(angle) * np.cos(phi), np.sin(angle) * np.sin(phi), np.full(turns, np.cos(angle)))
        )
        ring[k] = (material.pdf(wo, wi) * stretch).sum() * np.sin(angle)
    width = np.radians(np.diff(edges))
    return (ring.reshape(-1, points) * (0.5 * weight)).sum(axis=1) * width


def _p(counted, expected):
    """p-value of counts against what is expected, bins below 5 put together; NaN where nothing is."""
    if counted.sum() == 0:
        return float("nan")
    from scipy.stats import chi2

    expected = expected * counted.sum() / expected.sum()
    order = np.argsort(expected)
    counted, expected = counted[order], expected[order]
    few = int(np.searchsorted(np.cumsum(expected), 5.0)) + 1
    counted = np.append(counted[few:], counted[:few].sum())
    expected = np.append(expected[few:], expected[:few].sum())
    return float(chi2.sf(((counted - expected) ** 2 / expected).sum(), max(counted.size - 1, 1)))
