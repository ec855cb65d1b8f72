"""A sphere, met by the form of the quadratic that keeps its digits far away (Haines et al. 2019)."""

from dataclasses import dataclass, field

import numpy as np

from tracer.frame import dot
from tracer.lanes import choose, gather, signed
from tracer.settings import TracerError
from tracer.shape.chart import Chart
from tracer.shape.rays import linear

_RINGS = 24  # drawing only


@dataclass(frozen=True)
class Sphere:
    """Mitsuba's `sphere`: centre and radius in metres, and how its axes are turned."""

    name: str
    center: np.ndarray  # (3,)
    radius: float
    flip_normals: bool = False
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))  # (3, 3), its x, y and z in the columns

    primitives = 1

    def __post_init__(self):
        if not (np.isfinite(self.radius) and self.radius > 0.0 and np.isfinite(self.center).all()):
            raise TracerError(f"{self.name}: a sphere needs a finite centre and a radius above 0")

    def planes(self):
        """A sphere has no plane: zeros."""
        return np.zeros((3, 1)), np.zeros(1)

    @property
    def across(self):
        """Its diameter in metres."""
        return 2.0 * self.radius

    def area(self):
        """4 pi r^2, (1,)."""
        return np.array([4.0 * np.pi * self.radius**2])

    @property
    def turned(self):
        """1: its normals point out of what it holds; -1: into it."""
        return -1 if self.flip_normals else 1

    def holds(self, p):
        """Whether points (3, N) lie inside, (N,)."""
        return np.linalg.norm(p - self.center[:, None], axis=0) < self.radius

    def triangles(self):
        """A globe of quads cut in two."""
        theta = np.linspace(0.0, np.pi, _RINGS + 1)
        phi = np.linspace(0.0, 2.0 * np.pi, 2 * _RINGS + 1)[:-1]
        ring = np.stack(
            np.broadcast_arrays(
                np.sin(theta)[:, None] * np.cos(phi),
                np.cos(theta)[:, None],
                np.sin(theta)[:, None] * np.sin(phi),
            ),
            axis=-1,
        )
        row, column = np.meshgrid(np.arange(_RINGS), np.arange(phi.size), indexing="ij")
        a, b = row * phi.size + column, row * phi.size + (column + 1) % phi.size
        faces = np.concatenate(
            (np.stack((a, b, a + phi.size), -1), np.stack((b, b + phi.size, a + phi.size), -1))
        )
        return self.center + self.radius * ring.reshape(-1, 3), faces.reshape(-1, 3)

    def chart(self):
        """A sphere is not flat: zeros."""
        return Chart.none()

    def _local(self, p):
        """Its own x, y and z of points (3, N), times their distance from the centre."""
        out = p - self.center.astype(p.dtype).reshape(3, 1)
        return [linear(tuple(axis.astype(p.dtype)), out) for axis in self.turn.T]

    def uv_at(self, p):
        """Longitude from x by way of y, and angle from z, (2, N) from 0 to 1."""
        x, y, z = self._local(p)
        u = np.arctan2(y, x) * p.dtype.type(0.5 / np.pi)
        v = np.arctan2(np.sqrt(x * x + y * y), z) * p.dtype.type(1.0 / np.pi)
        return np.stack((np.where(u < 0.0, u + 1.0, u), v))

    def tangent_at(self, p):
        """Unit dp/du (3, N), along the circles of latitude; 0 at the poles."""
        x, y, _ = self._local(p)
        size = np.sqrt(x * x + y * y)
        size = np.where(size > 0.0, size, 1.0)
        axes = self.turn.astype(p.dtype)
        return axes[:, 1:2] * (x / size) - axes[:, 0:1] * (y / size)

    def outline(self):
        """Its centre, four times, (3, 4, 1): a sphere lies where its centre lies."""
        return np.broadcast_to(self.center.reshape(3, 1, 1), (3, 4, 1))

    def kernel(self, first, extent, dtype, corners=None):
        """The intersection routine."""
        return SphereKernel(self, first, dtype)


class SphereKernel:
    """Discriminant from the foot point of the centre on the ray, smaller root from the product of both.

    A ray that starts on the sphere knows one root, 0: the other is -2 b, met only when it points inwards.
    """

    faces = 1

    def __init__(self, sphere, first, dtype):
        self.first = first
        self.center = sphere.center.astype(dtype).reshape(3, 1)
        self.radius = dtype(sphere.radius)

    def closest(self, rays, within=np.inf):
        """Distance to the first root ahead, inf for a miss, and the primitive."""
        oc = rays.o - self.center
        b = dot(oc, rays.d)
        foot = oc - b * rays.d
        disc = self.radius * self.radius - dot(foot, foot)
        t, own = np.full_like(b, np.inf), rays.source == self.first
        lanes = np.flatnonzero((disc >= 0.0) & ~own)
        t[lanes] = self._ahead(gather(oc, lanes), gather(b, lanes), gather(disc, lanes))
        own = np.flatnonzero(own & (b < 0.0))
        t[own] = -2.0 * gather(b, own)
        if rays.target is not None:
            t[np.flatnonzero(rays.target == self.first)] = np.inf
        return t, self.first

    def _ahead(self, oc, b, disc):
        """Distance (N,) to the first root above 0 of rays that meet the sphere, inf if there is none."""
        far_from_zero = -(b + signed(np.sqrt(disc), b))
        size = np.sqrt(dot(oc, oc))
        near_zero = (size - self.radius) * (size + self.radius) / far_from_zero
        near, far = np.minimum(near_zero, far_from_zero), np.maximum(near_zero, far_from_zero)
        t = choose(near > 0.0, near, far)
        t[np.flatnonzero(~(t > 0.0))] = np.inf
        return t
