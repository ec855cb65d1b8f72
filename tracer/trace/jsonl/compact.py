"""Columns as a Trace keeps them: in the precision of the settings, whole numbers and flags as such."""

import numpy as np

from tracer.events import KINDS

_FIELDS = [f for kind in KINDS for f in kind.fields]
_WHOLE = {f.name for f in _FIELDS if f.domain in ("index", "shape", "bsdf", "light", "choice")}
_WHOLE |= {"x", "y", "sample", "end", "vertices"}
_FLAGS = {f.name for f in _FIELDS if f.domain == "flag"}


def compact(columns, dtype):
    """name -> column, each as its field has it."""
    return {name: _as(name, column, dtype) for name, column in columns.items()}


def _as(name, column, dtype):
    if name in _WHOLE:
        return column.astype("int32" if name == "primitive" else "int64")
    if name in _FLAGS:
        return column.astype(bool)
    with np.errstate(over="ignore", invalid="ignore"):
        return column.astype(dtype)
