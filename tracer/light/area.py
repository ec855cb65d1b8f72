"""Surfaces that shine: points on them, chosen for a receiver, with the density of the direction.

Flat faces (rectangles, faces of cubes, triangles) are one table, chosen with probability proportional to
power: light first by luminance times area, then face by area. The densities returned are per solid angle:
pick times pdf_area times distance^2 / cos_light (Veach 1997, 8.2).
"""

from typing import NamedTuple

import numpy as np

from tracer import warp
from tracer.events import TECHNIQUES
from tracer.frame import dot

_LUMINANCE = np.array([0.212671, 0.715160, 0.072169])  # of linear sRGB primaries (ITU-R BT.709)


class LightSample(NamedTuple):
    """One point on a light per lane, as seen from the receiver."""

    light: np.ndarray  # (N,) number of the light
    primitive: np.ndarray  # (N,) number of the primitive q lies on
    pick: np.ndarray  # (N,) probability of choosing the light
    technique: np.ndarray  # (N,) index into events.TECHNIQUES
    q: np.ndarray  # (3, N) point on the light
    nq: np.ndarray  # (3, N) normal there
    wi: np.ndarray  # (3, N) unit direction to q
    distance: np.ndarray  # (N,)
    Le: np.ndarray  # (3, N) radiance back along wi, 0 behind the light
    pdf: np.ndarray  # (N,) density of wi in sr^-1, choice of the light included; 0 behind the light

    def take(self, lanes):
        """The samples of some lanes."""
        return LightSample(*(column.take(lanes, axis=-1) for column in self))


class AreaLights:
    """All shining faces of a scene.

    faces: tuple of (light number, primitive number, kind, corner (3,), e1 (3,), e2 (3,), area, normal (3,))
    with kind "quad", "triangle" or "sphere" (corner = centre, e1[0] = radius).
    radiance: (3, L) of each light.
    """

    def __init__(self, faces, radiance, dtype):
        self.radiance = radiance.astype(dtype)
        light = np.array([f.light for f in faces])
        area = np.array([f.area for f in faces])
        total = np.bincount(light, area, radiance.shape[1])
        power = _LUMINANCE @ radiance * total
        pick = power / power.sum()
        chance = pick[light] * area / total[light]
        cdf = np.cumsum(chance)
        self.count = len(faces)
        self._cdf = (cdf / cdf[-1])[:-1].astype(dtype)
        self._low = np.concatenate(([0.0], (cdf / cdf[-1])[:-1])).astype(dtype)
        self._chance = chance.astype(dtype)
        self._light = light.astype(np.int32)
        self._primitive = np.array([f.primitive for f in faces], np.int32)
        self._sphere = np.array([f.kind == "sphere" for f in faces])
        self._triangle = np.array([f.kind == "triangle" for f in faces])
        self._corner, self._e1, self._e2, self._n = (
            np.stack([getattr(f, name) for f in faces], axis=1).astype(dtype)
            for name in ("corner", "e1", "e2", "n")
        )
        self.pick = pick.astype(dtype)
        # Density of q per area: a light's faces together are one light, so it does not depend on the face.
        self.pdf_area = np.where(power > 0.0, pick / np.where(total > 0.0, total, 1.0), 0.0).astype(dtype)

    def sample(self, p, u):
        """A point on a light for each receiver p (3, N), from u (3, N)."""
        if self.count == 1:
            face = np.zeros(p.shape[1], np.int32)
            q, nq = self._points(slice(0, 1), u[1], u[2])
            nq = np.broadcast_to(nq, p.shape)
        else:
            face = np.searchsorted(self._cdf, u[0], side="right").astype(np.int32)
            q, nq = self._points(face, u[1], u[2])
        light = self._light.take(face)
        to_light = q - p
        square = dot(to_light, to_light)
        distance = np.sqrt(square)
        wi = to_light / distance
        cos = -dot(nq, wi)
        facing = cos > 0.0
        pdf = self.pdf_area.take(light) * square / np.abs(cos) * facing
        return LightSample(
            light,
            self._primitive.take(face),
            self.pick.take(light),
            np.broadcast_to(np.int8(TECHNIQUES.index("area")), light.shape),
            q,
            nq,
            wi,
            distance,
            self.radiance.take(light, axis=1) * facing,
            np.where(facing, pdf, 0.0),
        )

    def pdf(self, light, cos, distance):
        """Density in sr^-1 with which sample gives a direction that meets `light` at that cosine, (N,)."""
        return self.pdf_area.take(light) * distance * distance / cos

    def _points(self, face, u, v):
        """Points (3, N) uniform on the faces' areas and the normals there."""
        if self._triangle.any():
            b = warp.uniform_triangle(np.stack((u, v)))
            triangle = self._triangle[face]
            u, v = np.where(triangle, b[0], u), np.where(triangle, b[1], v)
        corner, e1, e2, n = (table[:, face] for table in (self._corner, self._e1, self._e2, self._n))
        q = corner + u * e1 + v * e2
        sphere = self._sphere[face]
        if not sphere.any():
            return q, n
        around = warp.uniform_sphere(np.stack((u, v)))
        on_sphere = corner + e1[0] * around
        return np.where(sphere, on_sphere, q), np.where(sphere, n[0] * around, n)


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
