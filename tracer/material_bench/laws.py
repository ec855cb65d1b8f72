"""What is expected of a material: what physics asks of any, and what the tracer asks of its sampler."""

from typing import NamedTuple

import numpy as np

from tracer.material_bench.counts import histogram
from tracer.material_bench.energy import albedo, energy, sides, towards, weights

TILTS = (0.0, 30.0, 60.0, 80.0)  # degrees of wo that the bench looks from


class Property(NamedTuple):
    """Something that is expected of a material, and the figure by which it was judged."""

    name: str
    holds: bool
    figure: float
    meaning: str  # of the figure


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
    there, back = f * energy(material, wo, wi), material.eval(wi, wo)
    off = np.abs(there - back) / np.maximum(np.maximum(there, back), 1e-6)
    worst = [off.max()]
    for u in (0.0, 1.0 - 2.0**-32):  # Dirac lobes: there by one choice, and back by the same
        choice = np.full(wo.shape, u)
        first = material.sample(wo, choice)
        again = material.sample(first.wi, choice)
        same = first.delta & again.delta & (first.lobe == again.lobe)
        same &= (first.pdf > 0) & (again.pdf > 0) & (np.abs(again.wi - wo).max(axis=0) < 1e-6)
        there, back = (
            first.f * energy(material, wo, first.wi),
            again.f * energy(material, first.wi, again.wi),
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


def _directions(rng, n):
    w = rng.normal(size=(3, n))
    return w / np.sqrt((w * w).sum(axis=0))
