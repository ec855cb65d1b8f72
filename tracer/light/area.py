"""Surfaces that shine: points on them, chosen for a receiver, with the density of the direction.

The faces (rectangles, faces of cubes, triangles, spheres) are one table. On the face a point is uniform over
the solid angle that the receiver sees (flat faces with right angles, spheres from outside), or over its area:
then the density per solid angle is pdf_area times distance^2 / cos_light (Veach 1997, 8.2).
"""

from typing import NamedTuple

import numpy as np

from tracer import warp
from tracer.frame import dot
from tracer.lanes import choose, gather, put
from tracer.light import rectangle, sphere
from tracer.light.sample import AREA, CONE, SOLID_ANGLE, LightSample

_RIGHT_ANGLE = 1e-9  # cosine between two sides that is only rounding


class ShiningFace(NamedTuple):
    """One primitive that shines: a quad, a triangle or a sphere."""

    light: int
    primitive: int
    kind: str
    corner: np.ndarray  # (3,) a corner, or the centre of a sphere
    e1: np.ndarray  # (3,) a side; the radius in [0] of a sphere
    e2: np.ndarray  # (3,) the other side
    area: float
    n: np.ndarray  # (3,) the normal; +1 or -1 in [0] for a sphere that shines outwards or inwards

    @property
    def best(self):
        """The technique that suits the face: a sheared quad has no rectangle's solid angle, and the inside
        of a sphere is all around."""
        if self.kind == "sphere":
            return CONE if self.n[0] > 0.0 else AREA
        sides = np.linalg.norm(self.e1) * np.linalg.norm(self.e2)
        square = self.kind == "quad" and abs(self.e1 @ self.e2) <= _RIGHT_ANGLE * sides
        return SOLID_ANGLE if square else AREA


