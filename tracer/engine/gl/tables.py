"""A scene as tables that a shader reads, one row per primitive or lamp face; see also material_tables.

The fields of a row are four numbers each, as std430 wants them, and bear the names of the structs in glsl/.
"""

import numpy as np

from tracer.light.faces import shining_faces
from tracer.shape.arrange import InAWall
from tracer.shape.cube import Cube
from tracer.shape.mesh import Mesh
from tracer.shape.rectangle import Rectangle, RectangleKernel
from tracer.shape.sphere import Sphere
from tracer.shape.start import Faces, relation

ELSEWHERE = ("Point", "Directional", "Constant")
_FACE_KINDS = ("quad", "triangle", "sphere")


def rows(count, ints, floats, more_ints=()):
    """A table of zeros with the named columns of four whole or four real numbers."""
    columns = [(ints, "4i4"), (floats, "4f4"), (more_ints, "4i4")]
    return np.zeros(count, [(name, kind) for names, kind in columns for name in names])


def surfaces(scene, faces):
    """Planes or spheres, and what covers them."""
    table = rows(len(scene.shape_of), ("number",), ("plane", "more", "u", "v"))
    for shape, first in zip(scene.shapes, scene.first, strict=True):
        own = slice(first, first + shape.primitives)
        if isinstance(shape, Sphere):
            table["number"][own, 0] = 2
            table["plane"][own] = *shape.center, shape.radius
            table["more"][own, :2] = np.abs(shape.center).sum() + shape.radius, _side(shape)
            table["u"][own, :3], table["v"][own, :3] = shape.turn[:, 0], shape.turn[:, 1]
            continue
        n, c = shape.planes()
        table["plane"][own, :3], table["plane"][own, 3] = n.T, c
        table["more"][own, 0] = faces.reach[own]
        table["u"][own, :3] = shape.chart().tangent.T
    table["number"][:, 1], table["number"][:, 2:] = scene.bsdf_of, -1
    for row, number in enumerate(smooth(scene)[0]):
        table["number"][number, 3] = row
    if scene.media is not None:
        table["more"][:, 2], table["more"][:, 3] = scene.media.front, scene.media.back
    for number, face in enumerate(_lamp_faces(scene)):
        table["number"][face.primitive, 2] = number
    return table


def smooth(scene):
    """The triangles of meshes that have normals of their own: (their primitives, their Smooths)."""
    numbers, parts = [], [rows(0, (), ("a", "b", "c", "na", "nb", "nc"))]
    for first, shape in zip(scene.first, scene.shapes, strict=True):
        if getattr(shape, "normals", None) is None:
            continue
        numbers += range(int(first), int(first) + shape.primitives)
        table = rows(shape.primitives, (), ("a", "b", "c", "na", "nb", "nc"))
        side = _side(shape)
        for k, corner in enumerate("abc"):
            table[corner][:, :3] = shape.vertices[shape.faces[:, k]]
            table[f"n{corner}"][:, :3] = side * shape.normals[shape.faces[:, k]]
        parts.append(table)
    return numbers, np.concatenate(parts)


def _side(shape):
    return -1.0 if shape.flip_normals else 1.0


def _lamp_faces(scene):
    """The ShiningFaces, in the order of the lights."""
    for light, name in enumerate(scene.light_names):
        for k, shape in enumerate(scene.shapes):
            if shape.name == name and scene.definition.surfaces[k].radiance is not None:
                yield from shining_faces(light, shape, int(scene.first[k]))


def quads(scene, extent, faces):
    """The rectangles and the faces of cubes, lamps first: (their primitives, their Quads, hair of each)."""
    in_wall = [k for k in scene.arrangement.closest if isinstance(k, InAWall)]
    hair = {kernel.kernel.first: kernel.hair for kernel in in_wall}
    shines = [surface.radiance is not None for surface in scene.definition.surfaces]
    numbers, kernels = [], []
    for k in sorted(range(len(scene.shapes)), key=lambda k: not shines[k]):
        shape = scene.shapes[k]
        if not isinstance(shape, (Rectangle, Cube)):
            continue
        for j, flat in enumerate(_as_rectangles(shape)):
            numbers.append(int(scene.first[k]) + j)
            kernels.append(RectangleKernel(flat, numbers[-1], extent, scene.dtype, faces))
    table = rows(len(numbers), (), ("plane", "first", "second", "limits"))
    for row, number, kernel in zip(table, numbers, kernels, strict=True):
        row["plane"] = *faces.n[:, number], faces.c[number]
        row["first"], row["second"] = (
            (*along, middle) for along, middle in zip(kernel.rows, kernel.middles, strict=True)
        )
        row["limits"] = *kernel.limits, kernel.margin, faces.reach[number]
    return numbers, table, [float(hair.get(number, 0.0)) for number in numbers]


