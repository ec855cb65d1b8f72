"""Logs of other tracers become Traces."""

from dataclasses import dataclass, replace

import numpy as np

from tracer.events import KINDS
from tracer.settings import TracerError
from tracer.trace.jsonl import (
    calls,
    conventions,
    flat,
    geometry,
    header,
    hemisphere,
    lines,
    peek,
    places,
    survival,
    told,
    undeclared,
)
from tracer.trace.jsonl.compact import compact
from tracer.trace.jsonl.content import Read
from tracer.trace.trace import Table, Trace

_PLACE = ("path", "x", "y", "sample", "step", "depth")


@dataclass(frozen=True)
class Log:
    """What a file holds. trace: a Trace, None if no scene was given; notes: what was found out beside the
    mistakes, in words; read_off: settings that were not declared but could be told from the numbers."""

    read: Read
    trace: Trace | None
    notes: tuple
    read_off: dict

    @property
    def mistakes(self):
        """The first Mistakes of the file."""
        return tuple(self.read.mistakes)


def read_log(path, scene=None, options=None):
    """The Log in a JSON Lines file, its trace made with a Scene. options: Settings that count more than those
    that the file declares. TracerError, one line, where nothing can be made of the file."""
    read = lines.read(path, _tables(scene))
    if options:
        read.header.options.update(options)
    read_off = undeclared.read_off(read)
    settings = header.settings_of(read.header, read_off)
    free = undeclared.free(read, read_off)
    settings, without = _without_lights(read, settings)
    notes = _notes(read) + without
    if scene is None:
        return Log(read, None, tuple(notes), read_off)
    if settings.width is None or settings.height is None:
        settings = replace(settings, width=scene.width, height=scene.height)
    exact = scene.at(replace(settings, precision=64))
    notes += conventions.complaints(read.columns, read.header, exact)
    conventions.convert(read.columns, read.header, exact)
    make = _of_calls if None in read.columns else _of_events
    trace, more = make(read, scene.at(settings), exact, settings, read_off)
    trace = replace(trace, free=free | trace.free)
    if not trace.size:
        raise TracerError(f"{path}: no path is whole; {'; '.join(more)}")
    return Log(read, trace, tuple(notes + more), read_off)


def _without_lights(read, settings):
    """Settings for a log that has no light samples, so that none are missed, and a note on it."""
    names = set(read.columns) | set(getattr(read.columns.get(None), "values", ()))
    if settings.integrator == "walk" or any(str(n).startswith(("light", "direct")) for n in names):
        return settings, []
    note = "no light samples are logged (light.q, ..., direct): nothing of direct light can be checked"
    return replace(settings, integrator="walk", strategy="mis"), [note]


def _tables(scene):
    if scene is None:
        return {}
    return {
        "shape": [shape.name for shape in scene.shapes],
        "bsdf": list(scene.bsdf_names),
        "light": list(scene.light_names),
        "primitive": scene.shape_of.size,
    }


def _notes(read):
    notes = [
        f"{name!r:.40} is no field of this format and is left out (first in line {line})"
        for name, line in read.unknown.items()
    ]
    if read.cut:
        notes.append("the last line ends in its middle: it is left out")
    return notes


