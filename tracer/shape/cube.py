"""A box: the cube from -1 to 1, after its transform. A convex body, entered and left by slabs."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from tracer.frame import dot
from tracer.lanes import gather
from tracer.shape import transform
from tracer.shape.chart import Chart
from tracer.shape.rays import box_side, hits_only, linear

# Outward local normals: face 2k looks along -axis k, face 2k + 1 along +axis k.
_NORMALS = np.array([[-1, 1, 0, 0, 0, 0], [0, 0, -1, 1, 0, 0], [0, 0, 0, 0, -1, 1]], np.float64)
# Local directions in which u and v grow on each face.
_U = np.array([[0, 0, 0, -1, 0, 0], [1, 1, 0, 0, -1, 1], [0, 0, 1, 0, 0, 0]], np.float64)
_V = np.array([[0, 0, 1, 0, 1, 1], [0, 0, 0, 0, 0, 0], [1, -1, 0, -1, 0, 0]], np.float64)


@dataclass(frozen=True)
class Cube:
    """Mitsuba's `cube`. flip_normals makes a room of it."""

    name: str
    to_world: np.ndarray  # (4, 4)
    flip_normals: bool = False

    primitives = 6

    def __post_init__(self):
        transform.check_invertible(self.to_world, self.name)

    def planes(self):
        """The planes of the six faces."""
        n = transform.normals(self.to_world, _NORMALS)
        on_face = transform.points(self.to_world, _NORMALS)
        n = -n if self.flip_normals else n
        return n, (n * on_face).sum(axis=0)

    @property
    def across(self):
        """Its shortest edge in metres."""
        return 2.0 * np.linalg.norm(self.to_world[:3, :3], axis=0).min()

    def area(self):
        """Area of each face in m^2, (6,)."""
        _, e1, e2 = self.parallelograms()
        return np.linalg.norm(np.cross(e1, e2, axis=0), axis=0)

    def parallelograms(self):
        """Corner and two sides of each face, three (3, 6): points of the face are corner + a e1 + b e2."""
        first = np.roll(np.abs(_NORMALS), 1, axis=0)
        second = np.roll(np.abs(_NORMALS), 2, axis=0)
        corner = transform.points(self.to_world, _NORMALS - first - second)
        return (
            corner,
            2.0 * transform.vectors(self.to_world, first),
            2.0 * transform.vectors(self.to_world, second),
        )

    def triangles(self):
        """Twelve triangles; each face has its own four vertices."""
        corner, e1, e2 = self.parallelograms()
        vertices = np.stack((corner, corner + e1, corner + e1 + e2, corner + e2)).transpose(2, 0, 1)
        start = 4 * np.arange(6)[:, None]
        faces = np.concatenate((start + [[0, 1, 2]], start + [[0, 2, 3]]))
        return vertices.reshape(-1, 3), faces

    @property
    def turned(self):
        """1: its normals point out of what it holds; -1: into it."""
        return -1 if self.flip_normals else 1

    def holds(self, p):
        """Whether points (3, N) lie inside, (N,)."""
        return (np.abs(transform.points(np.linalg.inv(self.to_world), p)) < 1.0).all(axis=0)

    def chart(self):
        """u and v from 0 to 1 over each face, turned as Mitsuba turns them."""
        corner = transform.points(self.to_world, _NORMALS - _U - _V)
        return Chart.spanned(corner, *(2.0 * transform.vectors(self.to_world, axis) for axis in (_U, _V)))

    def outline(self):
        """The four corners of each face, (3, 4, 6)."""
        corner, e1, e2 = self.parallelograms()
        return np.stack((corner, corner + e1, corner + e1 + e2, corner + e2), axis=1)

    def kernel(self, first, extent, dtype, others=None):
        """The intersection routine."""
        return CubeKernel(self, first, extent, dtype, others)


