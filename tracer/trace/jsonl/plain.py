"""Lines of plain numbers, thousands at once, by DuckDB's JSON reader.

A line without its digits is its skeleton. Lines of one skeleton have the same names, signs and brackets, so
one of them, read with care, says how to read all; what DuckDB then refuses or does not find is read with care
itself. So no line is taken here that would not be taken there, with the same numbers.
"""

import json
from dataclasses import dataclass
from functools import cached_property

import numpy as np

BLOCK = 1 << 23  # bytes that are looked at together
LEAST = 256  # lines of one skeleton that are worth a question
_DIGITS = b"0123456789+-.eE"


@dataclass(frozen=True)
class Shape:
    """How lines of a skeleton are read. kind: of the event, None for calls; sizes: name -> numbers that it
    has; query: SQL that makes columns of lines."""

    kind: str | None
    sizes: dict
    query: str


class Plain:
    """Knows the shapes of lines. fields: kind, or None for calls -> {name: Field}."""

    def __init__(self, fields):
        self.fields, self.shapes = fields, {}

    def read(self, lines):
        """Columns of many lines, and what is left: a list of (kind, rows (K,), {name: (..., K) float64}), and
        the rows that need care, in order. lines: bytes each."""
        block = b"\n".join(lines)
        if len(block) < BLOCK // 2:  # not worth to load DuckDB for
            return [], range(len(lines))
        groups: dict[bytes, list] = {}
        for row, skeleton in enumerate(block.translate(None, _DIGITS).split(b"\n")):
            rows = groups.get(skeleton)
            if rows is None:
                rows = groups[skeleton] = []
            rows.append(row)
        found, left = [], []
        for skeleton, rows in groups.items():
            columns = None
            if len(rows) >= LEAST:
                if skeleton not in self.shapes:
                    self.shapes[skeleton] = self._shape(lines[rows[0]])
                shape = self.shapes[skeleton]
                columns = None if shape is None else self._columns(shape, [lines[row] for row in rows])
            if columns is None:
                left += rows
            else:
                found.append((shape.kind, np.array(rows), columns))
        return found, sorted(left)

    def _shape(self, line):
        """The Shape that an example shows; None where it holds anything but known names and numbers."""
        try:
            record = json.loads(line, object_pairs_hook=_once, parse_constant=_refused)
        except (ValueError, RecursionError):
            return None
        if not isinstance(record, dict):
            return None
        kind = record.pop("kind", None)
        known = self.fields.get(kind, {}) if kind is None or isinstance(kind, str) else {}
        if not record or not known.keys() >= record.keys():
            return None
        types = {name: _type(known[name], value) for name, value in record.items()}
        if None in types.values():
            return None
        sizes = {name: len(value) if isinstance(value, list) else 0 for name, value in record.items()}
        return Shape(kind, sizes, _query(kind, types, sizes))

    @cached_property
    def _database(self):
        import duckdb

        return duckdb.connect(config={"threads": 1})

    def _columns(self, shape, lines):
        """{name: (..., N) float64} of lines; None where one of them is not what its skeleton says."""
        import duckdb

        try:
            found = self._database.execute(shape.query, [b"\n".join(lines).decode("ascii")]).fetchnumpy()
        except (duckdb.Error, UnicodeDecodeError):
            return None
        flat = list(found.values())
        if any(np.ma.is_masked(column) or len(column) != len(lines) for column in flat):
            return None
        flat = [np.ma.getdata(column) for column in flat]
        if shape.kind is not None and not flat.pop(0).all():
            return None
        columns, at = {}, 0
        for name, size in shape.sizes.items():
            own = flat[at : at + max(size, 1)]
            columns[name] = np.stack(own).astype(np.float64) if size else own[0].astype(np.float64)
            at += len(own)
        return columns


def _once(pairs):
    """A dictionary of pairs; ValueError where a name comes twice."""
    record = dict(pairs)
    if len(record) < len(pairs):
        raise ValueError
    return record


def _refused(_):
    raise ValueError


def _type(f, value):
    """The type of a Field's value in DuckDB, None where it is no plain number of the field's."""
    if f.shape:
        plain = isinstance(value, list) and len(value) == f.shape[0] and {*map(type, value)} <= {int, float}
        return ["DOUBLE"] if plain else None
    if type(value) is bool:
        return "BOOLEAN" if f.domain == "flag" else None
    return "DOUBLE" if type(value) in (int, float) else None


def _query(kind, types, sizes):
    chosen = [] if kind is None else [f"v['kind'] = '{kind}' AS c"]
    for name, size in sizes.items():
        chosen += [f"v['{name}'][{k + 1}] AS c{len(chosen) + k}" for k in range(size)] or [
            f"v['{name}'] AS c{len(chosen)}"
        ]
    form = json.dumps(types if kind is None else {"kind": "VARCHAR"} | types)
    return (
        f"SELECT {', '.join(chosen)} FROM (SELECT from_json(line, '{form}') AS v "
        "FROM (SELECT unnest(string_split($1, chr(10))) AS line))"
    )
