"""A scene as tables that a shader reads, one row per primitive or lamp face.

See also material_tables and shape_tables.

The fields of a row are four numbers each, as std430 wants them, and bear the names of the structs in glsl/.
"""

import numpy as np

from tracer.engine.gl.rows import rows
from tracer.light.faces import shining_faces
from tracer.shape.mesh import Mesh
from tracer.shape.sphere import Sphere

ELSEWHERE = ("Point", "Directional", "Constant")
KINDS = ("quad", "triangle", "sphere")


def surfaces(scene, in_leaves):
    """Planes or spheres, and what covers them. in_leaves: (T,) primitives of shape_tables.triangles."""
    table = rows(len(scene.shape_of), ("number",), ("plane", "more", "u", "v"))
    for shape, first in zip(scene.shapes, scene.first, strict=True):
        own = slice(first, first + shape.primitives)
        if isinstance(shape, Sphere):
            table["number"][own, 0] = KINDS.index("sphere")
            table["plane"][own] = *shape.center, shape.radius
            table["more"][own, :2] = np.abs(shape.center).sum() + shape.radius, _side(shape)
            table["u"][own, :3], table["v"][own, :3] = shape.turn[:, 0], shape.turn[:, 1]
            continue
        table["number"][own, 0] = KINDS.index("triangle" if isinstance(shape, Mesh) else "quad")
        n, c = shape.planes()
        table["plane"][own, :3], table["plane"][own, 3] = n.T, c
        table["more"][own, 0] = scene.faces.reach[own]
        table["u"][own, :3] = shape.chart().tangent.T
    table["number"][:, 1], table["number"][:, 2:] = scene.bsdf_of, -1
    there = np.flatnonzero(in_leaves >= 0)
    table["number"][in_leaves[there], 3] = there
    if scene.media is not None:
        table["more"][:, 2], table["more"][:, 3] = scene.media.front, scene.media.back
    for number, face in enumerate(_lamp_faces(scene)):
        table["number"][face.primitive, 2] = number
    return table


def _side(shape):
    return -1.0 if shape.flip_normals else 1.0


def _lamp_faces(scene):
    """The ShiningFaces, in the order of the lights."""
    for light, name in enumerate(scene.light_names):
        for k, shape in enumerate(scene.shapes):
            if shape.name == name and scene.definition.surfaces[k].radiance is not None:
                yield from shining_faces(light, shape, int(scene.first[k]))


def charts(scene):
    """Coordinates on the primitives."""
    table = rows(len(scene.shape_of), (), ("a", "b", "c"))
    for first, shape in zip(scene.first, scene.shapes, strict=True):
        own = slice(first, first + shape.primitives)
        if isinstance(shape, Sphere):
            for field, axis in zip("abc", shape.turn.T, strict=True):
                table[field][own, :3] = axis
            continue
        chart = shape.chart()
        table["a"][own, :3], table["b"][own, :3], table["c"][own, :3] = (
            v.T for v in (chart.origin, chart.grad_u, chart.grad_v)
        )
        table["a"][own, 3], table["b"][own, 3] = chart.uv
    return table


def lamp_faces(scene):
    """The faces that shine."""
    found = list(_lamp_faces(scene))
    table = rows(len(found), ("number",), ("corner", "e1", "e2", "n", "Le"))
    if not found:
        return table
    chance, slack, way = scene.lights.area.columns()
    for k, (row, face) in enumerate(zip(table, found, strict=True)):
        row["number"][:3] = KINDS.index(face.kind), way[k], face.primitive
        row["corner"] = *face.corner, 1.0 / face.area
        row["e1"], row["e2"] = (*face.e1, np.linalg.norm(face.e1)), (*face.e2, np.linalg.norm(face.e2))
        row["n"] = *face.n, chance[k]
        row["Le"] = *scene.lights.area.radiance[:, face.light], slack[k]
    return table


def elsewhere(scene):
    """The lights that are no shapes."""
    others = [] if scene.lights is None else scene.lights.elsewhere()
    table = rows(len(others), ("number",), ("where", "colour"))
    for row, (light, pick) in zip(table, others, strict=True):
        row["number"][0] = ELSEWHERE.index(type(light).__name__)
        row["where"][:3] = getattr(light, "position", getattr(light, "direction", 0.0))
        row["colour"] = *light.light, pick
    return table


def with_ball(table, ball):
    """`elsewhere`, and one more row for the Ball around the scene."""
    last = rows(1, ("number",), ("where", "colour"))
    last["where"] = *ball.center, ball.radius
    return np.concatenate((table, last))
