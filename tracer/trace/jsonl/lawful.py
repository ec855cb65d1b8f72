"""What a field of a log may be: which numbers, and how they may be spelled."""

import numpy as np

from tracer.trace.jsonl.spelling import number, short

WHOLE = ("whole", "pixel", "index", "shape", "bsdf", "light", "choice")
_TABLES = ("shape", "bsdf", "light")
_MOST_WHOLE = 2**53


class Lawful:
    """The numbers that stand for something in one log.

    tables: domain -> names that stand for numbers, and "primitive": how many there are. options: those of the
    log's header.
    """

    def __init__(self, tables, options):
        self.tables, self.options = tables, options

    def value(self, f, value):
        """What a value of any spelling is as numbers; ValueError saying what is wrong. f: the Field."""
        if f.shape:
            if not isinstance(value, (list, tuple)) or len(value) != f.shape[0]:
                raise ValueError(f"{short(value)} is not a list of {f.shape[0]} numbers")
            return [number(v) for v in value]
        names = self.tables.get(f.domain, ()) if f.domain in _TABLES else f.choices
        if isinstance(value, str) and (names or f.domain in _TABLES):
            if value not in names:
                raise ValueError(f"{short(value)} is not known; choose one of {', '.join(names[:12])}")
            return names.index(value)
        if value is None and f.domain in _TABLES:
            return -1
        return number(value)

    def outside(self, f, name, array):
        """Which numbers (N,) of a field mean nothing, (N,) bool, and what is to be said of them; None where
        any number will do."""
        if f.domain == "flag":
            return (array != 0) & (array != 1), "is neither true nor false"
        if f.domain not in WHOLE:
            return None
        least, most = -1 if f.domain in ("index", *_TABLES) else 0, self._most(f, name)
        fine = (array >= least) & (array <= most) & (array == np.floor(array))
        return ~fine, f"is not a whole number from {least} to {most}"

    def _most(self, f, name):
        size = {"x": "width", "y": "height"}.get(name)
        if f.domain == "pixel" and size in self.options:
            return self.options[size] - 1
        if f.domain == "choice":
            return len(f.choices) - 1
        if name.endswith("primitive") and "primitive" in self.tables:
            return self.tables["primitive"] - 1
        if f.domain in _TABLES and f.domain in self.tables:
            return len(self.tables[f.domain]) - 1
        return 65534 if f.domain == "pixel" else _MOST_WHOLE
