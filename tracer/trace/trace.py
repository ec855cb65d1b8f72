"""A recording in memory: one row per path, and one table of columns for each kind of event.

Whoever judges a trace looks at this only, wherever it came from: castray's own loop, a file, the log of
another tracer. A foreign log need not have every field: a column that was not recorded is not there.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tracer.events import HIT, KINDS


@dataclass(frozen=True)
class Table:
    """The events of one kind, in the order of path and step."""

    path: np.ndarray  # (E,) row of its path
    step: np.ndarray  # (E,) place in the path, counting from 0
    depth: np.ndarray  # (E,) bounces before it
    columns: dict  # field name -> (..., E); fields that were not recorded are left out

    def __getitem__(self, name):
        """The column of a field, None if it was not recorded."""
        return self.columns.get(name)

    def take(self, rows):
        """Some rows of it: (K,) numbers, (E,) bool or a slice."""
        columns = {name: column[..., rows] for name, column in self.columns.items()}
        return Table(self.path[rows], self.step[rows], self.depth[rows], columns)


@dataclass(frozen=True)
class Trace:
    """What happened to some paths.

    paths: name -> (..., P) column: x, y, sample, film (2), radiance (3), end (number in events.END_REASONS),
    vertices. tables: name of a kind -> Table, for each of events.KINDS. eps: relative precision of the
    numbers: the machine epsilon of the loop's, or half a unit of the last printed digit. rebuilt: fields,
    "kind.field", that were not recorded but worked out from others and the scene. assumed: those of them that
    were worked out by the very law about them, so that they cannot break it.
    culled: whether rays may have passed the backs of surfaces: many programs cull them, castray does not.
    free: settings that the program chose otherwise at every vertex, or did not declare ("size", of the
    picture; "roulette-start", the depth from which on roulette is played), so that no law says what they
    have to be.
    light_samples: how many a vertex has, whose mean counts.
    left_out: how many more paths there were, which are not here for what they did, so that those that are
    here are no fair sample.
    """

    scene: Any  # a Scene, in the precision of the settings
    settings: Any  # Settings, as far as they are known
    paths: dict
    tables: dict
    eps: float
    rebuilt: frozenset = frozenset()
    assumed: frozenset = frozenset()
    culled: bool = False
    left_out: int = 0
    free: frozenset = frozenset()
    light_samples: int = 1

    @property
    def size(self):
        """Number of paths."""
        return self.paths["x"].size

    @property
    def vertices(self):
        """Number of surfaces met by all paths together."""
        return self.tables[HIT.name].path.size

    def hit_of(self, kind):
        """For each event of a kind (by name), the row of its path's last HIT before it; -1 if none, (E,)."""
        return self._hits[kind]

    @cached_property
    def _hits(self):
        hits, most = (
            self.tables[HIT.name],
            1 + max(table.step.max(initial=0) for table in self.tables.values()),
        )
        keys = hits.path * most + hits.step
        found = {}
        for name, table in self.tables.items():
            before = np.searchsorted(keys, table.path * most + table.step) - 1
            there = (before >= 0) & (hits.path.take(before) == table.path) if keys.size else before >= 0
            found[name] = np.where(there, before, -1)
        return found

    def column(self, kind, name):
        """A field (..., E) of all events of a kind, carried or derived; None where it was not recorded and
        cannot be derived from what was. Where it needs a vertex and none was recorded before the event, it is
        the field's blank."""
        table = self.tables[kind]
        if name in table.columns:
            return table[name]
        field = next(k for k in KINDS if k.name == kind).field(name)
        if field.carried:
            return None
        hits, row = self.tables[HIT.name], self.hit_of(kind)
        if kind == HIT.name:
            return self._derived(field, table, hits.columns)
        if not hits.path.size:
            return self._derived(field, table, {})
        column = self._derived(field, table, hits.take(row).columns)
        astray = np.flatnonzero(row < 0)  # they were given the last vertex of all
        if column is None or not astray.size or self._derived(field, table.take(astray), {}) is not None:
            return column
        return np.where(row < 0, field.blank, column)

    def _derived(self, field, table, vertex):
        """What a derived field is; None where something that it is made from was not recorded."""
        try:
            with np.errstate(all="ignore"):
                return field.derive(table.columns, vertex, self.scene)
        except KeyError:
            return None

    def take(self, rows):
        """The trace of some paths only: (K,) ascending numbers or (P,) bool."""
        keep = np.zeros(self.size, bool)
        keep[rows] = True
        number = np.cumsum(keep) - 1
        tables = {}
        for name, table in self.tables.items():
            here = table.take(np.flatnonzero(keep[table.path]))
            tables[name] = replace(here, path=number[here.path])
        return replace(self, paths={name: c[..., keep] for name, c in self.paths.items()}, tables=tables)

    def span(self, begin, end):
        """The trace of paths begin to end - 1 only; its columns are views of this one's."""
        tables = {}
        for name, table in self.tables.items():
            here = table.take(slice(*np.searchsorted(table.path, (begin, end))))
            tables[name] = replace(here, path=here.path - begin)
        return replace(self, paths={name: c[..., begin:end] for name, c in self.paths.items()}, tables=tables)


def replaced_steps(trace, steps):
    """The trace with its events in other places of their paths: steps is kind -> (E,)."""
    tables = {name: replace(table, step=steps[name]) for name, table in trace.tables.items()}
    return replace(trace, tables=tables)


def join(traces):
    """One trace of several of the same scene and settings, their paths one after the other."""
    traces = list(traces)
    begins = np.cumsum([0] + [trace.size for trace in traces])
    tables = {}
    for kind in (k.name for k in KINDS):
        parts = [trace.tables[kind] for trace in traces]
        names = [name for name in parts[0].columns if all(name in part.columns for part in parts)]
        tables[kind] = Table(
            np.concatenate([part.path + begin for part, begin in zip(parts, begins, strict=False)]),
            np.concatenate([part.step for part in parts]),
            np.concatenate([part.depth for part in parts]),
            {name: np.concatenate([part.columns[name] for part in parts], axis=-1) for name in names},
        )
    paths = {
        name: np.concatenate([trace.paths[name] for trace in traces], axis=-1) for name in traces[0].paths
    }
    return replace(traces[0], paths=paths, tables=tables)
