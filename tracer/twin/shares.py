"""Which share of a difference of two traces comes from which depth and technique."""

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from tracer.twin.exact import exact_colours

TECHNIQUES = {"hit": "emission", "light": "light sample", "escape": "environment"}
_WAYS = tuple(TECHNIQUES.values())
FILM, ROUNDING, INVALID = "film", "rounding", "not finite"
_ROUNDING = 4.0  # machine epsilons a term by which a sum of terms may be off


class Share(NamedTuple):
    """What the second trace's paths bring more than the first's, by one technique at one depth.

    technique: emission, light sample or environment; or, with depth None, what the sum of those does not
    explain: film (the recorded radiance is not the sum of its terms), rounding (of that sum), not finite (all
    of a path that has a term which is no finite number). means: of each trace over all pairs, (red, green,
    blue); difference: the second less the first. All are exact.
    """

    technique: str
    depth: int | None
    means: tuple  # of Fractions
    difference: tuple


class Told(NamedTuple):
    """What a difference of pictures is made of; every sum of Fractions is exact."""

    shares: tuple
    difference: tuple  # mean of all pairs, the second trace less the first: the sum of the shares
    means: tuple  # of each trace
    radiance: np.ndarray  # (3, P) float64 difference of each pair, NaN where it is not finite
    left_out: int  # pairs whose radiance is not finite in one of them


def told(traces, pairs):
    """The Told of two traces; None where one of them has no radiance."""
    if not all("radiance" in trace.paths for trace in traces):
        return None
    rows = (pairs.a, pairs.b)
    radiance = [trace.paths["radiance"][:, row] for trace, row in zip(traces, rows, strict=True)]
    known = np.isfinite(radiance[0]).all(axis=0) & np.isfinite(radiance[1]).all(axis=0)
    terms = [_terms(trace, row) for trace, row in zip(traces, rows, strict=True)]
    sound = known.copy()
    for pair, _, value in terms:
        sound[pair[~np.isfinite(value).all(axis=0)]] = False
    names = np.unique(np.concatenate([cell for _, cell, _ in terms]))
    sums = [
        _summed(term, brought, names, sound, known, trace.eps)
        for term, brought, trace in zip(terms, radiance, traces, strict=True)
    ]
    count = max(int(np.count_nonzero(known)), 1)
    labels = [(_WAYS[name % len(_WAYS)], name // len(_WAYS)) for name in names.tolist()]
    labels += [(FILM, None), (ROUNDING, None), (INVALID, None)]
    shares = []
    for (technique, depth), one, other in zip(labels, *sums, strict=True):
        means = tuple(tuple(v / count for v in colour) for colour in (one, other))
        difference = tuple(y - x for x, y in zip(*means, strict=True))
        if any(difference):
            shares.append(Share(technique, depth, means, difference))
    with np.errstate(invalid="ignore"):
        apart = radiance[1].astype(np.float64) - radiance[0]
    means = tuple(tuple(_total(of, c) / count for c in range(3)) for of in sums)
    difference = tuple(_total([s.difference for s in shares], c) for c in range(3))
    return Told(
        tuple(shares), difference, means, np.where(known, apart, np.nan), int(np.count_nonzero(~known))
    )


def _total(colours, channel):
    return sum((colour[channel] for colour in colours), Fraction(0))


def _terms(trace, rows):
    """(pair (E,), cell (E,): depth and technique as one number, contribution (3, E)) of what paths gather."""
    number = np.full(trace.size, -1, np.int64)
    number[rows] = np.arange(rows.size)
    parts = [(np.empty(0, np.int64), np.empty(0, np.int64), np.empty((3, 0)))]
    for way, kind in enumerate(TECHNIQUES):
        table = trace.tables[kind]
        if table["contribution"] is None:
            continue
        lit = np.flatnonzero((table["contribution"] != 0.0).any(axis=0) & (number[table.path] >= 0))
        brought = table["contribution"][:, lit]
        cell = table.depth[lit].astype(np.int64) * len(_WAYS) + way
        parts.append((number[table.path[lit]], cell, brought))
    return tuple(np.concatenate(column, axis=-1) for column in zip(*parts, strict=True))


def _summed(terms, radiance, names, sound, known, eps):
    """Exact sums of one trace: of each cell of `names`, then what film, rounding, not finite are."""
    pair, cell, value = (column[..., sound[terms[0]]] for column in terms)
    sums = exact_colours(np.searchsorted(names, cell), value, names.size)
    size = radiance.shape[1]
    added = np.stack([np.bincount(pair, channel, size) for channel in value])
    room = np.stack([np.bincount(pair, np.abs(channel), size) for channel in value])
    room = room * _ROUNDING * eps * (1 + np.bincount(pair, minlength=size))
    with np.errstate(invalid="ignore"):
        near = (np.abs(radiance - added) <= room).all(axis=0)
    # Of each pair what its terms do not explain: its radiance less their sum, exactly.
    rest = np.where(sound, np.where(near, 1, 0), 2)
    whole = exact_colours(rest[known], radiance[:, known], 3)
    parts = exact_colours(rest[pair], value, 3)
    left = [tuple(w - p for w, p in zip(*both, strict=True)) for both in zip(whole, parts, strict=True)]
    return sums + left
