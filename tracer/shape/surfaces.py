"""The primitives of all shapes as what points lie on: put onto them, with the normals and the error there."""

import numpy as np

from tracer.frame import dot, length
from tracer.lanes import gather, put
from tracer.shape.rays import error_bound
from tracer.shape.sphere import Sphere


class Surfaces:
    """The surfaces of some shapes, in one precision.

    first: number of each shape's first primitive; faces: their start.Faces. smooth: whether any is shaded by
    other normals than its own.
    """

    def __init__(self, shapes, first, faces, dtype):
        self._n, self._c = faces.n.astype(dtype), faces.c.astype(dtype)
        placed = list(zip(first, shapes, strict=True))
        self._meshes = [(k, shape) for k, shape in placed if hasattr(shape, "put_inside")]
        self._smooth = [(k, shape) for k, shape in self._meshes if shape.normals is not None]
        self.smooth = bool(self._smooth)
        # What enters a primitive's error bound beside the point itself.
        reach = faces.reach.astype(dtype)
        self._spheres = []
        for k, shape in placed:
            if isinstance(shape, Sphere):
                center, side = shape.center.astype(dtype).reshape(3, 1), -1.0 if shape.flip_normals else 1.0
                self._spheres.append((k, center, dtype(shape.radius), dtype(side)))
                reach[k] = np.abs(shape.center).sum() + shape.radius
        self._reach = np.append(reach, dtype(0.0))  # of primitive -1: a light that is no shape

    def project(self, p, primitive):
        """Points (3, N) put onto their primitives (N,), the normals there, and the bound on what is left."""
        n, c = gather(self._n, primitive), gather(self._c, primitive)
        p = p - (dot(n, p) - c) * n
        for first, shape in self._meshes:
            lanes = np.flatnonzero((primitive >= first) & (primitive < first + shape.primitives))
            put(p, lanes, shape.put_inside(gather(p, lanes), primitive[lanes] - first))
        for first, center, radius, side in self._spheres:
            lanes = np.flatnonzero(primitive == first)
            out = gather(p, lanes) - center
            out = out / length(out)
            put(p, lanes, center + radius * out)
            put(n, lanes, side * out)
        return p, n, self.bound(p, n, primitive)

    def bound(self, p, n, primitive):
        """How far points (3, N) may lie off their primitives, along normals n (3, N), in metres, (N,)."""
        return error_bound(p, n, gather(self._reach, primitive))

    def shading_normals(self, p, ng, wo, primitive):
        """Interpolated normals where a shape has them; ng where they are none or would turn the side seen."""
        if not self.smooth:
            return ng
        n = ng.copy()
        for first, shape in self._smooth:
            lanes = np.flatnonzero((primitive >= first) & (primitive < first + shape.primitives))
            smooth = shape.shading_normals(gather(p, lanes), primitive[lanes] - first)
            seen = gather(wo, lanes)
            good = np.flatnonzero(dot(smooth, seen) * dot(gather(ng, lanes), seen) > 0.0)  # not so for NaN
            put(n, lanes[good], gather(smooth, good))
        return n
