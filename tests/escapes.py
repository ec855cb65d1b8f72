"""Rays shot at closed meshes from inside: how many meet nothing."""

from functools import cache

import numpy as np
from meshes import icosphere

from tracer.shape.mesh import Mesh
from tracer.shape.rays import Rays

DTYPES = (np.float32, np.float64)
PLACES = ((0.0, 0.0, 0.0), (148376.0, 1234.0, -223423.0))  # the second is where Embree tests itself
AIMS = ("corners", "edges", "anywhere")
PARTS = 16  # a wave is aimed at one of so many parts of the mesh: it meets fewer boxes of the tree


@cache
def closed_mesh(place, dtype, subdivisions=3, radius=None):
    """Kernel of the mesh, its vertices (V, 3) as the precision has them, and its faces."""
    vertices, faces = icosphere(subdivisions)
    vertices = vertices * (radius or (1.0 if place[0] == 0 else 1000.0)) + place
    return Mesh("ball", vertices, faces).kernel(0, 1.0, dtype), vertices.astype(dtype), faces


def targets(vertices, faces, aim, n, rng):
    """n points of a part of the surface, (3, n): what looks one random way, so that rays keep together."""
    away = vertices[faces].mean(axis=1) - vertices.mean(axis=0)
    part = np.argsort(away @ rng.normal(size=3))[-max(20, len(faces) // PARTS) :]
    pick = rng.choice(part, n)
    a, b, c = (vertices[faces[pick, k]].T.astype(float) for k in range(3))
    if aim == "corners":
        return a
    s, t = rng.random(n), rng.random(n)
    if aim == "edges":
        return a + s * (b - a)
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    return a + s * (b - a) + t * (c - a)


def escapes(place, aim, dtype, n, seed, kernel=None, fine=3, radius=None):
    """How many of n rays from inside the mesh meet nothing."""
    built, vertices, faces = closed_mesh(place, dtype, fine, radius)
    kernel = kernel or built
    rng = np.random.default_rng(seed)
    middle, size = vertices.astype(float).mean(axis=0), np.ptp(vertices[:, 0].astype(float)) / 2
    o = rng.uniform(-0.5, 0.5, (3, n)) * size + middle[:, None]
    o[:, : n // 10] = middle[:, None]  # a tenth from the middle itself, where symmetric mistakes show
    o = o.astype(dtype)
    d = targets(vertices, faces, aim, n, rng) - o.astype(float)
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    with np.errstate(all="ignore"):
        t, _ = kernel.closest(Rays.towards(o, d, np.full(n, -1)))
    return int(np.count_nonzero(~np.isfinite(t)))
