"""The first event of each pair of paths that differs, and in which number."""

from typing import NamedTuple

import numpy as np

from tracer.events import KINDS

STEPS = 32.0  # machine epsilons by which two roundings of one number may differ
_AGAINST_ONE = ("unit vector", "cosine", "probability")  # what may be near 0 and is rounded like 1
KIND, DEPTH, MISSING = "kind", "depth", "event"  # what may differ beside fields
# In an event's own order, but causes first: numbers drawn, and last what is asked of all the others.
_EARLY, _LATE = ("u",), ("visible", "transmittance", "contribution")
_WHOLE = ("flag", "choice", "index", "shape", "bsdf", "light")


def causal(kind):
    """The fields of a kind, what depends on others after those."""
    late = _LATE if kind.name == "light" else ()
    return sorted(kind.fields, key=lambda f: (f.name in late) - (f.name in _EARLY))


class Firsts(NamedTuple):
    """Where pairs part. One entry a pair that does, pairs ascending."""

    pair: np.ndarray  # (D,)
    a: np.ndarray  # (D,) place in the first trace's Events, -1 where its path is over
    b: np.ndarray  # (D,)
    what: list  # (D,) names of fields, or KIND, DEPTH, MISSING
    rounded: int  # pairs whose events differ within rounding only


def firsts(a, b, events, exact=False):
    """The Firsts of two traces with their Events; exact: whether every bit counts."""
    common = np.minimum(events[0].lengths, events[1].lengths)
    pair = np.repeat(np.arange(common.size), common)
    rank = np.arange(pair.size) - np.repeat(np.cumsum(common) - common, common)
    one, other = (e.begin[pair] + rank for e in events)
    code, names, unequal = _told_apart(a, b, events, (one, other), exact)
    places = np.flatnonzero(code)
    parting, first = np.unique(pair[places], return_index=True)
    places = places[first]
    shorter = np.flatnonzero(events[0].lengths != events[1].lengths)
    shorter = shorter[~np.isin(shorter, parting)]
    ends = [
        np.where(e.lengths[shorter] > common[shorter], e.begin[shorter] + common[shorter], -1) for e in events
    ]
    what = [names[c - 1] for c in code[places]] + [MISSING] * shorter.size
    both = np.r_[parting, shorter]
    order = np.argsort(both, kind="stable")
    return Firsts(
        both[order],
        np.r_[one[places], ends[0]][order],
        np.r_[other[places], ends[1]][order],
        [what[k] for k in order],
        np.setdiff1d(np.unique(pair[unequal]), both).size,
    )


def _told_apart(a, b, events, places, exact):
    """What is first unlike in each pair of events, (C,): 0 for nothing, else 1 + its place among the names;
    the names; and which pairs are not the same to the last bit, (C,). places: of both in their Events."""
    eps = 0.0 if exact else STEPS * max(a.eps, b.eps)
    one, other = places
    code, unequal = np.zeros(one.size, np.int16), np.zeros(one.size, bool)
    names = [KIND, DEPTH]
    code[events[0].depth[one] != events[1].depth[other]] = 2
    code[events[0].kind[one] != events[1].kind[other]] = 1
    fields = compared(a, b)
    for number, kind in enumerate(KINDS):
        there = np.flatnonzero((code == 0) & (events[0].kind[one] == number))
        rows = events[0].row[one[there]], events[1].row[other[there]]
        for field in fields[kind.name]:
            names.append(field.name)
            mine, theirs = (
                trace.tables[kind.name][field.name].take(row, axis=-1)
                for trace, row in zip((a, b), rows, strict=True)
            )
            unlike, apart = differing(field, mine, theirs, eps)
            unequal[there[unlike]] = True
            new = there[apart]
            code[new[code[new] == 0]] = len(names)
    return code, names, unequal


def compared(a, b):
    """Name of a kind -> the Fields that both traces have, causes first."""
    return {
        kind.name: [
            f for f in causal(kind) if all(f.name in trace.tables[kind.name].columns for trace in (a, b))
        ]
        for kind in KINDS
    }


def uncompared(a, b):
    """ "kind.field" of what only one of two traces has, each with the number of that trace."""
    found = []
    for kind in KINDS:
        if not all(trace.tables[kind.name].path.size for trace in (a, b)):
            continue
        columns = [trace.tables[kind.name].columns for trace in (a, b)]
        for f in kind.fields:
            there = [f.name in column for column in columns]
            if there[0] != there[1]:
                found.append((f"{kind.name}.{f.name}", there.index(True)))
    return found


def differing(field, one, other, eps):
    """(unequal, apart), (K,) bool each: which entries of two columns (..., K) of a Field are not the same,
    and which by more than rounding. What is not a number is equal to what is not."""
    if field.domain in _WHOLE:
        apart = one != other
        return apart, apart
    one, other = (np.atleast_2d(column).astype(np.float64) for column in (one, other))
    gap = (one != other) & ~(np.isnan(one) & np.isnan(other))
    unequal = gap.any(axis=0)
    some = np.flatnonzero(unequal)
    apart = np.zeros(unequal.shape, bool)
    least = 1.0 if field.domain in _AGAINST_ONE else 0.0
    if field.domain == "point":  # a coordinate near 0 is rounded like the largest
        least = max(np.abs(column[np.isfinite(column)]).max(initial=0.0) for column in (one, other))
    one, other = one[:, some], other[:, some]
    with np.errstate(all="ignore"):
        size = np.maximum(np.abs(one), np.abs(other)).max(axis=0, initial=0.0)
        size = np.maximum(size, least)
        within = (np.abs(one - other) <= eps * size) & np.isfinite(one) & np.isfinite(other)
    apart[some] = (gap[:, some] & ~within).any(axis=0)
    return unequal, apart
