"""Triangle meshes that tests build themselves."""

import numpy as np


def icosphere(subdivisions):
    """A closed mesh on the unit sphere: vertices (V, 3), faces (F, 3), 20 * 4^subdivisions of them."""
    g = (1 + np.sqrt(5)) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0)]
    corners += [(z, x, y) for x, y, z in corners] + [(y, z, x) for x, y, z in corners]
    vertices = np.array(corners, float)
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    faces = _hull(vertices)
    for _ in range(subdivisions):
        vertices, faces = _split(vertices, faces)
    return vertices, faces


def _hull(vertices):
    """The 20 triangles of an icosahedron: three corners next to each other, seen from outside."""
    near = np.linalg.norm(vertices[:, None] - vertices[None], axis=2)
    side = near[near > 1e-9].min() * 1.01
    faces = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if max(near[a, b], near[b, c], near[a, c]) < side:
                    out = np.dot(np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a]), vertices[a])
                    faces.append((a, b, c) if out > 0 else (a, c, b))
    return np.array(faces)


def _split(vertices, faces):
    """Every triangle in four; the new corners, one an edge, are pushed out to the sphere."""
    edges = np.sort(np.concatenate((faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]])), axis=1)
    unique, where = np.unique(edges, axis=0, return_inverse=True)
    middle = vertices[unique].mean(axis=1)
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    ab, bc, ca = where.reshape(3, -1) + len(vertices)
    a, b, c = faces.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate((vertices, middle)), np.concatenate([np.stack(p, axis=1) for p in parts])