def _of_calls(read, scene, exact, settings, read_off):
    chain = calls.chained(read.columns.pop(None))
    if not chain.path.size:
        return Trace(scene, settings, {"x": np.empty(0)}, {}, read.header.eps), chain.notes
    free = frozenset()
    if "roulette" in read_off and not _played_throughout(chain):
        del read_off["roulette"]
        settings, free = replace(settings, roulette="auto"), frozenset({"roulette"})
    where = places.placed(chain, exact)
    if read.header.turned["n"] == "facing":
        real, _ = geometry.surfaces(exact, where.p, where.d, where.primitive)
        where.n *= np.where((where.n * real).sum(axis=0) < 0.0, -1.0, 1.0)
        where.ng = np.where(np.isfinite(real), real, where.ng)
    notes = list(conventions.complaints_of_scene(chain, where, exact, settings, read.header))
    places.put_somewhere(where, exact)
    chain, where = places.culled(chain, where)
    chain, where = peek.peeked(chain, where, exact)
    known = settings.roulette != "off" or "roulette" in read.header.options
    sampled = "hemisphere" in read.header.options or settings.hemisphere == "uniform"
    if not sampled and not chain.given("bounce.pdf").any():
        settings = replace(settings, hemisphere=hemisphere.shown(chain, where, exact) or settings.hemisphere)
        read_off["hemisphere"] = settings.hemisphere
        scene, exact = scene.at(settings), exact.at(replace(settings, precision=64))
    telling = told.Telling(chain, where, exact, scene.dtype, settings, read.header.eps, known, sampled)
    tables = telling.tables()
    dark = int(np.count_nonzero(telling.dark[telling.rows["hit"]]))
    if not known and (q := survival.shown(tables, dark)) is not None:
        read_off |= {"roulette": f"{q:.9g}"}
        read_off.pop("max_depth", None)
        settings = replace(settings, roulette=read_off["roulette"], max_depth=-1)
        scene = scene.at(settings)
        telling = told.Telling(chain, where, exact, scene.dtype, settings, read.header.eps, True, sampled)
        tables = telling.tables()
    root = telling.rows["camera"]
    assumed = telling.assumed | _summed(tables)
    paths = _paths(
        tables, {name: _value(chain.columns, name, root) for name in ("x", "y", "sample")}, root.size
    )
    rebuilt = frozenset(telling.rebuilt)
    trace = Trace(
        scene, settings, compact(paths, scene.dtype), tables, read.header.eps, rebuilt, frozenset(assumed),
        free=free, culled=True, left_out=chain.left_out,
    )  # fmt: skip
    return trace, [*chain.notes, *notes, *_at_some(telling.partly)]


def _at_some(partly):
    """What is said of numbers that some events of a kind have and not all."""
    return [
        f"{', '.join(sorted(names))}: tested at the {some} of {all_} such events that log it"
        for (_, some, all_), names in partly.items()
    ]


def _played_throughout(chain):
    """Whether roulette is logged by all calls that went on: where it is not, it was not played."""
    given = chain.given("roulette.probability")
    return not given.any() or bool(given[~chain.last].all())


def _value(columns, name, rows):
    if name not in columns.values:
        return np.arange(rows.size) if name == "sample" else np.zeros(rows.size, np.int64)
    return columns.values[name][rows].astype(np.int64)


def _summed(tables):
    """Whether the radiance of paths will be the sum of their terms, as the name of what is assumed then."""
    return {"path.radiance"} if tables["end"]["radiance"] is None else set()


def _paths(tables, place, size):
    """Columns of the table of paths; radiance and end as END has them, radiance else as the sum of terms.
    What only some of the paths say is not known."""
    end = tables["end"]
    every = {kind: np.array_equal(tables[kind].path, np.arange(size)) for kind in ("camera", "end")}
    paths = dict(place)
    film = tables["camera"]["film"]
    if film is not None and every["camera"]:
        paths["film"] = film
    if end["radiance"] is not None:
        if every["end"]:
            paths["radiance"] = end["radiance"]
    elif all(
        tables[kind]["contribution"] is not None
        for kind in ("hit", "light", "escape")
        if tables[kind].path.size
    ):
        total = np.zeros((3, size))
        for kind in ("hit", "light", "escape"):
            for channel in range(3):
                if tables[kind].path.size:
                    gain = tables[kind]["contribution"][channel]
                    total[channel] += np.bincount(tables[kind].path, gain, size)
        paths["radiance"] = total
        end.columns["radiance"] = total[:, end.path]
    if end["reason"] is not None and every["end"]:
        paths["end"] = end["reason"]
    paths["vertices"] = np.bincount(tables["hit"].path, minlength=size)
    for name in ("reason", "radiance"):
        if end[name] is None:
            end.columns.pop(name, None)
    return paths


