"""Calls of a recursive function, one after the other along each path.

What the function did between two calls is not seen, so where a path ends is worked out: at a black surface,
outside, by roulette, or at a lamp that was looked for before calling again.
"""

from dataclasses import dataclass

import numpy as np

from tracer.trace.jsonl.content import Columns


@dataclass
class Chain:
    """Calls in the order of path and nesting. path: (N,) row of its path; level: (N,) how deep it is nested;
    last: (N,) whether its path has no further call; notes: what was left out, in words; left_out: number of
    paths that were, for what they did."""

    columns: Columns
    path: np.ndarray
    level: np.ndarray
    last: np.ndarray
    notes: list
    left_out: int = 0

    def __call__(self, name):
        """A column (..., N) in float64, NaN where not given."""
        column = self.columns.values.get(name)
        return None if column is None else column.astype(np.float64)

    def given(self, name):
        """Whether each call has a field, (N,)."""
        none = np.zeros(self.path.size, bool)
        return self.columns.given.get(name, none)

    def any(self, name):
        """Whether each call has any field that begins so, (N,)."""
        found = np.zeros(self.path.size, bool)
        for key, mask in self.columns.given.items():
            if key.startswith(name):
                found |= mask
        return found


def path_numbers(columns):
    """Row of its path (N,) of each line, and the line (P,) at which each path begins."""
    values, given = columns.values, columns.given
    if "path" in given and given["path"].all():
        keys = values["path"]
    elif all(name in given and given[name].all() for name in ("x", "y")):
        sample = values["sample"] if "sample" in given else np.zeros(columns.size, np.int64)
        keys = (values["y"] * 65536 + values["x"]) * (int(sample.max()) + 1) + sample
    else:
        keys = np.zeros(columns.size, np.int64)
    _, first, rows = np.unique(keys, return_index=True, return_inverse=True)
    return rows, first


def chained(columns):
    """The Chain of calls in any order. Left out and told of: paths whose first call is not there, and all but
    the last of several calls from one."""
    rows, _ = path_numbers(columns)
    call, parent = _numbered(columns, rows)
    order = np.lexsort((call, rows))
    rows = rows[order]
    above = _above(rows, call[order], parent[order])
    level = _levels(above)
    keep, beside = _followed(above, level)
    notes = []
    if beside:
        notes.append(
            f"{beside} calls have another beside them from the same call: castRay calls itself more than "
            "once; only the last is followed"
        )
    cut = np.unique(rows[level < 0]).size
    if cut:
        notes.append(f"{cut} paths lack a call, or have one twice: these calls are left out")
    order, rows, level = order[keep], rows[keep], level[keep]
    nested = np.lexsort((level, rows))
    columns, rows, level = columns.take(order[nested]), rows[nested], level[nested]
    _, rows = np.unique(rows, return_inverse=True)
    last = np.ones(rows.size, bool)
    last[:-1] = rows[1:] != rows[:-1]
    return Chain(columns, rows, level, last, notes)


def _above(rows, call, parent):
    """The row of the call that called each, (N,), of calls in the order of path and number: -1 for none, -2
    where it is not there or the call is there twice."""
    most = int(call.max()) + 2
    keys = rows * most + call
    above = np.searchsorted(keys, rows * most + parent)
    above = np.where(parent < 0, -1, np.minimum(above, rows.size - 1))
    lost = (parent >= 0) & ((keys[above] != rows * most + parent) | (parent >= call))
    again = np.zeros(rows.size, bool)
    again[1:] = (keys[1:] == keys[:-1]) | ((parent[1:] < 0) & (rows[1:] == rows[:-1]))
    above[lost | again] = -2
    return above


def _followed(above, level):
    """Which calls are followed, (N,), the last of those from one call, and how many are left out for it."""
    keep = level >= 0
    followed = np.zeros(above.size, bool)
    inner = np.flatnonzero(keep & (above >= 0))
    _, where = np.unique(above[inner[::-1]], return_index=True)
    followed[inner[::-1][where]] = True
    while True:  # what hangs on a call that is left out is left out
        fine = keep & ((above < 0) | followed)
        fine &= np.where(above >= 0, fine[np.maximum(above, 0)], fine)
        if np.array_equal(fine, keep):
            return keep, int(inner.size - where.size)
        keep = fine


def _numbered(columns, rows):
    """(call, parent) of each line, (N,); where they are not given, by depth."""
    values, given = columns.values, columns.given
    if "call" in given and given["call"].all() and "parent" in given and given["parent"].all():
        return values["call"], values["parent"]
    depth = values.get("depth", np.zeros(columns.size, np.int64))
    order = np.lexsort((depth, rows))
    begins = np.flatnonzero(np.r_[True, rows[order][1:] != rows[order][:-1]]) if rows.size else rows
    place = np.arange(rows.size) - np.repeat(begins, np.diff(np.r_[begins, rows.size]))
    call = np.empty(rows.size, np.int64)
    call[order] = place
    return call, call - 1


def _levels(above):
    """How deep each call is nested, (N,); -1 for those that hang on nothing. above: (N,) row of the call
    that called it, -1 for none, -2 unknown."""
    level = np.where(above == -1, 0, -1)
    active = np.flatnonzero(above >= 0)
    while active.size:
        of = level[above[active]]
        known = of >= 0
        if not known.any():
            break
        level[active[known]] = of[known] + 1
        active = active[~known]
    return level
