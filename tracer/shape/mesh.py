"""A triangle mesh without cracks: a ray through a shared edge or vertex always meets one of its owners."""

from dataclasses import dataclass

import numpy as np

from tracer.settings import TracerError

# Lanes times triangles in flight: small enough to stay in cache.
_CHUNK = 1 << 15


@dataclass(frozen=True)
class Mesh:
    """Triangles in world space, flat shaded.

    vertices: (V, 3) metres; faces: (F, 3) vertex numbers, counter-clockwise seen from outside.
    Triangles without area are dropped: nothing can be seen of them.
    """

    name: str
    vertices: np.ndarray
    faces: np.ndarray
    flip_normals: bool = False

    def __post_init__(self):
        _check(self.name, self.vertices, self.faces)
        doubled = np.linalg.norm(self._cross(), axis=1)
        object.__setattr__(self, "faces", self.faces[doubled > 0.0])
        if not len(self.faces):
            raise TracerError(f"{self.name}: no triangle has any area")

    @property
    def primitives(self):
        """Number of triangles."""
        return len(self.faces)

    def _cross(self):
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    def planes(self):
        """The plane of each triangle."""
        n = self._cross()
        n = (n / np.linalg.norm(n, axis=1, keepdims=True)).T
        n = -n if self.flip_normals else n
        return n, (n * self.vertices[self.faces[:, 0]].T).sum(axis=0)

    def area(self):
        """Area of each triangle in m^2, (F,)."""
        return 0.5 * np.linalg.norm(self._cross(), axis=1)

    def corners(self):
        """Corner and two sides of each triangle, three (3, F)."""
        a, b, c = (self.vertices[self.faces[:, k]].T for k in range(3))
        return a, b - a, c - a

    def triangles(self):
        """The mesh itself."""
        return self.vertices, self.faces

    def uv(self, p, face):
        """Barycentric coordinates of the second and third vertex, (2, N)."""
        a, e1, e2 = (v[:, face] for v in self.corners())
        d11, d12, d22 = (e1 * e1).sum(0), (e1 * e2).sum(0), (e2 * e2).sum(0)
        q = p - a
        q1, q2 = (q * e1).sum(0), (q * e2).sum(0)
        det = d11 * d22 - d12 * d12
        return np.stack(((d22 * q1 - d12 * q2) / det, (d11 * q2 - d12 * q1) / det))

    def kernel(self, first, extent, dtype):
        """The intersection routine."""
        return MeshKernel(self, first, dtype)


def _check(name, vertices, faces):
    """TracerError naming the first vertex or face that cannot be."""
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if bad.size:
        raise TracerError(
            f"{name}: vertex {bad[0]} has a coordinate that is not a finite number; mend the mesh"
        )
    if faces.size == 0:
        raise TracerError(f"{name}: the mesh has no triangles")
    bad = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))
    if bad.size:
        raise TracerError(
            f"{name}: face {bad[0]} names vertex {faces[bad[0]].max()}, but there are {len(vertices)}"
        )


class MeshKernel:
    """Watertight test of every triangle (Woop, Benthin and Wald 2013), a block of triangles at a time.

    The ray is sheared onto an axis; the three edge functions of two triangles that share an edge are then
    the same numbers with opposite signs, so no ray passes between them. In float32 an edge function that
    comes out as exactly zero is computed again in float64, where the products are exact.
    """

    def __init__(self, mesh, first, dtype):
        self.first = first
        self.vertices = mesh.vertices.astype(dtype)
        self.corners = mesh.faces
        self.faces = len(mesh.faces)
        self.low, self.high = self.vertices.min(axis=0), self.vertices.max(axis=0)

    def closest(self, rays):
        """Distance to the nearest triangle, inf for a miss, and which triangle."""
        n = rays.source.size
        t, face = np.full(n, np.inf, rays.o.dtype), np.zeros(n, np.int32)
        near = np.flatnonzero(self._in_bounds(rays))
        major = np.argmax(np.abs(rays.d.take(near, axis=1)), axis=0)
        for axis in range(3):
            lanes = near[major == axis]
            step = max(1, _CHUNK // max(lanes.size, 1))
            for start in range(0, self.faces if lanes.size else 0, step):
                block = np.arange(start, min(start + step, self.faces))
                t_block = self._block(rays.take(lanes), axis, block)
                best = np.argmin(t_block, axis=0)
                t_best = t_block[best, np.arange(lanes.size)]
                nearer = t_best < t[lanes]
                t[lanes[nearer]] = t_best[nearer]
                face[lanes[nearer]] = block[best[nearer]]
        return t, face

    def face(self, hint, rays, t, lanes):
        """The triangle found with the distance."""
        return hint[lanes]

    def _in_bounds(self, rays):
        """Whether each ray meets the bounding box, widened by its own rounding (Ize 2013)."""
        near, far = -np.inf, np.inf
        for k in range(3):
            side = rays.d[k] >= 0.0
            enter = np.where(side, self.low[k], self.high[k])
            leave = np.where(side, self.high[k], self.low[k])
            near = np.fmax(near, (enter - rays.o[k]) * rays.inv_d[k])
            far = np.fmin(far, (leave - rays.o[k]) * rays.inv_d[k])
        slack = 4.0 * np.finfo(rays.o.dtype).eps
        widened = far + slack * np.abs(far)
        return (near - slack * np.abs(near) <= widened) & (widened >= 0.0)

    def _block(self, rays, axis, block):
        """Distances (T, N) of the rays, whose largest component is `axis`, to a block of triangles."""
        kx, ky = (axis + 1) % 3, (axis + 2) % 3
        shear_x = rays.d[kx] / rays.d[axis]
        shear_y = rays.d[ky] / rays.d[axis]
        x, y, z = [], [], []
        for k in range(3):
            v = self.vertices[self.corners[block, k]]
            along = v[:, axis, None] - rays.o[axis]
            x.append((v[:, kx, None] - rays.o[kx]) - shear_x * along)
            y.append((v[:, ky, None] - rays.o[ky]) - shear_y * along)
            z.append(along)
        u, v, w = _edges(x, y)
        if u.dtype == np.float32:
            again = (u == 0.0) | (v == 0.0) | (w == 0.0)
            if again.any():
                exact = _edges(
                    [c[again].astype(np.float64) for c in x], [c[again].astype(np.float64) for c in y]
                )
                for edge, better in zip((u, v, w), exact, strict=True):
                    edge[again] = better
        inside = ((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) | ((u <= 0.0) & (v <= 0.0) & (w <= 0.0))
        det = u + v + w
        t = (u * z[0] + v * z[1] + w * z[2]) / (det * rays.d[axis])
        number = self.first + block[:, None]
        hit = inside & (det != 0.0) & (t > 0.0) & (rays.source != number)
        if rays.target is not None:
            hit &= rays.target != number
        return np.where(hit, t, np.inf)


def _edges(x, y):
    """The three edge functions: twice the signed areas that the sheared ray's axis cuts off."""
    return x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]