class CubeKernel:
    """Three slabs in the cube's own frame.

    A ray along a slab is in it for ever or never. The products do not tell (0 times infinity where it lies in
    the plane of a face), and it would be lost.
    """

    faces = 6

    def __init__(self, cube, first, extent, dtype, others):
        inverse = np.linalg.inv(cube.to_world)
        scale = np.abs(inverse[:3, :3]).max()
        inverse[:3, :3][np.abs(inverse[:3, :3]) < 1e-15 * scale] = 0.0
        self.first, self.last = first, first + 5
        self.rows = [tuple(dtype(v) for v in row) for row in inverse[:3, :3]]
        self.shift = [dtype(v) for v in inverse[:3, 3]]
        # Outwards for rays, whichever side of the faces shines.
        self.outward = transform.normals(cube.to_world, _NORMALS).astype(dtype)
        self.others = others
        # No start further from a face than this, anywhere in the scene, is left to rounding.
        rounding = np.finfo(dtype).eps * (
            np.abs(inverse[:3, :3]).sum(axis=1) * extent + np.abs(inverse[:3, 3])
        )
        margin = 0.0 if others is None else others.margin(first, 6).max()
        self.margin = dtype((np.linalg.norm(inverse[:3, :3], axis=1) * margin + 8.0 * rounding).max())
        # Of starts on other shapes around the cube only those that lie in it were put there by rounding.
        self.outer = others is None or not self._holds(cube, others)
        self.one = dtype(1.0)

    def _holds(self, cube, others):
        """Whether any other face has a corner in the cube."""
        corners = np.delete(others.corners, slice(self.first, self.last + 1), axis=2)
        local = transform.points(np.linalg.inv(cube.to_world), corners.reshape(3, -1))
        return bool((np.abs(local) < 1.0 - self.margin).all(axis=0).any())

    def closest(self, rays, within=np.inf):
        """Distance to the first face met, inf for a miss; the rays in the cube's frame, and which enter."""
        o = [linear(row, rays.o) + shift for row, shift in zip(self.rows, self.shift, strict=True)]
        d = [linear(row, rays.d) for row in self.rows]
        near, far = self._slabs(o, d)
        if np.isnan(near).any():
            near, far = self._slabs(o, d, some_along=True)
        hit = (near <= far) & (far > 0.0)
        entering = near > 0.0
        t = hits_only(near, hit)
        inside = hit & ~entering
        own = (rays.source >= self.first) & (rays.source <= self.last)
        if inside.any():
            lanes = np.flatnonzero(inside & ~own)
            t[lanes] = gather(far, lanes)
        if own.any():
            self._from_own_face(t, o, d, rays, np.flatnonzero(own))
            entering &= ~own
        if rays.touched is not None:
            close = inside if self.outer else self._at_surface(o)
            close = np.flatnonzero(close & (rays.source >= 0) & ~own)
            if close.size:
                self._touch(np.stack([gather(o_k, close) for o_k in o]), rays, close)
        if rays.target is not None:
            aimed = np.flatnonzero((rays.target >= self.first) & (rays.target <= self.last))
            if aimed.size:  # a face does not hide the point on it that a ray is aimed at
                same = self._face(o, d, entering, t, aimed) == rays.target[aimed]
                t[aimed[same]] = np.inf
        return t, partial(self._face, o, d, entering, t)

    def _slabs(self, o, d, some_along=False):
        """Distances (N,) at which rays are in all three slabs and leave the first of them."""
        near = far = None
        for o_k, d_k in zip(o, d, strict=True):
            inverse = self.one / d_k
            low, high = (-self.one - o_k) * inverse, (self.one - o_k) * inverse
            enter, leave = np.minimum(low, high), np.maximum(low, high)
            if some_along:
                along = (d_k == 0.0) & (np.abs(o_k) <= self.one)
                np.copyto(enter, -np.inf, where=along)
                np.copyto(leave, np.inf, where=along)
            near = enter if near is None else np.maximum(near, enter)
            far = leave if far is None else np.minimum(far, leave)
        return near, far

    def _from_own_face(self, t, o, d, rays, lanes):
        """Put right the distances of rays that start on this cube: none outwards, the far side inwards.

        Inwards the origin is put back into the cube first, so that a start within rounding of an edge
        cannot slip out between two faces.
        """
        outward = gather(self.outward, gather(rays.source, lanes) - self.first)
        t[lanes] = np.inf
        lanes = lanes[dot(outward, gather(rays.d, lanes)) <= 0.0]
        if lanes.size:
            far, local = np.inf, np.stack([gather(o_k, lanes) for o_k in o])
            for o_k, d_k in zip(local, d, strict=True):
                d_k = gather(d_k, lanes)
                far = np.fmin(far, (np.copysign(self.one, d_k) - np.clip(o_k, -1.0, 1.0)) / d_k)
            t[lanes] = far
            if rays.touched is not None and not self.outer:
                self._touch(local, rays, lanes)

    def _touch(self, local, rays, lanes):
        """Say which rays start, in the cube's own frame, within rounding of which faces."""
        face, lane = np.nonzero(np.abs(_both_ways(local) - self.one) <= self.margin)
        lane, number = lanes[lane], self.first + face
        other = np.flatnonzero(rays.source[lane] != number)
        if other.size:
            rays.touched.append((lane[other], number[other]))

    def _at_surface(self, o):
        """Whether starts, in the cube's own frame, lie within rounding of its surface, inside or out."""
        farthest = np.maximum(np.maximum(np.abs(o[0]), np.abs(o[1])), np.abs(o[2]))
        return np.abs(farthest - self.one) <= self.margin

    def _face(self, o, d, entering, t, lanes):
        """The face whose plane the hit point is nearest to, of those the ray crosses in its direction."""
        t, entering, height, above = gather(t, lanes), gather(entering, lanes), [], []
        for o_k, d_k in zip(o, d, strict=True):
            d_k = gather(d_k, lanes)
            p = gather(o_k, lanes) + t * d_k
            height.append(np.abs(p) * ((p * d_k > 0.0) != entering))
            above.append(p > 0.0)
        z = height[2] > np.maximum(height[0], height[1])
        y = (height[1] > height[0]) & ~z
        return self.first + box_side(y, z, above).astype(np.int32)


def _both_ways(local):
    """Points (3, N) along the outward normals of the six faces, (6, N)."""
    return np.stack((-local, local), axis=1).reshape(6, -1)
