"""A triangle mesh without cracks: a ray through a shared edge or vertex always meets one of its owners."""

from dataclasses import dataclass

import numpy as np

from tracer.frame import dot, normalize
from tracer.settings import TracerError
from tracer.shape import bvh, inside, start
from tracer.shape.chart import Chart

# Lanes times triangles in flight: small enough to stay in cache.
_CHUNK = 1 << 15


@dataclass(frozen=True)
class Mesh:
    """Triangles in world space.

    vertices: (V, 3) metres; faces: (F, 3) vertex numbers, counter-clockwise seen from outside; normals:
    (V, 3) for smooth shading, of any length, or None for flat; uv: (F, 3, 2) texture coordinates of each
    triangle's corners, or None. Triangles without area are dropped: nothing can be seen of them.
    """

    name: str
    vertices: np.ndarray
    faces: np.ndarray
    flip_normals: bool = False
    normals: np.ndarray | None = None
    uv: np.ndarray | None = None

    def __post_init__(self):
        check(self.name, self.vertices, self.faces)
        doubled = np.linalg.norm(self._cross(), axis=1)
        object.__setattr__(self, "faces", self.faces[doubled > 0.0])
        if self.uv is not None:
            object.__setattr__(self, "uv", self.uv[doubled > 0.0])
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

    @property
    def across(self):
        """Its largest extent along an axis in metres."""
        return np.ptp(self.vertices, axis=0).max()

    def area(self):
        """Area of each triangle in m^2, (F,)."""
        return 0.5 * np.linalg.norm(self._cross(), axis=1)

    def outline(self):
        """The three corners of each triangle, the last one twice, (3, 4, F)."""
        return self.vertices[self.faces[:, [0, 1, 2, 2]]].transpose(2, 1, 0)

    def corners(self):
        """Corner and two sides of each triangle, three (3, F)."""
        a, b, c = (self.vertices[self.faces[:, k]].T for k in range(3))
        return a, b - a, c - a

    def triangles(self):
        """The mesh itself."""
        return self.vertices, self.faces

    @property
    def turned(self):
        """1: its normals point out of what it holds; -1: into it; 0: it is open and holds nothing."""
        if inside.open_edges(self.vertices, self.faces):
            return 0
        outwards = inside.volume(self.vertices, self.faces) > 0.0
        return 1 if outwards != self.flip_normals else -1

    def holds(self, p):
        """Whether points (3, N) lie inside, (N,)."""
        return np.abs(inside.winding(self.vertices, self.faces, p)) > 0.5

    def chart(self):
        """Its texture coordinates; without any, those of `barycentric`."""
        return Chart.spanned(*self.corners(), None if self.uv is None else self.uv.transpose(1, 2, 0))

    def barycentric(self, p, face):
        """Coordinates of the second and third vertex, (2, N)."""
        a, b, c = (self.vertices[self.faces[face, k]].T.astype(p.dtype) for k in range(3))
        e1, e2, q = b - a, c - a, p - a
        d11, d12, d22, q1, q2 = dot(e1, e1), dot(e1, e2), dot(e2, e2), dot(q, e1), dot(q, e2)
        det = d11 * d22 - d12 * d12
        return np.stack(((d22 * q1 - d12 * q2) / det, (d11 * q2 - d12 * q1) / det))

    def put_inside(self, p, face):
        """Points (3, N) near triangles, moved along the plane into them where rounding left them outside.

        A grazing ray's distance, and with it the point, slides by the rounding of the plane over the cosine.
        """
        v, w = self.barycentric(p, face)
        outside = np.flatnonzero((v < 0.0) | (w < 0.0) | (v + w > 1.0))
        if outside.size:
            v, w = np.maximum(v[outside], 0.0), np.maximum(w[outside], 0.0)
            total = np.maximum(v + w, 1.0)
            a, b, c = (self.vertices[self.faces[face[outside], k]].T.astype(p.dtype) for k in range(3))
            p[:, outside] = a + (v / total) * (b - a) + (w / total) * (c - a)
        return p

    def shading_normals(self, p, face):
        """Normals interpolated between the vertices and made unit again, (3, N); NaN where they cancel."""
        v, w = self.barycentric(p, face)
        a, b, c = (self.normals[self.faces[face, k]].T.astype(p.dtype) for k in range(3))
        n = normalize((1.0 - v - w) * a + v * b + w * c)
        return -n if self.flip_normals else n

    def kernel(self, first, extent, dtype, corners=None):
        """The intersection routine."""
        return MeshKernel(self, first, dtype, corners)


def check(name, vertices, faces):
    """TracerError naming the first vertex or face that cannot be."""
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if bad.size:
        raise TracerError(
            f"{name}: vertex {bad[0]} has a coordinate that is not a finite number; mend the mesh"
        )
    if faces.size == 0:
        raise TracerError(f"{name}: the mesh has no triangles")
    wrong = (faces < 0) | (faces >= len(vertices))
    bad = np.flatnonzero(wrong.any(axis=1))
    if bad.size:
        number = faces[bad[0]][wrong[bad[0]]][0]
        raise TracerError(f"{name}: face {bad[0]} names vertex {number}, but there are {len(vertices)}")


