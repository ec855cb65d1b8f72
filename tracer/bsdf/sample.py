"""What a BSDF answers when it is asked for a direction."""

from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np


class Sample(NamedTuple):
    """One sampled direction per lane, with what eval and pdf say about it."""

    wi: np.ndarray  # (3, N) local direction
    f: np.ndarray  # (3, N) BSDF in sr^-1; the scattered fraction at a Dirac lobe
    pdf: np.ndarray  # (N,) density in sr^-1; a probability at a Dirac lobe
    delta: np.ndarray  # (N,) whether the lobe is a Dirac one
    lobe: np.ndarray  # (N,) index into events.LOBES

    def take(self, lanes):
        """The samples of some lanes."""
        return Sample(*(column.take(lanes, axis=-1) for column in self))


class Material:
    """What all materials share: their parameters are arrays with one column per material or lane."""

    delta = False
    one_sided = True

    def take(self, row):
        """The same material with the columns `row` (N,) of its parameters."""
        return replace(self, **{f.name: _columns(getattr(self, f.name), row) for f in fields(self)})

    def astype(self, dtype):
        """The same material with floating point parameters of another precision."""
        changed = {f.name: _cast(getattr(self, f.name), dtype) for f in fields(self)}
        return replace(self, **changed)


def _columns(value, row):
    return value.take(row, axis=-1) if isinstance(value, np.ndarray) else value


def _cast(value, dtype):
    return value.astype(dtype) if isinstance(value, np.ndarray) else value
