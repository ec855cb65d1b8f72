"""Which paths of two traces belong together, and their events one after the other."""

from dataclasses import dataclass

import numpy as np

from tracer.events import KINDS
from tracer.settings import TracerError

_NUMBERS = ("seed", "sampler", "replicates", "width", "height")  # settings that random numbers hang on
_OF_LATTICE = ("spp",)


def check_same_numbers(a, b, names):
    """TracerError if two traces cannot have the same random numbers."""
    wanted = _NUMBERS + (_OF_LATTICE if a.settings.sampler == "lattice" else ())
    for option in wanted:
        one, other = getattr(a.settings, option), getattr(b.settings, option)
        if one != other:
            raise TracerError(
                f"twin: {option} is {one} in {names[0]} and {other} in {names[1]}: their random numbers "
                "are not the same, so no path of one is the twin of one of the other"
            )


@dataclass(frozen=True)
class Pairs:
    """Paths of two traces with the same pixel and sample, in the order of the first."""

    a: np.ndarray  # (P,) rows of the first trace's paths
    b: np.ndarray  # (P,) of the second's
    alone: tuple  # number of paths of the first, of the second, that have no twin

    @property
    def size(self):
        """Number of pairs."""
        return self.a.size


def paired(a, b):
    """The Pairs of two traces."""
    one, other = _keys(a), _keys(b)
    order = np.argsort(other, kind="stable")
    place = np.searchsorted(other[order], one).clip(max=max(other.size - 1, 0))
    rows = order[place] if other.size else np.zeros(one.size, np.intp)
    twin = other[rows] == one if other.size else np.zeros(one.size, bool)
    pairs = int(np.count_nonzero(twin))
    return Pairs(np.flatnonzero(twin), rows[twin], (one.size - pairs, other.size - pairs))


def _keys(trace):
    """A number for each path that says pixel and sample, and how many of the same came before it, (P,)."""
    x, y, sample = (trace.paths[name].astype(np.int64) for name in ("x", "y", "sample"))
    place = (y << 48) | (x << 32) | sample
    order = np.argsort(place, kind="stable")
    ranked = place[order]
    begins = np.r_[True, ranked[1:] != ranked[:-1]] if ranked.size else np.zeros(0, bool)
    if begins.all():
        return place
    again = np.empty(place.size, np.int64)
    starts = np.flatnonzero(begins)
    again[order] = np.arange(place.size) - np.repeat(starts, np.diff(np.r_[starts, place.size]))
    return place + (again << 60)


@dataclass(frozen=True)
class Events:
    """The events of some paths of a trace, path by path in their order, whatever their kind."""

    kind: np.ndarray  # (E,) number in events.KINDS
    row: np.ndarray  # (E,) row in that kind's table
    step: np.ndarray  # (E,)
    depth: np.ndarray  # (E,)
    begin: np.ndarray  # (P + 1,) where each path's begin

    @property
    def lengths(self):
        """Number of events of each path, (P,)."""
        return np.diff(self.begin)


def events_of(trace, rows):
    """The Events of the paths at `rows` (P,)."""
    number = np.full(trace.size, -1, np.int64)
    number[rows] = np.arange(rows.size)
    parts = []
    for code, kind in enumerate(KINDS):
        table = trace.tables[kind.name]
        of_path = number[table.path]
        here = np.flatnonzero(of_path >= 0)
        parts.append((of_path[here], table.step[here], np.full(here.size, code), here, table.depth[here]))
    path, step, code_of, row, depth = (np.concatenate(column) for column in zip(*parts, strict=True))
    order = np.lexsort((step, path))
    begin = np.searchsorted(path[order], np.arange(rows.size + 1))
    return Events(code_of[order], row[order], step[order], depth[order], begin)
