"""Lines of a log become columns: bounded memory whatever the file holds, and every mistake has its place."""

import gc

import numpy as np

from tracer.events import KINDS
from tracer.settings import TracerError
from tracer.trace.jsonl import header, plain
from tracer.trace.jsonl.content import Columns, Read
from tracer.trace.jsonl.lawful import WHOLE, Lawful
from tracer.trace.jsonl.schema import call_fields, event_fields
from tracer.trace.jsonl.spelling import decoded, plain_numbers

LONGEST = 1 << 20  # bytes of a line
CHUNK = 1 << 12  # lines that are kept as objects at once
_KIND = {kind.name: kind for kind in KINDS}


def read(path, tables=None):
    """The Read of a log. tables: domain -> names that stand for numbers ("shape", "bsdf", "light"), and
    "primitive": how many there are. TracerError where nothing can be made of the file."""
    collecting = gc.isenabled()
    gc.disable()  # lists of numbers have no cycles; looking for some takes longer than reading
    try:
        with open(path, "rb") as file:
            return _read(path, file, tables or {})
    except OSError as error:
        raise TracerError(f"{path}: {error.strerror or error}") from None
    finally:
        if collecting:
            gc.enable()


def _read(path, file, tables):
    found, line = _headed(path, file)
    gathering, rest = Gathering(found, tables), b""
    while block := file.read(plain.BLOCK):
        whole, end, rest = (rest + block).rpartition(b"\n")
        lines = whole.split(b"\n") if end else []
        for at, raw in enumerate((*lines, rest), line + 1):
            if len(raw) >= LONGEST:
                raise _too_long(path, at)
        gathering.lines(lines, line + 1)
        line += len(lines)
    gathering.line(rest, line + 1, ended=False)
    found.columns = gathering.finish()
    if not found.columns:
        if found.mistakes:
            raise TracerError(f"{path}: no line can be read; {found.mistakes[0]}")
        raise TracerError(f"{path}: no line can be read")
    if None in found.columns and len(found.columns) > 1:
        raise TracerError(f"{path}: holds calls and events (lines with kind); a log has one of the two")
    return found


def _headed(path, file):
    """The Read of a file's header, and the number of its line."""
    line = 0
    while raw := file.readline(LONGEST + 1):
        line += 1
        if len(raw) > LONGEST:
            raise _too_long(path, line)
        if raw.strip():
            place = f"{path}: line {line}"
            record, why = decoded(raw.removeprefix(b"\xef\xbb\xbf"))
            if why:
                raise TracerError(f"{place}: {why}; a log is JSON Lines (castray log --schema)")
            return Read(header.parsed(record, place)), line
    raise TracerError(f"{path}: empty; the first line of a log is its header (castray log --schema)")


def _too_long(path, line):
    return TracerError(
        f"{path}: line {line} is longer than {LONGEST >> 20} MB; a log has one event or call a line"
    )