class AreaLights:
    """All shining faces of a scene.

    faces: tuple of ShiningFace. chance: (F,) probability of each. radiance: (3, L) and pick (L,) of each
    light. light_sampling: as in the Settings.
    """

    def __init__(self, faces, chance, radiance, pick, dtype, light_sampling):
        self.radiance, self._pick = radiance.astype(dtype), pick.astype(dtype)
        self.count = len(faces)
        self._light = np.array([f.light for f in faces], np.int32)
        self._primitive = np.array([f.primitive for f in faces], np.int32)
        self._face_of = np.zeros(self._primitive.max() + 1, np.int32)
        self._face_of[self._primitive] = np.arange(self.count)
        self._chance = chance.astype(dtype)
        self._pdf_area = (1.0 / np.array([f.area for f in faces])).astype(dtype)
        self._triangle = np.array([f.kind == "triangle" for f in faces])
        self._sphere = np.array([f.kind == "sphere" for f in faces])
        corner, e1, e2, n = (
            np.stack([getattr(f, name) for f in faces], axis=1) for name in ("corner", "e1", "e2", "n")
        )
        self._size = np.stack((np.linalg.norm(e1, axis=0), np.linalg.norm(e2, axis=0))).astype(dtype)
        whole = np.where(self._size > 0.0, self._size, 1.0)
        self._x, self._y = (e1 / whole[0]).astype(dtype), (e2 / whole[1]).astype(dtype)
        self._corner, self._e1, self._e2, self._n = (v.astype(dtype) for v in (corner, e1, e2, n))
        # How far a point on a face may be off it: rounding of its own and of the face's coordinates.
        reach = np.abs(corner).sum(axis=0) + np.abs(e1).sum(axis=0) + np.abs(e2).sum(axis=0)
        self._slack = (16.0 * np.finfo(dtype).eps * reach).astype(dtype)
        self._least = dtype(rectangle.LEAST[np.dtype(dtype)])
        chosen = [f.best if light_sampling == "solid_angle" else AREA for f in faces]
        self._way = np.array(chosen, np.int8)
        self._only = self._way[0] if (self._way == self._way[0]).all() else None

    def columns(self):
        """Of each face (F,): its probability, how far a point may be off it, and how it is sampled."""
        return self._chance, self._slack, self._way

    def sample(self, p, u, face):
        """A point on each chosen face (N,) for its receiver p (3, N), from u (2, N), as a LightSample."""
        technique, q, nq, density = self._drawn(p, u, face)
        to_light = q - p
        square = dot(to_light, to_light)
        distance = np.sqrt(square)
        wi = to_light / distance
        if self._only == AREA:
            density = self._per_angle(density, square, -dot(nq, wi))
        elif (by_area := technique == AREA).any():
            density = choose(by_area, self._per_angle(density, square, -dot(nq, wi)), density)
        if self.count == 1:  # one face is broadcast instead of repeated
            light, primitive, pick, chance, radiance = (
                self._light, self._primitive, self._pick, self._chance, self.radiance,
            )  # fmt: skip
        else:
            light = gather(self._light, face)
            primitive, pick, chance = (
                gather(self._primitive, face),
                gather(self._pick, light),
                gather(self._chance, face),
            )
            radiance = gather(self.radiance, light)
        n = distance.shape
        return LightSample(
            np.broadcast_to(light, n),
            np.broadcast_to(primitive, n),
            np.broadcast_to(pick, n),
            technique,
            q,
            np.broadcast_to(nq, p.shape),
            wi,
            distance,
            radiance * (density > 0.0),
            density * chance,
        )

    @staticmethod
    def _per_angle(density, square, cos):
        """A density per area as one per solid angle, 0 behind the face."""
        return density * (square * (cos > 0.0) / np.maximum(cos, np.finfo(cos.dtype).tiny))

    def pdf(self, primitive, p, q, n):
        """Density in sr^-1 with which sample, from p (3, N), gives the direction to q on `primitive` (N,),
        whose normal there is n."""
        face = gather(self._face_of, primitive)
        to_light = q - p
        square = dot(to_light, to_light)
        density = gather(self._pdf_area, face) * square * np.sqrt(square) / np.abs(dot(n, to_light))
        if self._only != AREA:
            way = gather(self._way, face)
            for technique, seen in ((SOLID_ANGLE, self._solid_angle), (CONE, self._cone)):
                lanes = np.flatnonzero(way == technique)
                if lanes.size:
                    omega = seen(gather(p, lanes), face[lanes])
                    dark = density[lanes] if technique == SOLID_ANGLE else 0.0  # on a sphere
                    density[lanes] = np.where(omega > 0.0, 1.0 / omega, dark)
        return density * gather(self._chance, face)

    def _drawn(self, p, u, face):
        """technique (N,), q and nq (3, N), density (N,): per m^2 where the technique is AREA."""
        if self._only is not None:
            return self._draw[self._only](self, p, u, slice(0, 1) if self.count == 1 else face)
        way = gather(self._way, face)
        parts = []
        for technique, draw in self._draw.items():
            lanes = np.flatnonzero(way == technique)
            if lanes.size or not parts:
                parts.append((lanes, draw(self, gather(p, lanes), gather(u, lanes), face[lanes])))
        return scattered(parts, p.shape[1])

    def _by_area(self, p, u, face):
        """Points uniform on the faces' areas."""
        u, v = u
        n = p.shape[1]
        if self._triangle.any():
            b = warp.uniform_triangle(np.stack((u, v)))
            triangle = self._triangle[face]
            u, v = np.where(triangle, b[0], u), np.where(triangle, b[1], v)
        corner, e1, e2, nq = (table[:, face] for table in (self._corner, self._e1, self._e2, self._n))
        q, density = corner + u * e1 + v * e2, np.broadcast_to(self._pdf_area[face], n)
        if self._sphere.any():
            sphere_here = self._sphere[face]
            around = warp.uniform_sphere(np.stack((u, v)))
            out = p - corner
            # A sphere that shines inwards is dark from outside, though its far side would face the receiver;
            # one that shines outwards is dark inside and on itself, where rounding alone gives a direction.
            within = np.sqrt(dot(out, out)) <= e1[0] + self._slack[face]
            hidden = sphere_here & ((nq[0] > 0.0) == within)
            q = np.where(sphere_here, corner + e1[0] * around, q)
            nq = np.where(sphere_here, nq[0] * around, nq)
            density = np.where(hidden, 0.0, density).astype(p.dtype)
        return np.broadcast_to(AREA, n), q, nq, density

    def _by_solid_angle(self, p, u, face):
        """Points of rectangles, uniform over what the receivers see of them; by area where that is tiny."""
        seen = self._seen(p, face)
        omega = rectangle.solid_angle(seen)
        usable = omega > self._least
        s, t = rectangle.uniform(seen, omega, u[0], u[1])
        technique, density = SOLID_ANGLE, 1.0 / omega
        if not usable.all():
            s, t = choose(usable, s, u[0]), choose(usable, t, u[1])
            density = choose(usable, density, self._pdf_area[face])
            technique = np.array((AREA, SOLID_ANGLE)).take(usable.view(np.int8))
        q = self._corner[:, face] + s * self._e1[:, face] + t * self._e2[:, face]
        return np.broadcast_to(technique, omega.shape), q, self._n[:, face], density

    def _by_cone(self, p, u, face):
        """Points of spheres in the cone in which they are seen; by area, and dark, on them and inside."""
        _, q, nq, density = self._by_area(p, u, face)
        q_cone, n_cone, least = sphere.uniform_cone(
            p, self._corner[:, face], self._e1[0, face], u, self._slack[face]
        )
        usable = least > 0.0
        density = np.where(usable, warp.uniform_cone_pdf(least), density).astype(p.dtype)
        q, nq = np.where(usable, q_cone, q), np.where(usable, n_cone, nq)
        return np.where(usable, CONE, AREA), q, nq, density

    _draw = {AREA: _by_area, SOLID_ANGLE: _by_solid_angle, CONE: _by_cone}

    def _seen(self, p, face):
        x, y, n = self._x[:, face], self._y[:, face], self._n[:, face]
        seen = rectangle.seen_from(p, self._corner[:, face], x, y, n, *self._size[:, face])
        # What lies in the rectangle's plane but for rounding, the rectangle itself above all, sees nothing.
        return seen._replace(z=seen.z * (seen.z > self._slack[face]))

    def _solid_angle(self, p, face):
        """Solid angle (N,) of rectangles that are sampled by it, 0 of the others."""
        omega = rectangle.solid_angle(self._seen(p, face))
        return choose(omega > self._least, omega, np.zeros(1, omega.dtype))

    def _cone(self, p, face):
        """Solid angle (N,) of spheres that are sampled by their cone, 0 of the others."""
        out = p - self._corner[:, face]
        return (2.0 * np.pi) * sphere.one_minus_cos(
            self._e1[0, face], np.sqrt(dot(out, out)), self._slack[face]
        )


def scattered(parts, n):
    """Columns of n lanes from parts: pairs of lanes and the columns there."""
    first = parts[0][1]
    columns = [np.empty((*column.shape[:-1], n), column.dtype) for column in first]
    for lanes, values in parts:
        for column, value in zip(columns, values, strict=True):
            put(column, lanes, value)
    return columns
