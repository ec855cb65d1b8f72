"""Traces a picture, or some of its pixels, with every event kept, wave by wave."""

from typing import NamedTuple

import numpy as np

from tracer.engine import waves
from tracer.engine.memory import keep_freed
from tracer.event import Event
from tracer.events import CAMERA, END, HIT, KINDS
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave
from tracer.recorder import left_out
from tracer.trace.trace import Table, Trace, join

TABLES = ("index", "shape", "bsdf", "light")  # domains of numbers of things
LANES = 1 << 14  # paths of one part: about 16 MB of events


def gather(scene, settings, steps=RIGHT, pixels=None):
    """The Trace of all samples of a picture, or of some of its pixels: (P,) numbers, line by line.

    It is kept in memory whole, about 1 kB a path: `parts` gives it piece by piece.
    """
    return join(parts(scene, settings, steps, pixels))


def parts(scene, settings, steps=RIGHT, pixels=None, lanes=LANES):
    """Traces of about `lanes` paths each, in the order of pixel and sample, that make up the whole."""
    keep_freed()
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
    stages = seen(events, wave)
    tables = {kind.name: table(kind, stages[kind.name], scene.dtype)[0] for kind in KINDS}
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


class Stage(NamedTuple):
    """An event of a wave, with what only the whole of its paths can tell."""

    event: Event
    step: np.ndarray  # (N,) int32 place in the path
    previous: np.ndarray  # (N,) int8 number in KINDS of the event before it, -1 for none


def seen(events, wave):
    """Exhaust a loop's events; {name of a kind: Stages in the order in which they came}."""
    done, last = np.zeros(wave.x.size, np.int32), np.full(wave.x.size, -1, np.int8)
    stages = {kind.name: [] for kind in KINDS}
    number = {kind.name: np.int8(k) for k, kind in enumerate(KINDS)}
    for event in events:
        step = done.take(event.lane)
        stages[event.kind.name].append(Stage(event, step, last.take(event.lane)))
        done[event.lane] = step + 1
        last[event.lane] = number[event.kind.name]
    return stages


def type_of(field, dtype):
    """The NumPy type of a Field's column where paths are of type dtype."""
    return {"flag": np.bool_, "choice": np.int8}.get(
        field.domain, np.int32 if field.domain in TABLES else dtype
    )


def table(kind, stages, dtype):
    """The Table of the Stages of a kind, sorted by path and step, and in its order what came before (E,)."""
    if not stages:
        columns = {f.name: np.empty((*f.shape, 0), type_of(f, dtype)) for f in kind.fields if f.carried}
        none = np.empty(0, np.int64)
        return Table(none, none, none, columns), np.empty(0, np.int8)
    lane = np.concatenate([stage.event.lane for stage in stages])
    narrow = lane.astype(np.uint16) if lane.max(initial=0) < 1 << 16 else lane  # the quicker way to sort
    order = np.argsort(narrow, kind="stable")  # of one path's events of a kind the earlier came first
    step, previous = (
        np.concatenate([getattr(stage, name) for stage in stages]).take(order)
        for name in ("step", "previous")
    )
    depth = np.concatenate([stage.event.depth for stage in stages]).take(order)
    whole = [stage.event.columns | left_out(stage.event, dtype) for stage in stages]
    columns = {
        f.name: np.concatenate([columns[f.name] for columns in whole], axis=-1).take(order, axis=-1)
        for f in kind.fields
        if f.carried
    }
    return Table(lane.take(order), step, depth, columns), previous
