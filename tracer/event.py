"""One event of a path, and how a kind of event and its fields are declared; `events` declares them all.

A field is *carried* (the loop has it anyway) or *derived*: declared with a pure function of carried fields
and the scene, `derive(event, vertex, scene)`, where `event` and `vertex` map names to columns (component
first, one lane per row of the event) and `vertex` is the last HIT of the same paths. Only those who look
evaluate it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tracer.lanes import gather

NUMBERED = ("shape", "bsdf", "light", "choice", "index")  # domains of whole numbers, of which -1 is none


@dataclass(frozen=True)
class Field:
    """One named quantity of an event.

    shape: () or (k,). domain: what values are lawful; "choice" and the scene's tables ("shape", "bsdf",
    "light") are whole numbers that stand for a name. otherwise: what a carried field is where the loop leaves
    it out because the scene has no such thing; readers are then not shown it.
    """

    name: str
    meaning: str
    shape: tuple = ()
    domain: str = "real"
    unit: str = ""
    choices: tuple = ()
    derive: Callable | None = None
    otherwise: float | None = None

    @property
    def carried(self):
        """Whether the loop yields it (otherwise it is derived)."""
        return self.derive is None

    @property
    def blank(self):
        """What stands where it is not known or does not apply."""
        if self.otherwise is not None:
            return self.otherwise
        if self.domain == "flag":
            return False
        return -1 if self.domain in NUMBERED else np.nan


class Sparse(NamedTuple):
    """A column that says something of few lanes only; whoever reads it sees it whole."""

    lanes: np.ndarray  # (K,) which
    values: np.ndarray  # (..., K)
    size: int  # N
    otherwise: float  # what it is elsewhere

    def whole(self):
        """The column (..., N)."""
        column = np.full((*self.values.shape[:-1], self.size), self.otherwise, self.values.dtype)
        column[..., self.lanes] = self.values
        return column


class Event:
    """What one stage of the loop did: columns of one kind, one entry per path that took part.

    Never written to again. A lane below 0 is that of a path that was over before and is still carried along:
    who reads the event does not see it.
    """

    def __init__(self, kind, lane, depth, columns):
        self.kind, self._lane, self._depth, self._given = kind, lane, depth, columns

    @cached_property
    def _seen(self):
        """Which entries are of paths under way, None for all."""
        return None if self._lane.min(initial=0) >= 0 else np.flatnonzero(self._lane >= 0)

    def _of_seen(self, column):
        whole = column.whole() if isinstance(column, Sparse) else column
        return whole if self._seen is None else gather(whole, self._seen)

    @cached_property
    def lane(self):
        """(N,) places in the wave."""
        return self._of_seen(self._lane)

    @cached_property
    def depth(self):
        """(N,) bounces before it."""
        return self._of_seen(self._depth)

    @cached_property
    def columns(self):
        """name -> (..., N) array."""
        return {name: self._of_seen(column) for name, column in self._given.items()}


@dataclass(frozen=True)
class Kind:
    """A kind of event; calling it makes one, and a missing or unknown column is a TypeError there."""

    name: str
    meaning: str
    fields: tuple

    @cached_property
    def carried(self):
        """Names of the fields that the loop yields."""
        return frozenset(f.name for f in self.fields if f.carried)

    @cached_property
    def needed(self):
        """Names of those that it always yields."""
        return frozenset(f.name for f in self.fields if f.carried and f.otherwise is None)

    def __call__(self, lane, depth, **columns):
        if not self.needed <= columns.keys() <= self.carried:
            odd = ", ".join(sorted((self.needed - columns.keys()) | (columns.keys() - self.carried)))
            raise TypeError(f"{self.name} event: missing or unknown: {odd}")
        return Event(self, lane, depth, columns)

    def field(self, name):
        """The declaration of one field; KeyError if there is none."""
        for f in self.fields:
            if f.name == name:
                return f
        raise KeyError(f"{self.name} has no field {name}")
