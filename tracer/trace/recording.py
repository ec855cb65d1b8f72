"""Renders a picture and keeps what happened to its paths in a folder: `castray render --record`.

The picture falls into parts of about the same number of bytes, pixel by pixel; each is traced, written and
forgotten, so memory does not grow with the picture, and any process may do any part. A part that is there
already is read instead of traced: that is how a recording that was stopped goes on.
"""

import shutil
from functools import partial
from pathlib import Path
from typing import NamedTuple
from uuid import uuid4

import numpy as np

from tracer import film
from tracer.engine import waves
from tracer.engine.memory import keep_freed
from tracer.engine.parts import Part, cut, folded, whole
from tracer.engine.parts import wave as wave_of
from tracer.engine.picture import Picture, SoFar, asked, results
from tracer.events import CAMERA, END, END_REASONS, ESCAPE, HIT, KINDS
from tracer.integrator.steps import RIGHT
from tracer.settings import TracerError
from tracer.trace import columns, folder, parquet, stored_scene
from tracer.trace.fingerprint import fingerprint
from tracer.trace.gather import seen, table
from tracer.trace.trace import Trace

PART_BYTES = 64 << 20  # of events in memory: four times that is used while a part is traced and written
PATHS_IN_PART = 1 << 18  # at level "paths": few enough to be lost, enough that flushing a part costs little
BYTES_OF_PATH = 40  # of one row of paths on disk, at most
SHARE = 0.45  # bytes on disk of one byte of events, at most: measured on all scenes that come with castray
PILOT = 256  # pixels looked at to learn how long paths are
INVALID = END_REASONS.index("invalid")


class Kept(NamedTuple):
    """What a part brings to the film."""

    task: Part
    blocks: list  # (slice of pixels, film.Block), a pixel's in order
    rays: int
    dropped: int


def record(scene, settings, path, level="paths", progress=None, workers=1, steps=RIGHT, cluster=None):
    """Render `scene` as tracer.render does, bit for bit, and keep its paths in the folder `path`.

    level: "paths", a row for each, or "events", everything that happened. Where the same recording was begun
    before, it goes on: what is there is not traced again. progress, workers, steps, cluster: as for render;
    a cluster's workers write into the folder, which all of them must see. Ctrl-C, and a cluster that is lost,
    return the picture so far with complete = False. Raises TracerError: if the folder has something else in
    it, if the disk has too little room, if it cannot be written.
    """
    if level not in folder.LEVELS:
        raise TracerError(f"record_level: {level!r} is not known; choose one of {', '.join(folder.LEVELS)}")
    settings = asked(scene, settings, steps)
    scene = scene.at(settings)
    path = Path(path).absolute() if cluster else Path(path)  # workers stand elsewhere
    place = _begun(scene, settings, path, level, steps)
    parts = list(parts_of(settings, place.header["lanes"]))
    so_far = SoFar.begin(settings)
    job = partial(keep, scene, settings, steps, place)
    done, total = 0, settings.width * settings.height * settings.spp
    with so_far.going():
        for kept in results(job, [parts], total, workers, cluster):
            for pixels, block in kept.blocks:
                so_far.sheet.add(pixels, block)
            so_far.add(kept)
            done += kept.task.paths
            if progress:
                progress(done, total)
    return Picture.of(so_far, settings)