def _of_events(read, scene, exact, settings, read_off):
    """The Trace of lines that are events already."""
    keys = [_keys(found) for found in read.columns.values()]
    kinds = list(read.columns)
    _, first, number = np.unique(np.concatenate(keys), return_index=True, return_inverse=True)
    splits = np.cumsum([key.size for key in keys])[:-1]
    of_kind = dict(zip(kinds, np.split(number, splits), strict=True))
    place = {
        name: np.concatenate([_all(read.columns[kind], name) for kind in kinds])[first]
        for name in ("x", "y", "sample")
    }
    steps = _steps(read.columns, of_kind)
    tables = {}
    if "light" in read.columns:
        flat.asked_where_due(read.columns["light"])
    for kind in (k.name for k in KINDS):
        if kind not in read.columns:
            none = np.empty(0, np.int64)
            tables[kind] = Table(none, none, none, {})
            continue
        found, path, step = read.columns[kind], of_kind[kind], steps[kind]
        order = np.lexsort((step, path))
        columns = {
            name: column[..., order]
            for name, column in found.values.items()
            if found.given[name].all() and name not in _PLACE
        }
        depth = found.values.get("depth", np.zeros(path.size, np.int64))
        tables[kind] = Table(path[order], step[order], depth[order], columns)
    notes = _partly(read.columns)
    _with_ends(tables, first.size)
    more = flat.Completed(exact, tables)
    assumed = more.assumed | _summed(tables)
    free = frozenset()
    if "roulette" in read_off and tables["roulette"].path.size < tables["bounce"].path.size:
        del read_off["roulette"]  # it is played at some bounces only
        settings, free = replace(settings, roulette="auto"), frozenset({"roulette"})
    paths = _paths(tables, place, first.size)
    tables = {
        name: replace(table, columns=compact(table.columns, scene.dtype)) for name, table in tables.items()
    }
    trace = Trace(
        scene, settings, compact(paths, scene.dtype), tables, read.header.eps,
        frozenset(more.rebuilt), frozenset(assumed), free=free, culled=True,
    )  # fmt: skip
    return trace, notes + more.notes


def _partly(columns):
    """What is said of fields that only some events of a kind have."""
    return [
        f"{kind}.{name} is in {np.count_nonzero(given)} of {given.size} such lines only: it is left out"
        for kind, found in columns.items()
        for name, given in found.given.items()
        if given.any() and not given.all() and name not in _PLACE
    ]


def _all(found, name):
    return found.values.get(name, np.zeros(found.size, np.int64)).astype(np.int64)


def _keys(found):
    if "path" in found.values and found.given["path"].all():
        return found.values["path"]
    return ((_all(found, "y") * 65536 + _all(found, "x")) << 24) + _all(found, "sample")


def _steps(columns, of_kind):
    """Place of each event in its path, kind -> (N,): as logged, else in the order of lines."""
    if all("step" in found.values and found.given["step"].all() for found in columns.values()):
        return {kind: found.values["step"] for kind, found in columns.items()}
    line = np.concatenate([found.line for found in columns.values()])
    path = np.concatenate([of_kind[kind] for kind in columns])
    order = np.lexsort((line, path))
    begins = np.flatnonzero(np.r_[True, path[order][1:] != path[order][:-1]])
    step = np.empty(line.size, np.int64)
    step[order] = np.arange(line.size) - np.repeat(begins, np.diff(np.r_[begins, line.size]))
    splits = np.cumsum([found.size for found in columns.values()])[:-1]
    return dict(zip(columns, np.split(step, splits), strict=True))


def _with_ends(tables, size):
    """An END for every path that has none."""
    if tables["end"].path.size:
        return
    last = np.full(size, -1)
    for table in tables.values():
        np.maximum.at(last, table.path, table.step)
    tables["end"] = Table(np.arange(size), last + 1, np.zeros(size, np.int64), {})
