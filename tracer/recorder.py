"""Keeps what a loop yields, and hands it back path by path."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tracer.events import CAMERA, END, END_REASONS, HIT


class RecordedEvent:
    """One event of one path. kind, step (its place in the path), depth (0 at the first hit)."""

    def __init__(self, kind, step, depth, columns, row):
        self.kind, self.step, self.depth = kind, step, depth
        self._columns, self._row = columns, row

    @cached_property
    def values(self):
        """Field name -> NumPy scalar or (k,) array, carried and derived fields alike."""
        return {f.name: self._columns[f.name][..., self._row][()] for f in self.kind.fields}

    def as_dict(self, scene):
        """Plain values: names instead of table numbers, null for NaN, "inf" for infinity."""
        fields = {f.name: plain(self.values[f.name], f, scene) for f in self.kind.fields}
        return {"kind": self.kind.name, "step": self.step, "depth": self.depth} | fields


@dataclass(frozen=True)
class RecordedPath:
    """One path: where it began, what it brought back, how it ended, and all that happened between."""

    x: int
    y: int
    sample: int
    film: np.ndarray  # (2,) film position in pixels
    radiance: np.ndarray  # (3,) as it counts in the pixel
    end: str  # one of events.END_REASONS
    events: tuple

    def as_dict(self, scene):
        """Plain values, as `castray inspect --json` prints them."""
        return {
            "sample": self.sample,
            "film": [number(v) for v in self.film],
            "radiance": [number(v) for v in self.radiance],
            "end": self.end,
            "events": [event.as_dict(scene) for event in self.events],
        }


def record(events, scene, wave):
    """Exhaust a loop's events and return the wave's paths, in order of lane."""
    rows = [[] for _ in range(wave.x.size)]
    vertex = {}
    for event in events:
        columns = dict(event.columns) | left_out(event, scene.dtype)
        if event.kind is HIT:
            _remember(vertex, event, wave.x.size)
        here = {name: column[..., event.lane] for name, column in vertex.items()}
        for field in event.kind.fields:
            if not field.carried:
                columns[field.name] = field.derive(event.columns, here, scene)
        for row, (lane, depth) in enumerate(zip(event.lane.tolist(), event.depth.tolist(), strict=True)):
            rows[lane].append(RecordedEvent(event.kind, len(rows[lane]), depth, columns, row))
    return tuple(_path(wave, lane, tuple(events)) for lane, events in enumerate(rows))


def left_out(event, dtype):
    """The columns that the loop had nothing to say about."""
    return {
        f.name: np.full((*f.shape, event.lane.size), f.otherwise, dtype)
        for f in event.kind.fields
        if f.otherwise is not None and f.name not in event.columns
    }


def _remember(vertex, event, lanes):
    """Keep, per lane of the wave, the columns of its latest HIT."""
    for name, column in event.columns.items():
        if name not in vertex:
            vertex[name] = np.zeros((*column.shape[:-1], lanes), column.dtype)
        vertex[name][..., event.lane] = column


def _path(wave, lane, events):
    first, last = events[0], events[-1]
    assert first.kind is CAMERA and last.kind is END
    return RecordedPath(
        int(wave.x[lane]),
        int(wave.y[lane]),
        int(wave.sample[lane]),
        first.values["film"],
        last.values["radiance"],
        END_REASONS[int(last.values["reason"])],
        events,
    )


def number(value):
    """A NumPy scalar as JSON can hold it: the shortest digits that give the same bits back in its own
    precision, None for NaN, "inf" or "-inf" for infinity."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value)
    if np.isnan(value):
        return None
    if np.isinf(value):
        return "inf" if value > 0 else "-inf"
    return float(str(value))


def plain(value, field, scene):
    """A field's value as JSON can hold it, with names for what stands in a table."""
    tables = {
        "choice": field.choices,
        "shape": [shape.name for shape in scene.shapes],
        "bsdf": scene.bsdf_names,
        "light": scene.light_names,
    }
    if field.domain in tables:
        return None if value < 0 else tables[field.domain][int(value)]
    if np.ndim(value):
        return [number(v) for v in value]
    return number(value)
