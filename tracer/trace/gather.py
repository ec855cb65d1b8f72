"""Traces a picture, or some of its pixels, with every event kept, wave by wave."""

import numpy as np

from tracer.engine import waves
from tracer.events import CAMERA, END, HIT, KINDS
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave
from tracer.recorder import left_out
from tracer.trace.trace import Table, Trace, join

LANES = 1 << 14  # paths of one part: about 16 MB of events


def gather(scene, settings, steps=RIGHT, pixels=None):
    """The Trace of all samples of a picture, or of some of its pixels: (P,) numbers, line by line.

    It is kept in memory whole, about 1 kB a path: `parts` gives it piece by piece.
    """
    return join(parts(scene, settings, steps, pixels))


def parts(scene, settings, steps=RIGHT, pixels=None, lanes=LANES):
    """Traces of about `lanes` paths each, in the order of pixel and sample, that make up the whole."""
    settings = settings.at_size_of(scene)
    scene = scene.at(settings)
    numbers = np.arange(settings.width * settings.height) if pixels is None else np.asarray(pixels)
    step = max(1, lanes // settings.spp)
    for begin in range(0, numbers.size, step):
        pixel = np.repeat(numbers[begin : begin + step], settings.spp)
        sample = np.tile(np.arange(settings.spp), pixel.size // settings.spp)
        wave = Wave(pixel % settings.width, pixel // settings.width, sample, settings, steps)
        yield part(waves.events(scene, settings, wave), scene, settings, wave)


def part(events, scene, settings, wave):
    """Exhaust a loop's events and return the Trace of its wave: lane k is path k."""
    done = np.zeros(wave.x.size, np.int32)
    seen = {kind.name: [] for kind in KINDS}
    for event in events:
        seen[event.kind.name].append((event, done[event.lane]))
        done[event.lane] += 1
    tables = {kind.name: _table(kind, seen[kind.name], scene.dtype) for kind in KINDS}
    vertices = np.bincount(tables[HIT.name].path, minlength=wave.x.size)
    film, end = tables[CAMERA.name], tables[END.name]  # one of each a path, in its order
    paths = {
        "x": wave.x,
        "y": wave.y,
        "sample": wave.sample,
        "film": film["film"],
        "radiance": end["radiance"],
        "end": end["reason"],
        "vertices": vertices,
    }
    return Trace(scene, settings, paths, tables, float(np.finfo(scene.dtype).eps))


def _table(kind, seen, dtype):
    """One table of the events (Event, steps) of a kind, sorted by path and step."""
    if not seen:
        columns = {f.name: np.empty((*f.shape, 0), dtype) for f in kind.fields if f.carried}
        none = np.empty(0, np.int64)
        return Table(none, none, none, columns)
    lane = np.concatenate([event.lane for event, _ in seen])
    step = np.concatenate([steps for _, steps in seen])
    depth = np.concatenate([event.depth for event, _ in seen])
    order = np.lexsort((step, lane))
    whole = [event.columns | left_out(event, dtype) for event, _ in seen]
    columns = {
        f.name: np.concatenate([columns[f.name] for columns in whole], axis=-1)[..., order]
        for f in kind.fields
        if f.carried
    }
    return Table(lane[order], step[order], depth[order], columns)