def _as_rectangles(shape):
    """A rectangle, or the six faces of a cube as rectangles."""
    if isinstance(shape, Rectangle):
        return [shape]
    n, _ = shape.planes()
    made = []
    for j, (corner, e1, e2) in enumerate(zip(*(v.T for v in shape.parallelograms()), strict=True)):
        to_world = np.eye(4)
        to_world[:3] = np.stack((0.5 * e1, 0.5 * e2, n[:, j], corner + 0.5 * (e1 + e2)), axis=1)
        made.append(Rectangle(f"{shape.name}, face {j}", to_world))
    return made


def _mesh_kernels(scene, extent, faces):
    for first, shape in zip(scene.first, scene.shapes, strict=True):
        if isinstance(shape, Mesh):
            yield shape.kernel(int(first), extent, scene.dtype, faces)


def mesh_boxes(scene, extent, faces):
    """Corners of a box around each mesh, and how many triangles it has."""
    for kernel in _mesh_kernels(scene, extent, faces):
        yield kernel.tree.low, kernel.tree.high, kernel.faces


def triangles(scene, extent, faces):
    """Those of meshes: (their primitives, their Triangles)."""
    numbers, parts = [], [rows(0, (), ("a", "b", "c", "plane"))]
    for kernel in _mesh_kernels(scene, extent, faces):
        numbers += range(kernel.first, kernel.first + kernel.faces)
        table = rows(kernel.faces, (), ("a", "b", "c", "plane"))
        for corner, values, component in zip("abc", kernel.corners, kernel.n, strict=True):
            table[corner][:, :3], table[corner][:, 3] = values.T, component
        table["plane"][:, 0], table["plane"][:, 1] = kernel.turn, kernel.margin
        table["plane"][:, 2] = faces.reach[kernel.first : kernel.first + kernel.faces]
        table["plane"][:, 3] = np.arange(kernel.first, kernel.first + kernel.faces)
        parts.append(table)
    return numbers, np.concatenate(parts)


def spheres(scene):
    """(their primitives, centre and radius of each (S, 4))."""
    found = [
        (int(first), (*shape.center, shape.radius))
        for first, shape in zip(scene.first, scene.shapes, strict=True)
        if isinstance(shape, Sphere)
    ]
    return [number for number, _ in found], np.array([ball for _, ball in found], np.float32).reshape(-1, 4)


def relations(faces):
    """What `start.relation` says of each primitive and each other one, (P * P,): 1 more than the side, in two
    bits for rays that leave to the side of the normal, and in two for those that leave to the other."""
    count = faces.c.size
    own, other = (v.ravel() for v in np.indices((count, count)))
    middle = faces.corners.mean(axis=1)[:, own]
    n = faces.n[:, own]
    sides = [relation(faces, own, other, middle + way * n)[0].astype(np.int32) + 1 for way in (1.0, -1.0)]
    return (sides[0] | (sides[1] << 2)).astype(np.int32)


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
        row["number"][:3] = _FACE_KINDS.index(face.kind), way[k], face.primitive
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


def asked_for_shadows(scene):
    """Primitives that may hide a lamp: not those of shapes of which the arrangement knows better, nor walls
    of a box that holds everything."""
    arrangement = scene.arrangement
    never = set(arrangement.harmless)
    if arrangement.walls_never_block:
        corners = [shape.triangles()[0] for shape in scene.shapes]
        low, high = (np.array([f(c, axis=0) for c in corners]) for f in (np.min, np.max))
        walls = list(arrangement.walls)
        slack = 1e-9 * np.abs(np.vstack(corners)).max()
        room = low[walls].min(axis=0) - slack, high[walls].max(axis=0) + slack
        if (low >= room[0]).all() and (high <= room[1]).all():
            never |= set(walls)
    return [k for k in range(len(scene.shape_of)) if scene.shape_of[k] not in never]


def faces_of(scene):
    """What the definition says of every primitive, and the largest coordinate a ray starts at."""
    extent = max(
        np.abs(scene.bounds()).max(), np.abs(scene.camera.origin).max() + scene.camera.aperture_radius
    )
    return Faces.of(scene.shapes, scene.dtype), extent
