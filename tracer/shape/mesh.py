"""A triangle mesh without cracks: a ray through a shared edge or vertex always meets one of its owners."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tracer.frame import dot, normalize
from tracer.lanes import gather
from tracer.settings import TracerError
from tracer.shape import inside
from tracer.shape.chart import Chart
from tracer.shape.mesh_kernel import MeshKernel, planes_through


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
        return self._planes

    @cached_property
    def _planes(self):
        a, b, c = (self.vertices[self.faces[:, k]].T for k in range(3))
        n, on = planes_through(a, b, c)
        n = -n if self.flip_normals else n
        return n, dot(n, on)

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

    def _corners(self, face, dtype):
        """The corners of triangles (N,), three (3, N)."""
        if dtype not in self._all_corners:
            self._all_corners[dtype] = [
                np.ascontiguousarray(self.vertices[self.faces[:, k]].T, dtype) for k in range(3)
            ]
        return [gather(corner, face) for corner in self._all_corners[dtype]]

    @cached_property
    def _all_corners(self):
        """What was asked for: {precision: the corners of all triangles, three (3, F)}."""
        return {}

    def barycentric(self, p, face):
        """Coordinates of the second and third vertex, (2, N)."""
        a, b, c = self._corners(face, p.dtype)
        e1, e2, q = b - a, c - a, p - a
        d11, d12, d22, q1, q2 = dot(e1, e1), dot(e1, e2), dot(e2, e2), dot(q, e1), dot(q, e2)
        det = d11 * d22 - d12 * d12
        return np.stack(((d22 * q1 - d12 * q2) / det, (d11 * q2 - d12 * q1) / det))

    def put_inside(self, p, face):
        """Points (3, N) near triangles, moved to the nearest edge where rounding left them outside.

        A grazing ray's distance, and with it the point, slides by the rounding of the plane over the cosine.
        """
        v, w = self.barycentric(p, face)
        outside = np.flatnonzero(~((v >= 0.0) & (w >= 0.0) & (v + w <= 1.0)))  # slivers have no v and w
        if outside.size:
            q, best = gather(p, outside), np.inf
            corners = self._corners(face[outside], p.dtype)
            for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
                side, out = b - a, q - a
                size = dot(side, side)
                share = np.clip(dot(out, side) / np.where(size > 0.0, size, 1.0), 0.0, 1.0)
                at = a + share * side
                away = dot(q - at, q - at)
                p[:, outside] = np.where(away < best, at, p[:, outside])
                best = np.minimum(away, best)
        return p

    def shading_normals(self, p, face):
        """Normals interpolated between the vertices and made unit again, (3, N); NaN where they cancel."""
        v, w = self.barycentric(p, face)
        a, b, c = (self.normals[self.faces[face, k]].T.astype(p.dtype) for k in range(3))
        n = normalize((1.0 - v - w) * a + v * b + w * c)
        return -n if self.flip_normals else n

    def kernel(self, first, extent, dtype, others=None):
        """The intersection routine."""
        return MeshKernel(self, first, dtype, others)


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
