"""Scenes of a given size: the unit box with a mesh of so many triangles, or with so many lamps."""

import copy
from functools import cache

import numpy as np
from meshes import icosphere

import tracer
from tracer.scene import Scene
from tracer.shape import Mesh


@cache
def box():
    """cornell_unit."""
    return tracer.load("cornell_unit")


def ball(level):
    """A mesh of 20 * 4^level triangles that stands where the tall box does."""
    vertices, faces = icosphere(level)
    return Mesh("ball", 0.45 * vertices + [-0.33, -0.4, -0.28], faces)


def definition_with(mesh):
    """The definition of the box with a mesh in place of the tall box."""
    made = box().definition
    surfaces = (s._replace(shape=mesh) if s.shape.name == "tall_box" else s for s in made.surfaces)
    return made._replace(surfaces=tuple(surfaces), source=None)


def box_with(mesh):
    """The box with a mesh in place of the tall box, made ready in float32."""
    return Scene(definition_with(mesh), np.float32)


def lit_by(lamps):
    """The box with so many lamps under its ceiling, in rows, as bright as its own together, as a dict."""
    room = copy.deepcopy(box().definition.source[0])
    lamp = room.pop("lamp")
    across = int(np.ceil(np.sqrt(lamps)))
    half = 0.8 / across
    radiance = np.array(lamp["emitter"]["radiance"]) * 0.23 * 0.19 / (lamps * (0.5 * half) ** 2)
    for k in range(lamps):
        row, column = divmod(k, across)
        place = [(2 * column + 1) * half - 0.8, 0.99, (2 * row + 1) * half - 0.8]
        room[f"lamp_{k}"] = {
            "type": "rectangle",
            "to_world": [{"scale": 0.5 * half}, {"rotate": [1, 0, 0], "angle": 90}, {"translate": place}],
            "bsdf": "white",
            "emitter": {"type": "area", "radiance": radiance.tolist()},
        }
    return room