def _begun(scene, settings, path, level, steps):
    """The recording's Folder, with its header; TracerError if the disk lacks the room."""
    description, files = stored_scene.described(scene)
    of_path = bytes_of_path(scene, settings, steps) if level == "events" else BYTES_OF_PATH
    lanes = PATHS_IN_PART
    if level == "events":
        lanes = max(film.BLOCK, min(waves.LANES, int(PART_BYTES / of_path) // film.BLOCK * film.BLOCK))
    parts = sum(1 for _ in parts_of(settings, lanes))
    if parts > folder.MOST_PARTS:
        raise TracerError(
            f"{path}: would have {parts} parts, and a recording has {folder.MOST_PARTS} at most; "
            "ask for fewer --spp or a smaller --size"
        )
    header = {
        "format": folder.FORMAT,
        "level": level,
        "parts": parts,
        "lanes": lanes,
        "settings": settings.as_dict(),
        "scene": {"name": scene.name, "description": description, "files": sorted(files)},
        "fingerprint": fingerprint(),
        "names": columns.names_of(scene),
    }
    share = SHARE if level == "events" else 1.0
    needed = of_path * share * settings.width * settings.height * settings.spp
    needed += sum(file.stat().st_size for file in files.values())
    _check_room(path, needed)

    def put(there):
        folder.remove_unfinished(there)
        stored_scene.keep(there, description, files)

    return folder.begin(path, header, put)


def _check_room(path, needed):
    """TracerError if so many bytes, less those that are there, do not fit on the disk."""
    near = next(p for p in (path, *path.absolute().parents) if p.exists())
    there = sum(file.stat().st_size for file in path.rglob("*.parquet")) if path.is_dir() else 0
    free = shutil.disk_usage(near).free
    if needed - there > free:
        raise TracerError(
            f"{path}: takes about {needed / 1e9:.3g} GB and the disk has {free / 1e9:.3g} GB free; "
            "ask for fewer --spp, a smaller --size, or --record-level paths"
        )


def bytes_of_path(scene, settings, steps=RIGHT):
    """About how many bytes the events of one path are, as columns in memory."""
    numbers = np.arange(settings.width * settings.height)
    numbers = np.unique(np.linspace(0, numbers.size - 1, min(PILOT, numbers.size)).astype(np.int64))
    samples = min(settings.spp, 4)
    part = Part(0, slice(0, numbers.size), 0, samples)
    wave = wave_of(numbers, part, settings, steps)
    size = 0
    for event in waves.events(scene, settings, wave):
        row = sum(c.itemsize * (c.size // max(event.lane.size, 1)) for c in event.columns.values())
        row += sum(np.dtype(kind).itemsize for kind in columns.OWN_TYPES.values())
        if event.kind.name in columns.AT_VERTEX:
            row += 12 * np.dtype(scene.dtype).itemsize + 8
        size += row * event.lane.size
    return size / wave.x.size


def parts_of(settings, lanes):
    """The parts of a recording of about `lanes` paths each, in the order of pixel and sample."""
    return cut(whole(settings), lanes)


def keep(scene, settings, steps, place, part):
    """Trace a part and write it, or read it if it is there; what it brings to the film, a Kept."""
    keep_freed()
    if place.part(part.number).is_dir():
        return read_part(place, settings, part)
    found, blocks, rays, dropped = [], [], 0, 0
    step = max(1, waves.LANES // part.samples)
    for start in range(part.pixels.start, part.pixels.stop, step):
        pixels = slice(start, min(start + step, part.pixels.stop))
        wave = wave_of(np.arange(pixels.start, pixels.stop), part, settings, steps)
        events = waves.events(scene, settings, wave)
        if place.level == "events":
            found.append(_all(events, scene, settings, wave))
        else:
            found.append({"paths": columns.of_paths(_paths(events, wave))})
        blocks += folded(pixels, part, settings, wave.radiance)
        rays, dropped = rays + wave.rays, dropped + wave.dropped
    _write(place, part, found, rays)
    return Kept(part, blocks, rays, dropped)


def _paths(events, wave):
    """One row a path. Only how paths end is looked at: it tells how many vertices there were."""
    depth, escaped = np.full(wave.x.size, -1, np.int32), np.zeros(wave.x.size, np.int32)
    reason = np.zeros(wave.x.size, np.int8)
    place = None
    for event in events:
        if event.kind is END:
            depth[event.lane] = event.depth
            reason[event.lane] = event.columns["reason"]
        elif event.kind is ESCAPE:
            escaped[event.lane] = 1
        elif event.kind is CAMERA:
            place = event.columns["film"]
    vertices = depth + 1 - escaped if wave.settings.max_depth else np.zeros_like(depth)
    own = {"x": wave.x, "y": wave.y, "sample": wave.sample, "film": place, "radiance": wave.radiance}
    return own | {"vertices": vertices, "end": reason}


def _all(events, scene, settings, wave):
    """Every event, by kind, and the paths."""
    stages = seen(events, wave)
    found = {kind.name: table(kind, stages.pop(kind.name), scene.dtype) for kind in KINDS}
    end = found[END.name][0]
    paths = {
        "x": wave.x,
        "y": wave.y,
        "sample": wave.sample,
        "film": found[CAMERA.name][0]["film"],
        "radiance": end["radiance"],
        "end": end["reason"],
        "vertices": np.bincount(found[HIT.name][0].path, minlength=wave.x.size),
    }
    tables = {name: one for name, (one, _) in found.items()}
    trace = Trace(scene, settings, paths, tables, float(np.finfo(scene.dtype).eps))
    flat = columns.of_paths(paths)
    own = flat | {"path": columns.numbers(paths, settings)}
    of_kinds = {kind.name: columns.of_events(kind, trace, found[kind.name][1], own) for kind in KINDS}
    return {"paths": flat} | of_kinds


def _write(place, part, found, rays):
    """Put a part into its folder, whole or not at all. found: of each of its waves {table: flat columns}."""
    goal = place.part(part.number)
    beside = goal.with_name(f"{goal.name}.{uuid4().hex}{folder.PARTIAL}")
    try:
        beside.mkdir()
        for name in found[0]:
            flat = found[0][name]
            if len(found) > 1:
                flat = {column: np.concatenate([one[name][column] for one in found]) for column in flat}
            file = beside / f"{name}.parquet"
            if name == "paths":
                parquet.write(file, flat, parquet.QUICK, rays=rays)
            else:
                parquet.write(file, flat, parquet.SMALL)
            folder.flush(file)
        folder.flush(beside)
        _put(beside, goal)
        folder.flush(place.path)
    except (OSError, TracerError) as error:
        shutil.rmtree(beside, ignore_errors=True)
        said = error if isinstance(error, TracerError) else f"{goal}: {error.strerror or error}"
        raise TracerError(f"{said} (the parts that are done are kept)") from None


def _put(beside, goal):
    """Give a written part its name, unless another worker that seemed dead has finished it meanwhile."""
    try:
        beside.rename(goal)
    except OSError:
        if not goal.is_dir():
            raise
        shutil.rmtree(beside)


def read_part(place, settings, part):
    """What a part that is there brings to the film."""
    file = place.file(part.number, "paths")
    folder.check_file(file)
    there = parquet.read([file], ["radiance_r", "radiance_g", "radiance_b", "reason"])
    radiance = np.stack([there[f"radiance_{c}"] for c in "rgb"])
    if radiance.shape[1] != part.paths:
        raise TracerError(f"{file}: has {radiance.shape[1]} paths where {part.paths} belong")
    dropped = int(np.count_nonzero(there["reason"] == INVALID))
    blocks = folded(part.pixels, part, settings, radiance)
    return Kept(part, blocks, int(parquet.notes(file)["rays"]), dropped)
