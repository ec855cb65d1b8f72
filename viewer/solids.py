"""Real triangles for everything drawn in 3D, since the browser draws neither thick lines nor round points.

Every function gives (points (P, 3), faces (F, 3)); `merge` puts several together.
"""

from functools import cache

import numpy as np

GOLDEN = (1 + 5**0.5) / 2
ICOSAHEDRON = np.array(
    [(s, t * GOLDEN, 0) for s in (-1, 1) for t in (-1, 1)]
    + [(0, s, t * GOLDEN) for s in (-1, 1) for t in (-1, 1)]
    + [(t * GOLDEN, 0, s) for s in (-1, 1) for t in (-1, 1)]
) / np.hypot(1, GOLDEN)
EMPTY = (np.zeros((0, 3)), np.zeros((0, 3), int))


def _icosahedron_faces():
    """All triples of vertices that are neighbours of each other, turned to face outwards."""
    near = np.linalg.norm(ICOSAHEDRON[:, None] - ICOSAHEDRON[None], axis=2) < 1.1
    n = len(ICOSAHEDRON)
    triples = [
        (a, b, c)
        for a in range(n)
        for b in range(a)
        for c in range(b)
        if near[a, b] and near[b, c] and near[a, c]
    ]
    outward = [np.linalg.det(ICOSAHEDRON[list(t)]) > 0 for t in triples]
    return np.array([t if out else t[::-1] for t, out in zip(triples, outward, strict=True)])


ICOSAHEDRON_FACES = _icosahedron_faces()


def merge(*parts):
    """Several solids as one."""
    counts = np.cumsum([0, *(len(points) for points, _ in parts)])
    points = [p for p, _ in parts] or [EMPTY[0]]
    faces = [f + start for (_, f), start in zip(parts, counts, strict=False)] or [EMPTY[1]]
    return np.concatenate(points), np.concatenate(faces)


def balls(centres, radius):
    """A small ball around each centre (N, 3)."""
    return _copies(np.reshape(centres, (-1, 1, 3)) + radius * ICOSAHEDRON, ICOSAHEDRON_FACES)


def rods(starts, ends, radius, tip=None, sides=7):
    """A straight rod from each start to its end; tip is the radius at the end (0 makes a cone). None where
    the two are one point."""
    starts, ends = np.reshape(starts, (-1, 3)), np.reshape(ends, (-1, 3))
    length = np.linalg.norm(ends - starts, axis=1)
    starts, ends, length = (values[length > 0] for values in (starts, ends, length))
    ring = _rings((ends - starts) / length[:, None], sides)
    foot, head = starts[:, None], ends[:, None]
    points = [foot + radius * ring, head + (radius if tip is None else tip) * ring, foot, head]
    return _copies(np.concatenate(points, axis=1), _rod_faces(sides))


def _rings(axes, sides):
    """Unit vectors (N, sides, 3) around each of some axes (N, 3)."""
    helper = np.eye(3)[np.argmin(np.abs(axes), axis=1)]
    u = _crossed(axes, helper)
    u /= np.linalg.norm(u, axis=1)[:, None]
    across, along = _circle(sides)
    return across * u[:, None] + along * _crossed(axes, u)[:, None]


def _crossed(a, b):
    """Cross products of vectors (N, 3); np.cross looks at their shapes for longer than it multiplies."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)


@cache
def _circle(sides):
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)[:, None]
    return np.cos(angle), np.sin(angle)


@cache
def _rod_faces(sides):
    k = np.arange(sides)
    j = (k + 1) % sides
    foot, head = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
    faces = [(k, j, j + sides), (k, j + sides, k + sides), (j, k, foot), (k + sides, j + sides, head)]
    return np.concatenate([np.stack(f, axis=1) for f in faces])


def _copies(points, faces):
    """The solid of N copies: points (N, K, 3), and the faces that each of them has."""
    starts = points.shape[1] * np.arange(len(points))
    return points.reshape(-1, 3), (starts[:, None, None] + faces).reshape(-1, 3)


def arrow(start, direction, length, radius):
    """An arrow: a rod and a cone."""
    start, direction = np.asarray(start, float), np.asarray(direction, float)
    tip = start + length * direction
    neck = tip - min(5.5 * radius, 0.5 * length) * direction
    return merge(rods(start, neck, radius), rods(neck, tip, 2.6 * radius, tip=0.0, sides=12))


def dashes(start, end, radius, dash):
    """A broken line: rods of length `dash` with gaps as long."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = np.linalg.norm(end - start)
    count = max(1, min(60, round(length / (2 * dash))))
    at = (np.arange(count)[:, None] + np.array([[0.0, 0.5]])) / count
    ends = start + at[..., None] * (end - start)
    return rods(ends[:, 0], ends[:, 1], radius, sides=5)


def cross(centre, size, radius):
    """A mark of three crossing rods: here something stopped."""
    offsets = size * np.array([(1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)]) / 3**0.5
    return rods(centre - offsets, centre + offsets, radius, sides=5)
