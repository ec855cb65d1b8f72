"""Coordinates (u, v) on surfaces, as Mitsuba lays them, and the direction in which u grows.

On a flat primitive they are linear: u = u_0 + grad u . (p - origin), with the origin on the primitive, so
that nothing cancels far from the scene's own origin. A sphere knows its own.
"""

from typing import NamedTuple

import numpy as np

from tracer.frame import cross, dot, length
from tracer.lanes import gather

LARGEST = 1e6  # of coordinates and of what a texture makes of them: beyond, float32 has no digit for a texel
STEEPEST = 1e18  # of gradients per metre, on slivers: so that all that follows is a number in float32


class Chart(NamedTuple):
    """Coordinates on flat primitives, one column each."""

    origin: np.ndarray  # (3, K) a corner
    uv: np.ndarray  # (2, K) coordinates there
    grad_u: np.ndarray  # (3, K)
    grad_v: np.ndarray  # (3, K)
    tangent: np.ndarray  # (3, K) dp/du made unit; 0 where it does not exist

    @classmethod
    def spanned(cls, corner, e1, e2, uv=None):
        """From a corner, two sides, each (3, K), and coordinates (3, 2, K) at corner, corner + e1 and
        corner + e2; without them u runs from 0 to 1 along e1 and v along e2."""
        if uv is None:
            uv = np.broadcast_to(np.array([[[0.0], [0.0]], [[1.0], [0.0]], [[0.0], [1.0]]]), (3, 2, 1))
            uv = np.repeat(uv, corner.shape[1], axis=2)
        n = cross(e1, e2)
        area = length(n)
        n, area = n / area, np.maximum(area, 1e-100)
        along_1, along_2 = cross(e2, n) / area, cross(n, e1) / area
        (u1, v1), (u2, v2) = uv[1] - uv[0], uv[2] - uv[0]
        tangent = (v2 * e1 - v1 * e2) * np.sign(u1 * v2 - u2 * v1)
        size = length(tangent)
        tangent = tangent / np.where(size > 0.0, size, 1.0)
        grads = (np.clip(a * along_1 + b * along_2, -STEEPEST, STEEPEST) for a, b in ((u1, u2), (v1, v2)))
        return cls(corner, uv[0], *grads, tangent)

    @classmethod
    def none(cls):
        """Of a primitive that is not flat: zeros."""
        return cls(*(np.zeros((rows, 1)) for rows in (3, 2, 3, 3, 3)))


class Charts:
    """The coordinates on all primitives of a scene, in one precision."""

    def __init__(self, shapes, first, dtype):
        columns = zip(*(shape.chart() for shape in shapes), strict=True)
        self._flat = Chart(*(np.concatenate(column, axis=1).astype(dtype) for column in columns))
        self._round = [(k, shape) for k, shape in zip(first, shapes, strict=True) if hasattr(shape, "uv_at")]

    def uv(self, p, primitive):
        """Coordinates (2, N) of points (3, N) on their primitives (N,)."""
        origin, uv, grad_u, grad_v, _ = self._flat
        out = p - gather(origin, primitive)
        along = np.stack([dot(gather(grad, primitive), out) for grad in (grad_u, grad_v)])
        along += gather(uv, primitive)
        for lanes, shape in self._on_round(primitive):
            along[:, lanes] = shape.uv_at(gather(p, lanes))
        return along

    def tangent(self, p, primitive):
        """Unit dp/du (3, N) there; 0 where it does not exist."""
        tangent = gather(self._flat.tangent, primitive)
        for lanes, shape in self._on_round(primitive):
            tangent[:, lanes] = shape.tangent_at(gather(p, lanes))
        return tangent

    def _on_round(self, primitive):
        for first, shape in self._round:
            lanes = np.flatnonzero(primitive == first)
            if lanes.size:
                yield lanes, shape
