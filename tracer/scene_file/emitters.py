"""Lights in scene files: what shines by itself, and what a shape's emitter may say."""

import numpy as np

from tracer.light.constant import Constant
from tracer.light.directional import Directional
from tracer.light.envmap import Envmap
from tracer.light.point import Point
from tracer.scene_file import picture_file
from tracer.scene_file.to_world import to_world
from tracer.scene_file.words import Words, colour, real, shown, triple
from tracer.settings import TracerError

BRIGHTEST = 1e30  # radiance: what a path makes of it still fits into single precision
EMITTERS = ("point", "directional", "constant", "envmap")


def emitter(description, place, folder):
    """A light that is no shape. folder: where pictures are looked for."""
    table = Words(description, place)
    kind = table.take("type")
    light = {"point": _point, "directional": _directional, "constant": _constant}.get(kind)
    made = light(table) if light else _envmap(table, folder)
    table.finish()
    return made


def only_one_sky(emitters):
    """TracerError if there is more than one environment: they would hide one another."""
    skies = [e.name for e in emitters if hasattr(e, "radiance")]
    if len(skies) > 1:
        raise TracerError(f"{skies[1]}: a scene has one environment, and {skies[0]} is one already")
    return emitters


def area_emitter(description, place):
    """Radiance (3,) of a shining shape, None if it does not shine."""
    if description is None:
        return None
    table = Words(description, place)
    if table.take("type") != "area":
        raise TracerError(
            f"{place}.type: {shown(description['type'])} is not supported on a shape; known: area"
        )
    radiance = colour(table.take("radiance"), f"{place}.radiance", BRIGHTEST)
    table.finish()
    return radiance


def _matrix(table):
    return to_world(table.take("to_world", []), f"{table.place}.to_world")


def _point(table):
    place = table.place
    if "position" in table.table and "to_world" in table.table:
        raise TracerError(f"{place}.to_world: says where the lamp is once more; give that or position")
    given, matrix = table.take("position", None), _matrix(table)
    position = matrix[:3, 3] if given is None else triple(given, f"{place}.position")
    return Point(place, position, colour(table.take("intensity", 1.0), f"{place}.intensity"))


def _directional(table):
    place = table.place
    if "direction" in table.table and "to_world" in table.table:
        raise TracerError(f"{place}.to_world: says the direction once more; give that or direction")
    given, matrix = table.take("direction", None), _matrix(table)
    direction = matrix[:3, 2] if given is None else triple(given, f"{place}.direction")
    size = np.linalg.norm(direction)
    if not size > 0.0:
        raise TracerError(f"{place}.direction: has no length")
    return Directional(place, direction / size, colour(table.take("irradiance", 1.0), f"{place}.irradiance"))


def _constant(table):
    return Constant(table.place, colour(table.take("radiance", 1.0), f"{table.place}.radiance", BRIGHTEST))


def _envmap(table, folder):
    place, filename = table.place, table.take("filename")
    matrix = _matrix(table)[:3, :3]
    scale = real(table.take("scale", 1.0), f"{place}.scale", 0.0)
    if not np.allclose(matrix.T @ matrix, np.eye(3), atol=1e-9):
        raise TracerError(f"{place}.to_world: stretches or moves the sky; only rotations make sense")
    image = picture_file.read(filename, f"{place}.filename", folder)
    if image.shape[0] < 3 or image.shape[1] < 2:
        raise TracerError(f"{place}.filename: {filename} has fewer than 2 x 3 pixels")
    bad = np.argwhere(~(np.isfinite(image) & (image >= 0.0)).all(axis=2))
    if bad.size:
        raise TracerError(
            f"{place}.filename: {filename} has no radiance in row {bad[0, 0]}, column {bad[0, 1]}"
        )
    return Envmap(place, image * scale, matrix)
