"""What rays meet, as tables that a shader reads; see also tables.

Rectangles, faces of cubes and spheres are rows; a mesh is a row, its triangles in the order of the leaves of
its tree, and the nodes of that tree.
"""

import numpy as np

from tracer.engine.gl.rows import rows
from tracer.shape.arrange import InAWall
from tracer.shape.cube import Cube
from tracer.shape.mesh_kernel import MeshKernel
from tracer.shape.rectangle import Rectangle, RectangleKernel
from tracer.shape.sphere import Sphere
from tracer.shape.start import relation

CHILDREN = 8  # of a node; of the root's some may be nothing


def asked_for_shadows(scene):
    """Whether each shape may hide a lamp, (S,): not those of which the arrangement knows better, nor walls
    of a box that holds everything."""
    arrangement = scene.arrangement
    asked = np.ones(len(scene.shapes), bool)
    asked[list(arrangement.harmless)] = False
    if arrangement.walls_never_block:
        corners = [shape.triangles()[0] for shape in scene.shapes]
        low, high = (np.array([f(c, axis=0) for c in corners]) for f in (np.min, np.max))
        walls = list(arrangement.walls)
        slack = 1e-9 * np.abs(np.vstack(corners)).max()
        room = low[walls].min(axis=0) - slack, high[walls].max(axis=0) + slack
        if (low >= room[0]).all() and (high <= room[1]).all():
            asked[walls] = False
    return asked


def quads(scene):
    """The rectangles and the faces of cubes, lamps first, as Quads."""
    in_wall = [k for k in scene.arrangement.closest if isinstance(k, InAWall)]
    hair = {kernel.kernel.first: kernel.hair for kernel in in_wall}
    shines = [surface.radiance is not None for surface in scene.definition.surfaces]
    asked, kernels = asked_for_shadows(scene), []
    for k in sorted(range(len(scene.shapes)), key=lambda k: not shines[k]):
        shape = scene.shapes[k]
        if not isinstance(shape, (Rectangle, Cube)):
            continue
        for number, flat in enumerate(_as_rectangles(shape), int(scene.first[k])):
            kernels.append((RectangleKernel(flat, number, scene.extent, scene.dtype, scene.faces), asked[k]))
    table = rows(len(kernels), ("number",), ("plane", "first", "second", "limits", "more"))
    for row, (kernel, shadows) in zip(table, kernels, strict=True):
        number = kernel.first
        row["number"][:2] = number, shadows
        row["plane"] = *scene.faces.n[:, number], scene.faces.c[number]
        row["first"], row["second"] = (
            (*along, middle) for along, middle in zip(kernel.rows, kernel.middles, strict=True)
        )
        row["limits"] = *kernel.limits, kernel.margin, scene.faces.reach[number]
        row["more"][0] = hair.get(number, 0.0)
    return table


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


def turned(scene):
    """The primitives of shapes that a change (scene_file.change) names, as of a lamp's size."""
    names = {key.partition(".")[0] for key in scene.definition.changes if key.count(".") == 1}
    of = (k for k, shape in enumerate(scene.shapes) if shape.name in names)
    return frozenset(int(n) for k in of for n in np.flatnonzero(scene.shape_of == k))


def balls(scene):
    """The spheres, as Balls."""
    asked = asked_for_shadows(scene)
    found = [k for k, shape in enumerate(scene.shapes) if isinstance(shape, Sphere)]
    table = rows(len(found), ("number",), ("place",))
    for row, k in zip(table, found, strict=True):
        row["number"][:2] = scene.first[k], asked[k]
        row["place"] = *scene.shapes[k].center, scene.shapes[k].radius
    return table


def mesh_kernels(scene):
    """The MeshKernels of a scene, lamps first."""
    kernels = [getattr(kernel, "exact", kernel) for kernel in scene.arrangement.closest]
    return [kernel for kernel in kernels if isinstance(kernel, MeshKernel)]