class MeshKernel:
    """Watertight test of triangles (Woop, Benthin and Wald 2013), a leaf of the tree at a time.

    The ray is sheared onto the axis it points along most; the three edge functions of two triangles that
    share an edge are then the same numbers with opposite signs, so no ray passes between them. In float32
    an edge function that comes out as exactly zero is computed again in float64, where products are exact.
    The distance is that of the plane: the interpolated one is only as good as the longest sheared side.
    Of triangles at the same distance the lowest number wins, whatever the order of the walk.
    """

    def __init__(self, mesh, first, dtype, corners):
        self.first, self.corners = first, corners
        self.vertices = mesh.vertices.astype(dtype)
        self.corner_of = mesh.faces
        n, c = mesh.planes()
        self.n, self.c = n.astype(dtype), c.astype(dtype)
        of_face = self.vertices[mesh.faces]
        low, high = of_face.min(axis=1), of_face.max(axis=1)
        # Wide enough for a ray that starts on a face and, by rounding, behind it.
        pad = start.margin(self.n, self.c, np.maximum(np.abs(low), np.abs(high)).T)[:, None]
        self.tree = bvh.build(low - pad, high + pad)

    def closest(self, rays, within=np.inf):
        """Distance to the nearest triangle before `within` (N,), inf where there is none, and which."""
        n = rays.source.size
        t, face = np.full(n, within, rays.o.dtype), np.full(n, -1, np.int32)
        near = np.flatnonzero(bvh.meets(self.tree, rays.o, bvh.inverse(rays.d), t))
        major = np.argmax(np.abs(rays.d.take(near, axis=1)), axis=0)
        for axis in range(3):
            lanes = near[major == axis]
            if lanes.size:
                t[lanes], face[lanes] = self._along(axis, rays.take(lanes), t[lanes])
        return np.where(face >= 0, t, np.inf), self.first + face

    def _along(self, axis, rays, t):
        """closest, for rays whose largest component is `axis`."""
        kx, ky = (axis + 1) % 3, (axis + 2) % 3
        along = rays.d[axis]
        sheared = np.stack((rays.o[kx], rays.o[ky], rays.o[axis], rays.d[kx] / along, rays.d[ky] / along))
        face = np.full(t.size, -1, np.int32)

        def visit(triangles, lanes):
            step = max(1, _CHUNK // triangles.size)
            for begin in range(0, lanes.size, step):
                part = lanes[begin : begin + step]
                found = self._triangles(triangles, (kx, ky, axis), sheared.take(part, axis=1), rays, part)
                best = np.argmin(found, axis=0)
                t_best, number = found[best, np.arange(part.size)], triangles[best]
                nearer = (t_best < t[part]) | ((t_best == t[part]) & (number < face[part]))
                t[part[nearer]], face[part[nearer]] = t_best[nearer], number[nearer]

        bvh.walk(self.tree, rays.o, rays.d, t, visit)
        return t, face

    def _triangles(self, triangles, axes, sheared, rays, lanes):
        """Distances (T, N) of sheared rays to triangles; inf for a miss."""
        x, y = _shear(self.vertices, self.corner_of[triangles], axes, sheared)
        u, v, w = _edges(x, y)
        if u.dtype == np.float32:
            again = (u == 0.0) | (v == 0.0) | (w == 0.0)
            if again.any():
                exact = _edges(*([c[again].astype(np.float64) for c in side] for side in (x, y)))
                for edge, better in zip((u, v, w), exact, strict=True):
                    edge[again] = better
        inside = ((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) | ((u <= 0.0) & (v <= 0.0) & (w <= 0.0))
        number = self.first + triangles[:, None]
        hit = inside & (u + v + w != 0.0) & (rays.source[lanes] != number)
        if rays.target is not None:
            hit &= rays.target[lanes] != number
        row, column = np.nonzero(hit)
        met, lanes = triangles[row], lanes[column]
        o, d = rays.o.take(lanes, axis=1), rays.d.take(lanes, axis=1)
        n, c = self.n.take(met, axis=1), self.c[met]
        t = np.full(hit.shape, np.inf, u.dtype)
        t[row, column] = start.distance(o, d, n, c, rays.source[lanes], self.corners)
        return t


def _shear(vertices, corners, axes, sheared):
    """Corners of triangles (T, 3) across the sheared rays: x and y, each three (T, N)."""
    o, shear_x, shear_y = sheared[:3], sheared[3], sheared[4]
    x, y = [], []
    for k in range(3):
        v = vertices[corners[:, k]]
        away = v[:, axes[2], None] - o[2]
        x.append((v[:, axes[0], None] - o[0]) - shear_x * away)
        y.append((v[:, axes[1], None] - o[1]) - shear_y * away)
    return x, y


def _edges(x, y):
    """The three edge functions: twice the signed areas that the sheared ray's axis cuts off."""
    return x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]
