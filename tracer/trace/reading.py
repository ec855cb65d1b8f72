"""A recording on disk as a Trace, whole or part by part."""

import numpy as np

from tracer import film
from tracer.events import KINDS
from tracer.settings import TracerError
from tracer.trace import columns, folder, parquet, stored_scene
from tracer.trace.recording import parts_of, read_part
from tracer.trace.trace import Table, Trace, join

_PATHS = (
    "x",
    "y",
    "sample",
    "film_x",
    "film_y",
    "radiance_r",
    "radiance_g",
    "radiance_b",
    "vertices",
    "reason",
)


def read_trace(path, scene=None):
    """The Trace of a recording's folder, whole, in memory; `read_parts` gives it piece by piece.

    scene: the Scene it is of, if that is not in the recording. At level "paths" the tables of events are
    empty. Raises TracerError.
    """
    return join(read_parts(path, scene))


def read_parts(path, scene=None, numbers=None):
    """Traces of the parts of a recording, one after the other; rows of paths count anew in each.

    numbers: of the parts wanted, ascending; all unless said.
    """
    place = folder.whole(path)
    settings = place.settings
    scene = scene or stored_scene.restore(place.path, place.header["scene"]["name"])
    scene = scene.at(settings)
    _check_names(place, scene)
    for number in range(place.parts) if numbers is None else numbers:
        yield _part(place, number, scene, settings)


def _check_names(place, scene):
    """TracerError if a scene is not the one that was recorded."""
    there, here = place.header["names"], columns.names_of(scene)
    for what, names in here.items():
        if there.get(what) != names:
            raise TracerError(f"{place.path}: names of each {what} are not those of the scene {scene.name}")


def _part(place, number, scene, settings):
    there = parquet.read([place.file(number, "paths")], _PATHS)
    paths = {
        "x": there["x"].astype(np.int64),
        "y": there["y"].astype(np.int64),
        "sample": there["sample"],
        "film": columns.whole("film", there, "xy"),
        "radiance": columns.whole("radiance", there, "rgb"),
        "end": there["reason"],
        "vertices": there["vertices"].astype(np.int64),
    }
    numbers = columns.numbers(paths, settings)
    tables = {kind.name: _table(place, number, kind, numbers) for kind in KINDS}
    return Trace(scene, settings, paths, tables, float(np.finfo(scene.dtype).eps))


def _table(place, number, kind, paths):
    """The events of a kind; paths: (P,) the part's numbers of paths, ascending."""
    if not place.kinds:
        none = np.empty(0, np.int64)
        return Table(none, none, none, {})
    fields = [f for f in kind.fields if f.carried]
    wanted = ["path", "step", "depth"]
    wanted += [name for f in fields for name in columns.flat_names(f)]
    file = place.file(number, kind.name)
    there = parquet.read([file], wanted)
    row = np.searchsorted(paths, there["path"])
    if (row >= paths.size).any() or (paths[row] != there["path"]).any():
        raise TracerError(f"{file}: has events of paths that are not in it")
    found = {f.name: columns.whole(f.name, there, columns.axes_of(f)) for f in fields}
    return Table(row, there["step"], there["depth"], found)


def stored_pixel(place, x, y):
    """The value (3,) float32 of a pixel as it was recorded."""
    wanted = ", ".join(f"radiance_{c}" for c in "rgb")
    question = (
        f"SELECT {wanted} FROM {parquet.source(place.files('paths'))} WHERE x = ? AND y = ? ORDER BY sample"
    )
    with parquet.explained(place.path):
        there = parquet.connection().execute(question, [x, y]).fetchnumpy()
    return film.gather(np.stack([there[f"radiance_{c}"] for c in "rgb"]), place.settings.parts).mean()[:, 0]


def picture(place):
    """The picture (H, W, 3) float32 of a Folder that is whole, bit for bit as it was rendered."""
    settings = place.settings
    sheet = film.Film(settings.width * settings.height, settings.parts)
    for part in parts_of(settings, place.header["lanes"]):
        for pixels, block in read_part(place, settings, part).blocks:
            sheet.add(pixels, block)
    return np.ascontiguousarray(sheet.mean().T).reshape(settings.height, settings.width, 3)
