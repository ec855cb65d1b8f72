"""Two traces with the same random numbers compared: a Twin."""

from collections import Counter
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tracer.events import KINDS
from tracer.settings import TracerError, both_told
from tracer.twin.pairing import check_same_numbers, events_of, paired
from tracer.twin.parting import KIND, MISSING, Firsts, causal, differing, firsts, uncompared
from tracer.twin.shares import Share, told

__all__ = ["Cause", "Parting", "Share", "Twin", "compare"]

NAMES = ("the first", "the second")
_LOUD = ("bug",)  # settings that are to differ


class Number(NamedTuple):
    """A field of an event that differs, with both values."""

    field: Any  # event.Field
    values: tuple


@dataclass(frozen=True)
class Parting:
    """Where one pair of paths parts. Of each trace: kinds (None where its path was over), steps, depths.

    what: the field that differs first, or "kind", "depth" or "event" (which one of them lacks). numbers: all
    fields of that event that differ. radiance: (3,) of each path, None where it was not recorded.
    """

    x: int
    y: int
    sample: int
    kinds: tuple
    steps: tuple
    depths: tuple
    what: str
    numbers: tuple
    radiance: tuple | None

    def place(self, step):
        """x, y, sample and a step of one of the two, 0 where it has none."""
        return self.x, self.y, self.sample, step or 0


@dataclass(frozen=True)
class Cause:
    """Pairs of paths that part at the same kind of event and in the same field.

    difference: what their radiance brings to the difference of the means, (red, green, blue), None where it
    was not recorded; depths: {depth: pairs}; also: {field: pairs}, what else differs there by any bit;
    example: the pair with the largest difference among them.
    """

    kinds: tuple
    what: str
    pairs: int
    depths: dict
    difference: tuple | None
    also: dict
    example: Parting


@dataclass(frozen=True)
class Twin:
    """What two traces of the same random numbers have in common, and what not.

    pairs: paths that both have; alone: (2,) paths that only one has; rounded: pairs that differ within
    rounding only; causes: the most frequent first; largest: pairs with the largest difference of radiance.
    told: which share of the difference enters at which depth and technique (shares.Told), None where no
    radiance was recorded. error: (3,) standard error of the mean difference, None where samples are not
    independent. uncompared: ("kind.field", number of the trace that has it). notes: sentences to read with
    it.
    """

    names: tuple
    pairs: int
    alone: tuple
    differing: int
    rounded: int
    causes: tuple
    largest: tuple
    told: Any
    error: np.ndarray | None
    uncompared: tuple
    notes: tuple

    @property
    def same(self):
        """Whether no event differs by more than rounding, and no path is without its twin."""
        return not self.differing and not any(self.alone)


def compare(a, b, names=NAMES, most=5, exact=False):
    """The Twin of two Traces.

    names: what to call them; most: how many pairs with the largest difference to name; exact: whether every
    bit counts, otherwise roundings of one number are the same. Raises TracerError where the random numbers
    cannot be the same, or where no events were recorded.
    """
    check_same_numbers(a, b, names)
    for trace, name in zip((a, b), names, strict=True):
        if not any(table.path.size for table in trace.tables.values()):
            raise TracerError(f"twin: {name} has no events; a recording needs --record-level events")
    pairs = paired(a, b)
    if not pairs.size:
        raise TracerError(f"twin: {names[0]} and {names[1]} have no pixel and sample in common")
    events = events_of(a, pairs.a), events_of(b, pairs.b)
    found = firsts(a, b, events, exact)
    share = told((a, b), pairs)
    view = _View((a, b), pairs, events, found, None if share is None else share.radiance)
    return Twin(
        tuple(names), pairs.size, pairs.alone, found.pair.size, found.rounded, view.causes(),
        view.largest(most), share, _error(share, pairs.size, a.settings), tuple(uncompared(a, b)),
        tuple(_notes(a, b)),
    )  # fmt: skip


def _error(share, pairs, settings):
    if share is None or settings.parts is not None or pairs < 2:
        return None
    return np.nanstd(share.radiance, axis=1, ddof=1) / np.sqrt(pairs)


def _notes(a, b):
    """What is different about the two traces as a whole."""
    if a.scene.name != b.scene.name:
        yield f"The scenes are not the same: {a.scene.name} and {b.scene.name}."
    one, other = a.settings.as_dict(), b.settings.as_dict()
    odd = [name for name in one if one[name] != other[name] and name not in _LOUD]
    if odd:
        yield f"Settings differ: {both_told(one, other, odd)}."


