"""Samplers against their densities, weights of samples, and how much light rough surfaces send back."""

import numpy as np
from densities import SAMPLERS
from rough import facets
from scipy import stats
from stats import sidak, z_limit
from truth import entry, keys
from values import Estimate
from values.facets import albedo, weights
from values.registry import DTYPES, ROUNDING

from figures.figure import Figure
from tracer.bsdf.microfacet import DISTRIBUTIONS

TITLE = "Samplers"
CHUNKS = 100
SEEDS = 40  # of each sampler
ALPHAS = ((1e-4, 1e-4), (1e-3, 1e-3), (0.02, 0.02), (0.1, 0.4), (0.5, 0.5), (1.0, 1.0))
HEIGHTS = (1.0, 0.5, 0.05, 1e-3, 1e-8)  # cosines of wo
WEIGHTS, FURNACE = 20_000, 200_000  # samples of each


def _chi_square(seed):
    """p-values of a part of the samplers, under many seeds of their own."""
    found = []
    for number in range(seed // 1000 % CHUNKS, len(SAMPLERS), CHUNKS):
        name = list(SAMPLERS)[number]
        found += [[name, SAMPLERS[name].p(seed + 100_000 * (number + 1) + k)] for k in range(SEEDS)]
    return {"p": found}


def _judge_p(sums, chunks):
    name, least = min(sums["p"], key=lambda row: row[1])
    even = stats.kstest([p for _, p in sums["p"]], "uniform").pvalue
    limit = sidak(len(sums["p"]))
    text = f"least of {len(sums['p'])} p: {least:.2g} ({name}; limit {limit:.2g}); evenness: p = {even:.2g}"
    return text, least > limit and 1e-4 < even


def _heaviest(bits):
    def measure(seed):
        """Largest f cos / pdf of a surface with F = 1."""
        dtype, most = DTYPES[bits], 0.0
        for kind in DISTRIBUTIONS:
            for alpha in ALPHAS:
                f = facets(kind, *alpha, dtype)
                for mu in HEIGHTS:
                    with np.errstate(all="ignore"):
                        weight = weights(f, mu, seed, WEIGHTS, phi=0.7, dtype=dtype)
                    most = max(most, float(np.nan_to_num(weight, nan=np.inf).max()))
        return {"most_weight": most}

    return measure


def _judge_weight(bits):
    eps = float(np.finfo(DTYPES[bits]).eps)

    def judge(sums, chunks):
        above = (sums["most_weight"] - 1.0) / eps
        return f"1 {'-' if above < 0 else '+'} {abs(above):.0f} eps", above <= 8.0

    return judge


def _furnace(table, bits):
    def measure(seed):
        found = {}
        for number, key in enumerate(table):
            samples = albedo(key, entry(key)[0], bits, seed + 100_000 * (number + 1), FURNACE)
            estimate = Estimate.of(samples)
            found[f"mean {key}"], found[f"square {key}"] = estimate.mean, estimate.error**2
        return found

    return measure


def _judge_furnace(table, bits):
    def judge(sums, chunks):
        worst, widest = (0.0, ""), 0.0
        for key in table:
            value, error = entry(key)[1], np.sqrt(sums[f"square {key}"]) / chunks
            beyond = max(abs(sums[f"mean {key}"] / chunks - value) - ROUNDING[bits] * value, 0.0)
            worst = max(worst, (beyond / max(error, 1e-300), key))
            widest = max(widest, error / value)
        limit = z_limit(len(table))
        text = f"z = {worst[0]:.2f} ({worst[1]}; limit {limit:.2f}); errors up to {100 * widest:.3f} %"
        return text, worst[0] < limit

    return judge


def figures():
    yield Figure(
        "chi-square",
        f"chi-square of {len(SAMPLERS)} samplers under {SEEDS} seeds each",
        "least p by Sidak at 1 %; evenness (Kolmogorov-Smirnov) above 1e-4",
        "pbrt, mitsuba, nori, Falcor: 1 %, one seed",
        "both",
        CHUNKS,
        len(SAMPLERS) * SEEDS // CHUNKS,
        _chi_square,
        _judge_p,
    )
    n = len(DISTRIBUTIONS) * len(ALPHAS) * len(HEIGHTS) * WEIGHTS
    for bits in (32, 64):
        yield Figure(
            f"weights-{bits}",
            "largest f cos / pdf, visible normals, F = 1, roughness 1e-4 to 1, cosines 1e-8 to 1",
            "1 + 8 eps",
            "pbrt: a mean below 1.01",
            f"float{bits}",
            100,
            n,
            _heaviest(bits),
            _judge_weight(bits),
        )
    for kind in DISTRIBUTIONS:
        table = keys(f"albedo.{kind}.")
        for bits in (32, 64):
            yield Figure(
                f"white-furnace-{kind}-{bits}",
                f"white furnace of {kind}, {len(table)} exact albedos: largest z",
                "Sidak at 1 %",
                "pbrt, appleseed: 1 to 5 %",
                f"float{bits}",
                50,
                len(table) * FURNACE,
                _furnace(table, bits),
                _judge_furnace(table, bits),
            )
