"""A pixel of a Trace as `tracer.inspect` gives one, and its picture: whoever shows castray's paths can show
those of any tracer.

What was not recorded and cannot be worked out is blank, as its Field says: NaN, no name (-1), False.
"""

import numpy as np

from tracer import film
from tracer.engine.picture import Picture, PixelRecord
from tracer.events import END_REASONS, KINDS, UNSAID
from tracer.recorder import RecordedEvent, RecordedPath
from tracer.settings import TracerError
from tracer.trace.trace import Trace, replaced_steps


def without_gaps(trace: Trace):
    """The trace with its events numbered 0, 1, 2, ... in each path: a log may leave out some."""
    tables = list(trace.tables.values())
    path, step = (np.concatenate([getattr(t, name) for t in tables]) for name in ("path", "step"))
    order = np.lexsort((step, path))
    begins = np.searchsorted(path[order], path[order])
    dense = np.empty(path.size, np.int64)
    dense[order] = np.arange(path.size) - begins
    parts = np.split(dense, np.cumsum([t.path.size for t in tables])[:-1])
    return replaced_steps(trace, dict(zip(trace.tables, parts, strict=True)))


def place(trace, first):
    """(x, y, path, event) at which the viewer has what a finding's `first` names, once the trace is without
    gaps: number of the path among its pixel's, and of the event in it, None for a whole path."""
    here = np.flatnonzero((trace.paths["x"] == first["x"]) & (trace.paths["y"] == first["y"]))
    path = trace.paths["sample"][here].tolist().index(first["sample"])
    if first["step"] is None:
        return first["x"], first["y"], path, None
    before = (
        np.count_nonzero((table.path == here[path]) & (table.step < first["step"]))
        for table in trace.tables.values()
    )
    return first["x"], first["y"], path, int(sum(before))


def pixel(trace, x, y):
    """The PixelRecord of pixel (x, y) of a trace without gaps. Raises TracerError where it has no path."""
    rows = np.flatnonzero((trace.paths["x"] == x) & (trace.paths["y"] == y))
    if not rows.size:
        raise TracerError(f"pixel {x} {y}: no path of it was recorded")
    few = trace.take(rows)
    events = [[] for _ in range(rows.size)]
    for kind in KINDS:
        table, columns = few.tables[kind.name], _columns(few, kind)
        places = zip(table.path.tolist(), table.step.tolist(), table.depth.tolist(), strict=True)
        for row, (path, step, depth) in enumerate(places):
            events[path].append(RecordedEvent(kind, step, depth, columns, row))
    radiance = _radiance(few)
    paths = tuple(
        _path(few, k, radiance[:, k], tuple(sorted(of_path, key=lambda event: event.step)))
        for k, of_path in enumerate(events)
    )
    mean = film.gather(np.nan_to_num(radiance))
    return PixelRecord(x, y, mean.mean()[:, 0], mean.variance()[:, 0], paths, trace.settings)


def picture(trace):
    """The Picture of all paths; black where there are none."""
    settings = trace.settings
    size, shape = settings.width * settings.height, (settings.height, settings.width)
    place = trace.paths["y"].astype(np.int64) * settings.width + trace.paths["x"]
    radiance, samples = _radiance(trace), np.bincount(place, minlength=size)
    finite = np.isfinite(radiance).all(axis=0)
    given = np.where(finite, radiance, 0.0).astype(np.float64)
    total, squares = (
        np.stack([np.bincount(place, channel, size) for channel in sums]) for sums in (given, given * given)
    )
    with np.errstate(all="ignore"):
        mean = total / np.maximum(samples, 1)
        free = np.where(samples > 1, samples * (samples - 1.0), np.nan)
        variance = np.maximum(squares - samples * mean * mean, 0.0) / free
    rgb, spread = (a.T.reshape(*shape, 3).astype(np.float32) for a in (mean, variance))
    return Picture(
        np.ascontiguousarray(rgb),
        spread,
        samples.reshape(shape),
        settings,
        0.0,
        0,
        int((~finite).sum()),
        True,
    )


def _radiance(trace):
    """What every path brings (3, P); NaN where it was not recorded."""
    found = trace.paths.get("radiance")
    return np.full((3, trace.size), np.nan) if found is None else found


def _columns(trace, kind):
    """Every field of a kind's events."""
    columns, size = {}, trace.tables[kind.name].path.size
    for field in kind.fields:
        found = trace.column(kind.name, field.name) if size else None
        columns[field.name] = np.full((*field.shape, size), field.blank) if found is None else found
    return columns


def _path(trace, row, radiance, events):
    columns = trace.paths
    x, y = int(columns["x"][row]), int(columns["y"][row])
    at = columns["film"][:, row] if "film" in columns else np.array([x + 0.5, y + 0.5])
    end = END_REASONS[int(columns["end"][row])] if "end" in columns else UNSAID
    return RecordedPath(x, y, int(columns["sample"][row]), at, radiance, end, events)
