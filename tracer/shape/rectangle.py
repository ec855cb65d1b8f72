"""A flat parallelogram: the square from -1 to 1 in x and y, facing +z, after its transform."""

from dataclasses import dataclass

import numpy as np

from tracer.lanes import gather
from tracer.shape import start, transform
from tracer.shape.chart import Chart
from tracer.shape.rays import hits_only, linear


@dataclass(frozen=True)
class Rectangle:
    """Mitsuba's `rectangle`. flip_normals turns the side that reflects and shines."""

    name: str
    to_world: np.ndarray  # (4, 4)
    flip_normals: bool = False

    primitives = 1
    turned = 0  # it holds nothing

    def __post_init__(self):
        transform.check_invertible(self.to_world, self.name)

    @property
    def centre(self):
        """Middle of the rectangle, (3,)."""
        return self.to_world[:3, 3]

    @property
    def edges(self):
        """From the middle to the middle of two sides, two (3,)."""
        return self.to_world[:3, 0], self.to_world[:3, 1]

    def planes(self):
        """The one plane the rectangle lies in."""
        n = transform.normals(self.to_world, np.array([[0.0], [0.0], [1.0]]))
        n = -n if self.flip_normals else n
        return n, np.array([n[:, 0] @ self.centre])

    @property
    def across(self):
        """Harmonic mean of its two sides in metres: twice the area over half the rim."""
        first, second = (np.linalg.norm(edge) for edge in self.edges)
        return 4.0 * first * second / (first + second)

    def area(self):
        """Area in m^2, (1,)."""
        e1, e2 = self.edges
        return np.array([4.0 * np.linalg.norm(np.cross(e1, e2))])

    def parallelograms(self):
        """Corner and two sides of each face, three (3, 1): points of the face are corner + a e1 + b e2."""
        e1, e2 = self.edges
        return (self.centre - e1 - e2)[:, None], (2.0 * e1)[:, None], (2.0 * e2)[:, None]

    def triangles(self):
        """Two triangles."""
        corner, e1, e2 = (v[:, 0] for v in self.parallelograms())
        vertices = np.array([corner, corner + e1, corner + e1 + e2, corner + e2])
        return vertices, np.array([[0, 1, 2], [0, 2, 3]])

    def chart(self):
        """u along x and v along y, from 0 to 1."""
        return Chart.spanned(*self.parallelograms())

    def outline(self):
        """The four corners, (3, 4, 1)."""
        corner, e1, e2 = self.parallelograms()
        return np.stack((corner, corner + e1, corner + e1 + e2, corner + e2), axis=1)

    def kernel(self, first, extent, dtype, others=None):
        """The intersection routine."""
        return RectangleKernel(self, first, extent, dtype, others)


class RectangleKernel:
    """Distance to the plane, then two coordinates in it.

    The rectangle reaches past its edge by the rounding of this very test, so that two that share an edge
    leave no gap between them. At a convex edge two stick out by as much; cubes and meshes do not.
    """

    faces = 1

    def __init__(self, rectangle, first, extent, dtype, others):
        n, c = rectangle.planes()
        n, c = n[:, 0], c[0]
        e1, e2 = rectangle.edges
        dual = _clean(np.linalg.inv(np.stack((e1, e2, n))).T[:2])  # a . e1 = 1, a . e2 = 0, a . n = 0
        size = np.abs(dual).max(axis=1, keepdims=True)
        rows = dual / size  # largest component 1: an axis-aligned side costs no product
        centre = rectangle.centre
        self.first, self.others = first, others
        self.axis = int(np.argmax(np.abs(n))) if np.count_nonzero(n) == 1 else None
        self.n = tuple(dtype(v) for v in n)
        self.c = dtype(c if self.axis is None else centre[self.axis])
        self.rows = [tuple(dtype(v) for v in row) for row in rows]
        self.middles = [dtype(row @ centre) for row in rows]
        eps = np.finfo(dtype).eps
        rounding = [8.0 * eps * (np.abs(row).sum() * extent + abs(row @ centre)) for row in rows]
        self.limits = [dtype(1.0 / s[0] + r) for s, r in zip(size, rounding, strict=True)]
        # No start further from the plane or the edge than this, anywhere in the scene, is left to rounding.
        self.touching = [dtype(1.0 / s[0] + 8.0 * r) for s, r in zip(size, rounding, strict=True)]
        self.margin = dtype(0.0 if others is None else others.margin(first, 1)[0])

    def closest(self, rays, within=np.inf):
        """Distance along each ray, inf for a miss, and the primitive."""
        if self.axis is None:
            depth = self.c - linear(self.n, rays.o)
            t = depth / linear(self.n, rays.d)
        else:
            depth = self.c - rays.o[self.axis]
            t = depth * rays.inv_d[self.axis]
        hit = rays.source != self.first
        if rays.target is not None:
            hit &= rays.target != self.first
        close = np.flatnonzero(hit & (np.abs(depth) <= self.margin))
        for row, middle, limit in zip(self.rows, self.middles, self.limits, strict=True):
            reach = linear(row, rays.o) + t * linear(row, rays.d)
            hit &= np.abs(reach - middle) <= limit
        met = close[hit[close]] if close.size else close
        hit &= t > 0.0
        t = hits_only(t, hit)
        if close.size:
            self._from_close_by(t, depth, rays, close, met)
        return t, self.first

    def _from_close_by(self, t, depth, rays, lanes, met):
        """Put right the distances of the rays `met`, which start near the plane on another primitive; say
        which of `lanes` may touch the rectangle."""
        if met.size:
            o, cos = gather(rays.o, met), linear(self.n, gather(rays.d, met))
            height, source = -depth[met], rays.source[met]
            t[met] = start.distance(-height / cos, height, cos, o, self.first, source, self.others)
        lanes = lanes[rays.source[lanes] >= 0]
        if rays.touched is not None and lanes.size:
            o = gather(rays.o, lanes)
            on = np.ones(lanes.shape, bool)
            for row, middle, limit in zip(self.rows, self.middles, self.touching, strict=True):
                on &= np.abs(linear(row, o) - middle) <= limit
            if on.any():
                rays.touched.append((lanes[on], np.full(np.count_nonzero(on), self.first)))


def _clean(rows):
    """The rows with what is only rounding set to zero, so that axis-aligned walls cost less."""
    return np.where(np.abs(rows) < 1e-15 * np.abs(rows).max(axis=1, keepdims=True), 0.0, rows)