@dataclass(frozen=True)
class _View:
    """Both traces with all that was found of them."""

    traces: tuple
    pairs: Any
    events: tuple
    firsts: Firsts
    radiance: np.ndarray | None  # (3, P)

    @property
    def _loudness(self):
        """How much each parting pair's radiance differs, (D,)."""
        if self.radiance is None:
            return np.zeros(self.firsts.pair.size)
        return np.nan_to_num(np.abs(self.radiance[:, self.firsts.pair]).sum(axis=0), nan=np.inf)

    def _kinds(self):
        """Number in KINDS, -1 for none, of the events at which each pair parts, (2, D)."""
        return np.stack(
            [
                np.where(place >= 0, e.kind[place], -1)
                for e, place in zip(self.events, self.firsts[1:3], strict=True)
            ]
        )

    def _depths(self):
        """Depth of the event at which each pair parts, (D,)."""
        (one, other), (_, a, b, *_) = self.events, self.firsts
        return np.where(a >= 0, one.depth[a], other.depth[b])

    def causes(self):
        """The Causes, the most frequent first."""
        loud, kinds = self._loudness, self._kinds()
        keys = list(zip(*kinds.tolist(), self.firsts.what, strict=True))
        members = {}
        for k, key in enumerate(keys):
            members.setdefault(key, []).append(k)
        ordered = sorted(members.items(), key=lambda item: -len(item[1]))
        return tuple(self._cause(key, np.array(rows), loud) for key, rows in ordered)

    def _cause(self, key, rows, loud):
        example = self.parting(int(rows[np.argmax(loud[rows])]))
        difference = None
        if self.radiance is not None:
            brought = self.radiance[:, self.firsts.pair[rows]]
            difference = tuple(float(v) for v in np.nansum(brought, axis=1) / self.pairs.size)
        depths = self._depths()[rows]
        return Cause(
            example.kinds, key[2], rows.size, dict(sorted(Counter(depths.tolist()).items())),
            difference, self._also(rows, example), example,
        )  # fmt: skip

    def _also(self, rows, example):
        """{field: pairs} of what differs by any bit at the event at which these pairs part."""
        if example.what in (KIND, MISSING):
            return {}
        places = (self.firsts.a[rows], self.firsts.b[rows])
        columns = self._columns(places)
        counts = {f.name: int(differing(f, one, other, 0.0)[0].sum()) for f, (one, other) in columns}
        return {name: count for name, count in counts.items() if count and name != example.what}

    def _columns(self, places):
        """[(Field, both columns (..., K))] of some events of one kind, of all that both traces have."""
        kind = KINDS[self.events[0].kind[places[0][0]]]
        rows = [e.row[p] for e, p in zip(self.events, places, strict=True)]
        tables = [trace.tables[kind.name] for trace in self.traces]
        there = [f for f in causal(kind) if all(table[f.name] is not None for table in tables)]
        return [
            (f, [table[f.name].take(row, axis=-1) for table, row in zip(tables, rows, strict=True)])
            for f in there
        ]

    def largest(self, most):
        """Partings of the pairs whose radiance differs most."""
        loud = self._loudness
        order = np.argsort(-loud, kind="stable")[:most]
        return tuple(self.parting(int(k)) for k in order)

    def parting(self, k):
        """The Parting of the k-th pair that parts."""
        places = (int(self.firsts.a[k]), int(self.firsts.b[k]))
        pair = int(self.firsts.pair[k])
        row = int(self.pairs.a[pair])
        x, y, sample = (int(self.traces[0].paths[name][row]) for name in ("x", "y", "sample"))
        kinds, steps, depths = zip(
            *(self._place(e, p) for e, p in zip(self.events, places, strict=True)), strict=True
        )
        what = self.firsts.what[k]
        numbers = () if what in (KIND, MISSING) else tuple(self._numbers(places))
        radiance = None
        if self.radiance is not None:
            rows = (self.pairs.a[pair], self.pairs.b[pair])
            radiance = tuple(t.paths["radiance"][:, r] for t, r in zip(self.traces, rows, strict=True))
        return Parting(x, y, sample, kinds, steps, depths, what, numbers, radiance)

    def _place(self, events, place):
        if place < 0:
            return None, None, None
        return KINDS[events.kind[place]].name, int(events.step[place]), int(events.depth[place])

    def _numbers(self, places):
        """The Numbers of one event that differ by any bit, causes first."""
        columns = self._columns([np.array([place]) for place in places])
        for field, (one, other) in columns:
            if differing(field, one, other, 0.0)[0].any():
                yield Number(field, (one[..., 0], other[..., 0]))
