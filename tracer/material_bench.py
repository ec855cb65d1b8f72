"""One material on the bench: what holds of it, with the figure found, and what it looks like in numbers.

    from tracer.material_bench import albedo, properties
    from tracer.scene_file.materials import bsdf
    properties(bsdf({"type": "roughconductor", "material": "Au"}, "gold"))

Every function takes a material with one column of float64 parameters and gives plain arrays. Energy is what
is counted on the far side of glass too: radiance there is the square of the index times as much.
"""

from typing import NamedTuple

import numpy as np

from tracer.bsdf import fresnel
from tracer.events import LOBES
from tracer.frame import same_side

TILTS = (0.0, 30.0, 60.0, 80.0)  # degrees of wo that the bench looks from


class Property(NamedTuple):
    """Something that is expected of a material, and the figure by which it was judged."""

    name: str
    holds: bool
    figure: float
    meaning: str  # of the figure


class Histogram(NamedTuple):
    """Samples of one direction wo by their angle from the normal, beside their density."""

    edges: np.ndarray  # (K+1,) degrees from the normal
    counted: np.ndarray  # (K,) share of the samples, of the lobes that are not Dirac ones
    expected: np.ndarray  # (K,) the density's share
    dirac: dict  # lobe -> (share of the samples, probability said by the first of them)
    lost: float  # share of the samples that carry nothing
    p: float  # of chi-square over the bins; NaN without such samples


def towards(degrees, n=1, turn=0.7):
    """n copies (3, n) of the direction so many degrees from the normal; beyond 90 it is below."""
    theta = np.radians(degrees)
    w = np.array([np.sin(theta) * np.cos(turn), np.sin(theta) * np.sin(turn), np.cos(theta)])
    return np.repeat(w[:, None], n, axis=1)


def sides(material):
    """The sides to look from: 1 above, -1 below where the material scatters there too."""
    return (1,) if material.one_sided else (1, -1)


def weights(material, wo, seed=0, even=False):
    """(reflected, transmitted) energy of each sample, two (3, N), and the Sample itself.

    even: the numbers that choose the lobe are spread evenly, for quieter means; not for tests of chance.
    """
    u = np.random.default_rng(seed).random((3, wo.shape[1]))
    if even:
        u[0] = (np.arange(wo.shape[1]) + u[0]) / wo.shape[1]
    sample = material.sample(wo, u)
    cos = np.where(sample.delta, 1.0, np.abs(sample.wi[2]))
    weight = sample.f * (cos / np.where(sample.pdf > 0.0, sample.pdf, np.inf))
    weight = weight * _energy(material, wo, sample.wi)
    back = same_side(wo, sample.wi)
    return weight * back, weight * ~back, sample


def albedo(material, degrees, n=20_000, seed=0):
    """Share of the light that is reflected and transmitted, (3, K) each, and the standard error of their sum
    (3, K), for directions wo so many degrees from the normal."""
    reflected, transmitted, error = (np.empty((3, len(degrees))) for _ in range(3))
    for k, angle in enumerate(degrees):
        back, across, _ = weights(material, towards(angle, n), seed + k, even=True)
        reflected[:, k], transmitted[:, k] = back.mean(axis=1), across.mean(axis=1)
        error[:, k] = (back + across).std(axis=1) / np.sqrt(n)
    return reflected, transmitted, error


def lobes(material, degrees, n=721):
    """f |cos| (3, n) in the plane of incidence, and the angles (n,) in degrees from the normal, -180 to 180:
    positive on the far side, where a mirror would reflect to."""
    angles = np.linspace(-180.0, 180.0, n)
    wi = np.concatenate([towards(a, 1, 0.7 + np.pi) for a in angles], axis=1)
    wo = towards(degrees, n)
    return angles, material.eval(wo, wi) * np.abs(wi[2])


def dirac_lobes(material, degrees):
    """The Dirac lobes of wo: [(lobe, angle in degrees as in lobes, fraction (3,)), ...]."""
    wo, found = towards(degrees, 64), {}
    u = np.full((3, 64), 0.5)
    u[0] = (np.arange(64) + 0.5) / 64
    sample = material.sample(wo, u)
    for k in np.flatnonzero(sample.delta & (sample.pdf > 0.0)):
        across = -(sample.wi[0, k] * np.cos(0.7) + sample.wi[1, k] * np.sin(0.7))
        angle = np.degrees(np.arctan2(across, sample.wi[2, k]))
        found.setdefault(LOBES[sample.lobe[k]], (float(angle), sample.f[:, k].copy()))
    return [(lobe, *what) for lobe, what in found.items()]


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


def fresnel_curves(material, n=901):
    """{name: (n,)} of cos, Rs, Rp, exact mean and Schlick's, seen from outside, and the angles in degrees
    {brewster, critical}; None for a material without an index. Of a conductor: the green channel."""
    cos = np.cos(np.radians(np.linspace(0.0, 90.0, n)))
    inside = material.bsdf if hasattr(material, "bsdf") else material
    if not hasattr(inside, "eta"):
        return None
    marks = {}
    if hasattr(inside, "k"):
        eta, k = inside.eta[1:2], inside.k[1:2]
        if np.isinf(k).any():
            return None
        rs, rp = (r[0] for r in fresnel.conductor(cos, eta, k))
        schlick = fresnel.conductor_mean(cos, eta, k, "schlick")[0]
    else:
        eta = np.full(n, float(inside.eta[0]))
        rs, rp, _ = fresnel.dielectric(cos, eta)
        schlick, _ = fresnel.dielectric_mean(cos, eta, "schlick")
        marks["brewster"] = float(np.degrees(np.arctan(eta[0])))
        if eta[0] != 1.0:
            marks["critical"] = float(np.degrees(np.arcsin(min(eta[0], 1.0 / eta[0]))))
    return {"cos": cos, "Rs": rs, "Rp": rp, "exact": 0.5 * (rs + rp), "schlick": schlick}, marks


