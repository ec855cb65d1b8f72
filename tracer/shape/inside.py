"""Whether a mesh is closed, which way it is turned, and which points it holds."""

import numpy as np


def open_edges(vertices, faces):
    """How many edges of the triangles are not run through as often one way as the other: 0 for a closed mesh.

    Vertices at the same place but for the rounding of a transform are one vertex.
    """
    places = np.stack([_clusters(column) for column in vertices.T], axis=1)
    vertex = np.unique(places, axis=0, return_inverse=True)[1].reshape(-1)[faces]
    a, b = vertex.ravel(), np.roll(vertex, -1, axis=1).ravel()
    a, b, way = a[a != b], b[a != b], np.sign(b - a)[a != b]
    edges = np.stack((np.minimum(a, b), np.maximum(a, b)), axis=1)
    edge = np.unique(edges, axis=0, return_inverse=True)[1].reshape(-1)
    return int(np.count_nonzero(np.bincount(edge, way)))


def _clusters(values):
    """Numbers (N,) that are the same where values (N,) differ by rounding only."""
    order = np.argsort(values)
    sizes = values[order]
    number = np.zeros(values.size, np.int64)
    number[order[1:]] = np.cumsum(np.diff(sizes) > 16.0 * np.finfo(np.float64).eps * np.abs(values).max())
    return number


def volume(vertices, faces):
    """Volume that a closed mesh holds, below 0 if its triangles are wound inwards."""
    a, b, c = (vertices[faces[:, k]] - vertices.mean(axis=0) for k in range(3))
    return float((np.cross(a, b) * c).sum() / 6.0)


def winding(vertices, faces, p):
    """How often a closed mesh goes round each point p (3, N): 1 or -1 inside, 0 outside.

    The solid angles of all triangles over 4 pi, each by its half tangent (Oosterom and Strackee 1983).
    """
    turns = np.zeros(p.shape[1])
    for k in range(p.shape[1]):
        a, b, c = (vertices[faces[:, corner]] - p[:, k] for corner in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        triple = (np.cross(a, b) * c).sum(axis=1)
        below = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
        turns[k] = np.arctan2(triple, below).sum() / (2.0 * np.pi)
    return turns
