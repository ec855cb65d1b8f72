"""How far a shadow ray goes to the lamp, as single precision has it."""

import numpy as np

from tracer.frame import cross, dot
from tracer.shape.mesh import Mesh
from tracer.shape.rectangle import Rectangle

NEAR = 1e-3  # relative distance within which a hit is the lamp itself


def shadow_distances(scene, hit, light):
    """How far the first hit on the way to the lamp's point is, and that point itself, both (N,).

    As the homework computes them: the first by a triangle's two determinants, which are rounded to the
    vectors' precision before they are divided in float64, the second by a root. They are equal but for
    rounding where nothing else is in the way.
    """
    t, _ = scene.intersect(hit.p, light.wi, hit.primitive)
    t, r = t.astype(np.float64), light.distance.copy()
    free = t >= light.distance * (1.0 - NEAR)
    for (a, b, c), first in _lamp_triangles(scene):
        lanes = np.flatnonzero(free & (light.primitive == first))
        v, w = _coordinates(a, b, c, light.q.take(lanes, axis=1))
        inside = (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0)
        lanes, v, w = lanes[inside], v[inside], w[inside]
        t[lanes], r[lanes] = _to_triangle(hit.p.take(lanes, axis=1), a, b, c, v, w)
    return t, r


def _lamp_triangles(scene):
    """Corners (3, 3) of the flat triangles that shine, each with the number of its primitive."""
    for shape, first in zip(scene.shapes, scene.first, strict=True):
        if scene.light_of[first] >= 0 and isinstance(shape, (Rectangle, Mesh)):
            vertices, faces = shape.triangles()
            for k, face in enumerate(faces):
                yield vertices[face], first + k * shape.primitives // len(faces)


def _coordinates(a, b, c, q):
    """Coordinates (N,) of points (3, N) along the two sides of a triangle from its first corner."""
    sides = np.linalg.pinv(np.stack((b - a, c - a), axis=1))
    return (sides @ (q - a[:, None])).astype(q.dtype)


def _to_triangle(p, a, b, c, v, w):
    """Distance (N,) to a triangle's plane, and to its point with the coordinates v and w, from points p."""
    a, b, c = (corner.astype(p.dtype)[:, None] for corner in (a, b, c))
    q = a * (1.0 - v - w).astype(p.dtype) + b * v + c * w  # rounded, so that it lies a little off the plane
    way = q - p
    r = np.sqrt(dot(way, way))
    e1, e2 = (np.broadcast_to(side, p.shape) for side in (b - a, c - a))
    top = dot(e2, cross(p - a, e1)).astype(np.float64)
    return top / dot(e1, cross(way / r, e2)).astype(np.float64), r