def physical(material, n=20_000, seed=0):
    """The Property list of what physics asks of any BSDF, each checked on n random pairs or samples."""
    rng = np.random.default_rng(seed)
    wo, wi = _directions(rng, n), _directions(rng, n)
    f, pdf = material.eval(wo, wi), material.pdf(wo, wi)
    least = float(min(f.min(), pdf.min()))
    finite = bool(np.isfinite(f).all() and np.isfinite(pdf).all())
    found = [
        Property("non-negative", least >= 0.0 and finite, least, "least f or density found"),
        _linear(material, wo, wi, f, rng),
        _reciprocal(material, wo, wi, f),
        _conserving(material, n, seed),
    ]
    return [p._replace(figure=float(p.figure)) for p in found]


def properties(material, n=20_000, seed=0):
    """The list of Property that any BSDF is expected to have: what physics asks, and what the tracer does of
    its sampler."""
    rng = np.random.default_rng(seed)
    wo, wi = _directions(rng, n), _directions(rng, n)
    sampled = [
        _isotropic(material, wo, wi, material.eval(wo, wi), rng),
        _bounded(material, n, seed),
        _sampled(material, seed),
    ]
    return physical(material, n, seed) + [p._replace(figure=float(p.figure)) for p in sampled]


def _linear(material, wo, wi, f, rng):
    """The response to two lights together is the sum of the responses, and no lane minds its company."""
    one, two = rng.random(wo.shape[1]), rng.random(wo.shape[1])
    apart = (f * one).sum(axis=1) + (f * two).sum(axis=1)
    half = slice(0, wo.shape[1], 2)
    together = (material.eval(wo, wi) * (one + two)).sum(axis=1)
    off = np.abs(together - apart).max() / max(apart.max(), np.finfo(float).tiny)
    alone = np.array_equal(material.eval(wo[:, half], wi[:, half]), f[:, half])
    return Property("linear", bool(off < 1e-12 and alone), off, "relative error of the sum of two lights")


def _reciprocal(material, wo, wi, f):
    there, back = f * _energy(material, wo, wi), material.eval(wi, wo)
    off = np.abs(there - back) / np.maximum(np.maximum(there, back), 1e-6)
    worst = [off.max()]
    for u in (0.0, 1.0 - 2.0**-32):  # Dirac lobes: there by one choice, and back by the same
        choice = np.full(wo.shape, u)
        first = material.sample(wo, choice)
        again = material.sample(first.wi, choice)
        same = first.delta & again.delta & (first.lobe == again.lobe)
        same &= (first.pdf > 0) & (again.pdf > 0) & (np.abs(again.wi - wo).max(axis=0) < 1e-6)
        there, back = (
            first.f * _energy(material, wo, first.wi),
            again.f * _energy(material, first.wi, again.wi),
        )
        gap = np.abs(there - back)[:, same]
        worst.append(gap.max() if same.any() else 0.0)
    off = max(worst)
    return Property("reciprocal", bool(off < 1e-6), off, "largest relative difference of f there and back")


def _conserving(material, n, seed):
    angles = [a for side in sides(material) for a in (t if side > 0 else 180.0 - t for t in (*TILTS, 88.0))]
    reflected, transmitted, error = albedo(material, angles, n, seed)
    whole = reflected + transmitted
    holds = (whole <= 1.0 + 4.0 * error + 1e-9).all()
    return Property("energy conserving", bool(holds), whole.max(), "largest share of light sent on")


def _isotropic(material, wo, wi, f, rng):
    turn = rng.random(wo.shape[1]) * 2.0 * np.pi
    cos, sin = np.cos(turn), np.sin(turn)
    turned = material.eval(
        *(np.stack((cos * w[0] - sin * w[1], sin * w[0] + cos * w[1], w[2])) for w in (wo, wi))
    )
    off = (np.abs(turned - f) / np.maximum(np.maximum(turned, f), 1e-6)).max()
    return Property("isotropic", bool(off < 1e-6), off, "largest relative change of f when both turn")


def _bounded(material, n, seed):
    most = 0.0
    for side in sides(material):
        for tilt in TILTS:
            back, across, _ = weights(material, towards(tilt if side > 0 else 180.0 - tilt, n), seed)
            most = max(most, float((back + across).max()))
    return Property("weights bounded", most < 10.0, most, "largest f cos / density, 1 where nothing is lost")


def _sampled(material, seed):
    """Chi-square over each tilt, the least p-value against 1 % by Sidak."""
    p = [histogram(material, tilt, 50_000, seed=seed + k).p for k, tilt in enumerate(TILTS)]
    p = [value for value in p if not np.isnan(value)]
    if not p:
        return Property("samples follow density", True, 1.0, "only Dirac lobes: nothing to count")
    least, limit = min(p), 1.0 - 0.99 ** (1.0 / len(p))
    return Property("samples follow density", least > limit, least, "least p-value of chi-square")


def _energy(material, wo, wi):
    """What makes energy of radiance: the squared index across, where the light went across."""
    inside = material.explain(wo, wi).get("eta")
    return 1.0 if inside is None else np.where(same_side(wo, wi), 1.0, inside * inside)


def _directions(rng, n):
    w = rng.normal(size=(3, n))
    return w / np.sqrt((w * w).sum(axis=0))


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