class Gathering:
    """Gathers lines with the same fields and makes blocks of columns of them, a chunk at a time."""

    def __init__(self, found, tables):
        self.found, self.lawful = found, Lawful(tables, found.header.options)
        self.dtype = np.float32 if found.header.bits == 32 else np.float64
        self.groups, self.waiting = {}, 0
        self.blocks = {}  # kind -> [(lines, values)]
        self.fields = {None: call_fields()} | {name: event_fields(kind) for name, kind in _KIND.items()}
        self.plain = plain.Plain(self.fields)

    def lines(self, lines, first):
        """Whole lines of bytes, the first of this number."""
        found, left = self.plain.read(lines)
        for kind, rows, columns in found:
            self.found.lines += rows.size
            self._checked_block(kind, rows + first, columns)
        for row in left:
            self.line(lines[row], first + row)

    def line(self, raw, place, ended=True):
        """One line of bytes; ended: whether it has its end."""
        if not raw.strip():
            return
        record, why = decoded(raw)
        self.found.lines += 1
        if why and not ended:
            self.found.cut = True
        elif why or not isinstance(record, dict):
            self.found.tell(place, "", why or "not an object")
        else:
            self.add(record, place)

    def add(self, record, place):
        """One line."""
        kind = record.pop("kind", None)
        if kind is None and "child" in record:
            self._nested(record, place)
            return
        if kind is not None and (not isinstance(kind, str) or kind not in _KIND):
            self.found.tell(place, "kind", f"{kind!r:.30} is not known; choose one of {', '.join(_KIND)}")
            return
        key = (kind, *record)
        group = self.groups.get(key)
        if group is None:
            group = self.groups[key] = []
        group.append((place, tuple(record.values())))
        self.waiting += 1
        if self.waiting >= CHUNK:
            self._flush()

    def _nested(self, record, place):
        """A call with its inner calls within: each becomes a line of its own."""
        shared = {name: record[name] for name in ("path", "x", "y", "sample") if name in record}
        call = 0
        while isinstance(record, dict):
            child = record.pop("child", None)
            self.add(shared | record | {"call": call, "parent": call - 1}, place)
            record, call = child, call + 1
        if record is not None:
            self.found.tell(place, "child", f"{record!r:.30} is not an object")

    def _flush(self):
        for (kind, *names), group in self.groups.items():
            self._block(kind, names, group)
        self.groups, self.waiting = {}, 0

    def _block(self, kind, names, group):
        known = self.fields[kind]
        lines = np.array([number for number, _ in group])
        columns, fine = {}, np.ones(lines.size, bool)
        for name, column in zip(names, zip(*(row for _, row in group), strict=True), strict=True):
            if name in known:
                columns[name] = self._column(known[name], name, column, lines, fine)
            else:
                self.found.unknown.setdefault(name, int(lines[0]))
        self._checked_block(kind, lines, columns, fine)

    def _column(self, f, name, column, lines, fine):
        """The (..., N) array of one field; takes wrong lines out of `fine` (N,)."""
        array = plain_numbers(f, column)
        if array is None:
            array = np.zeros((*f.shape, len(column)))
            for k, value in enumerate(column):
                try:
                    array[..., k] = self.lawful.value(f, value)
                except ValueError as error:
                    fine[k] = False
                    self.found.tell(int(lines[k]), name, str(error))
        return array

    def _checked_block(self, kind, lines, columns, fine=True):
        """Keep columns name -> (..., N) of lines (N,), but for those that are not `fine` or out of range."""
        known, values, good = self.fields[kind], {}, np.ones(lines.size, bool) & fine
        for name, array in columns.items():
            f = known[name]
            if wrong := self.lawful.outside(f, name, array):
                bad, what = wrong
                good &= ~bad
                for k in np.flatnonzero(bad):
                    self.found.tell(int(lines[k]), name, f"{array[k]:.15g} {what}")
            dtype = np.int64 if f.domain in WHOLE else np.uint8 if f.domain == "flag" else self.dtype
            if dtype is not self.dtype:
                array = np.where(good, array, 0)
            with np.errstate(over="ignore", invalid="ignore"):
                values[name] = array.astype(dtype)
        if not good.all():
            lines, values = lines[good], {name: array[..., good] for name, array in values.items()}
        if lines.size and values:
            self.blocks.setdefault(kind, []).append((lines, values))

    def finish(self):
        """Name of a kind, or None -> Columns."""
        self._flush()
        kinds = list(self.blocks)
        return {kind: self._joined(kind, self.blocks.pop(kind)) for kind in kinds}

    def _joined(self, kind, blocks):
        known = self.fields[kind]
        size = sum(lines.size for lines, _ in blocks)
        names = dict.fromkeys(name for _, values in blocks for name in values)
        line = np.concatenate([lines for lines, _ in blocks])
        values, given = {}, {}
        for name in names:
            first = next(block[name] for _, block in blocks if name in block)
            blank = np.nan if first.dtype.kind == "f" else 0
            values[name] = np.full((*known[name].shape, size), blank, first.dtype)
            given[name] = np.zeros(size, bool)
            at = 0
            for lines, block in blocks:
                if name in block:
                    values[name][..., at : at + lines.size] = block.pop(name)
                    given[name][at : at + lines.size] = True
                at += lines.size
        found = Columns(line, values, given)
        return found if (np.diff(line) >= 0).all() else found.take(np.argsort(line, kind="stable"))