def meshes(scene):
    """The meshes, as Meshes."""
    asked, kernels = asked_for_shadows(scene), mesh_kernels(scene)
    table = rows(len(kernels), ("number", "more"), ("low", "high"))
    node = triangle = 0
    for row, kernel in zip(table, kernels, strict=True):
        tree = kernel.tree
        root = tree.steps[0].shape[1] // 6 if tree.steps else 0
        row["number"] = kernel.first, kernel.faces, node, triangle
        row["more"] = len(tree.steps), root, tree.leaves.shape[1], asked[scene.shape_of[kernel.first]]
        row["low"][:3], row["high"][:3] = tree.low, tree.high
        node, triangle = node + sum(map(len, tree.steps)), triangle + tree.leaves.size
    return table


def nodes(scene):
    """The boxes of the children of M nodes, (12 M, 4) float32: low x of all eight, low y, ..., high z."""
    steps = [step for kernel in mesh_kernels(scene) for step in kernel.tree.steps]
    padded = [np.zeros((0, 4), np.float32)]
    for step in steps:
        width = step.shape[1] // 6
        boxes = np.zeros((len(step), 2, 3, CHILDREN), np.float32)
        boxes[..., :width] = step.reshape(-1, 2, 3, width)
        padded.append(boxes.reshape(-1, 4))
    return np.concatenate(padded)


def triangles(scene):
    """Those of meshes, as Triangles in the order of the leaves; their primitives (T,), -1 in empty places."""
    numbers, parts = [np.empty(0, np.intp)], [rows(0, (), ("a", "b", "c", "plane"))]
    for kernel in mesh_kernels(scene):
        own = kernel.tree.leaves.ravel()
        table = rows(own.size, (), ("a", "b", "c", "plane"))
        for corner, values, component in zip("abc", kernel.corners, kernel.n, strict=True):
            table[corner][:, :3], table[corner][:, 3] = values.T[own], component[own]
        number = np.where(own < 0, -1, kernel.first + own)
        table["plane"][:, 0], table["plane"][:, 1] = kernel.turn, kernel.margin[own]
        table["plane"][:, 2], table["plane"][:, 3] = scene.faces.reach[kernel.first + own], number
        numbers.append(number)
        parts.append(table)
    return np.concatenate(numbers), np.concatenate(parts)


def smooth(scene):
    """The normals at the corners of all triangles, in the same order; 0 where a mesh has none."""
    parts = [rows(0, (), ("a", "b", "c"))]
    for kernel in mesh_kernels(scene):
        shape, own = scene.shapes[scene.shape_of[kernel.first]], kernel.tree.leaves.ravel()
        table = rows(own.size, (), ("a", "b", "c"))
        if shape.normals is not None:
            normals = -shape.normals if shape.flip_normals else shape.normals
            for k, corner in enumerate("abc"):
                table[corner][:, :3] = normals[shape.faces[own, k]]
        parts.append(table)
    return np.concatenate(parts)


def relations(faces):
    """What `start.relation` says of each primitive and each other one, (P * P,): 1 more than the side, in two
    bits for rays that leave to the side of the normal, and in two for those that leave to the other."""
    count = faces.c.size
    own, other = (v.ravel() for v in np.indices((count, count)))
    middle = faces.corners.mean(axis=1)[:, own]
    n = faces.n[:, own]
    sides = [relation(faces, own, other, middle + way * n)[0].astype(np.int32) + 1 for way in (1.0, -1.0)]
    return (sides[0] | (sides[1] << 2)).astype(np.int32)


def definitions(faces):
    """What `start.Faces` has of every primitive, in float64, as Definitions."""
    table = np.zeros(faces.c.size, [(name, "4f8") for name in ("plane", "x", "y", "z")])
    table["plane"][:, :3], table["plane"][:, 3] = faces.n.T, faces.c
    for name, along in zip("xyz", faces.corners, strict=True):
        table[name] = along.T
    return table


def size(scene):
    """Bytes of the tables of many triangles, near enough."""
    leaves = sum(kernel.tree.leaves.size for kernel in mesh_kernels(scene))
    boxes = sum(len(step) for kernel in mesh_kernels(scene) for step in kernel.tree.steps)
    of_triangle = 64 + 48 * scene.has_smooth_normals
    of_primitive = 80 + 128 + 48 * scene.bsdf.any_textured
    return leaves * of_triangle + 24 * CHILDREN * boxes + of_primitive * len(scene.shape_of)
