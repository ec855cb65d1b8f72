"""Starts that lie within rounding of other faces than their own.

A ray starts on a face A, moved off it by A's error bound to the side where it leaves. If the start lies
within rounding of another face B too, rounding would decide on which side of B it is, and whether the ray is
still in the room. The definition decides instead, by the corners of both faces:

1. B is met only if it reaches into the side of A's plane to which the ray leaves. A coplanar or a convex
   neighbour does not: no ray from A ever meets it.
2. Such a B has the start on the side on which A lies; in front, if A lies on both.
3. Where the start is not clear of B on that side, it is moved along A until it is, by B's error bound:
   towards the middle of A if A ends at B, straight away from B if A runs on underneath.

So every ray starts where it could have started without rounding, strictly inside the space in front of all
the faces that it touches, and the intersection routines need no exception: what is watertight for a ray from
the middle of a room is watertight for a ray from its corner.
"""

from typing import NamedTuple

import numpy as np

from tracer.frame import cross, dot, length
from tracer.shape.rays import Rays

_MARGIN = 1.5  # of two faces' error bounds: nearer starts may be on the wrong side
_CLEAR = 0.5  # error bounds from a plane at which a start is surely on its side
_SAME = 32.0  # machine epsilons, relative, by which corners may miss a plane they are meant to lie in
_LEAST = 1e-6  # sine between a plane and a way that leads off it
_PARALLEL = 8.0  # machine epsilons between the normals of planes that rounding cannot tell apart


class Faces(NamedTuple):
    """What the definition says of every primitive of a scene, in float64, and the precision rays have."""

    n: np.ndarray  # (3, P) normal of its plane; 0 for a sphere
    c: np.ndarray  # (P,) offset of its plane n . x = c
    corners: np.ndarray  # (3, 4, P); a sphere's centre
    weight: np.ndarray  # (3, P) |n|; 1 for a sphere
    reach: np.ndarray  # (P,) largest weight . |x| of its points
    flat: np.ndarray  # (P,) whether it is flat
    most: float  # largest error bound of any start in the scene
    eps: float

    @classmethod
    def of(cls, shapes, dtype):
        """The primitives of some shapes, in their order."""
        planes = [shape.planes() for shape in shapes]
        n = np.concatenate([n for n, _ in planes], axis=1)
        corners = np.concatenate([shape.outline() for shape in shapes], axis=2)
        flat = n.any(axis=0)
        weight = np.where(flat, np.abs(n), 1.0)
        reach = dot(weight[:, None], np.abs(corners)).max(axis=0)
        size = np.max([np.abs(shape.triangles()[0]).max(axis=0) for shape in shapes], axis=0)
        reach[~flat] = size.sum()
        eps = float(np.finfo(dtype).eps)
        most = 8.0 * eps * (dot(weight, size) + reach).max()
        return cls(n, np.concatenate([c for _, c in planes]), corners, weight, reach, flat, most, eps)

    def bound(self, face, x):
        """Error bound (N,) of points x (3, N) on faces (N,); as rays.error_bound."""
        return 8.0 * self.eps * (dot(self.weight[:, face], np.abs(x)) + self.reach[face])

    def margin(self, first, count):
        """How near any start must be to the planes of the faces from `first` on for rounding to decide on its
        side, (count,)."""
        own = slice(first, first + count)
        return _MARGIN * (16.0 * self.eps * self.reach[own] + self.most)

    def close(self, own, other, x):
        """Whether starts x (3, N) on faces `own` lie within rounding of the planes of faces `other`, (N,)."""
        height = dot(self.n[:, other], x) - self.c[other]
        return np.abs(height) <= _MARGIN * (self.bound(own, x) + self.bound(other, x))


def distance(t, height, heading, o, number, source, faces):
    """Distances (N,) at which planes are met, inf where they are not.

    t: (N,) where rays cross them; height: (N,) of the starts o (3, N) over them; heading: (N,) above 0 where
    rays go out through the front, below 0 where they come in; number, source: (N,) primitive the plane
    belongs to, and primitive each ray starts on, -1 for none; faces: the Faces, or None.
    """
    hit = t > 0.0
    if faces is not None:
        lanes = np.flatnonzero((np.abs(height) <= 2.0 * _MARGIN * faces.most) & (source >= 0))
        if lanes.size:
            own, number = source[lanes], np.broadcast_to(number, source.shape)[lanes]
            x = o[:, lanes].astype(np.float64)
            close = faces.close(own, number, x)
            lanes = lanes[close]
            side, _ = relation(faces, own[close], number[close], x[:, close])
            hit[lanes] = side * heading[lanes] < 0.0
            t = np.maximum(t, 0.0)
    return np.where(hit, t, np.inf)


def relation(faces, own, other, o):
    """On which side of the planes of faces `other` rays start that start on faces `own`: +1, -1, or 0 where
    they can never meet the other face; and whether their own face lies on both sides. All (N,).

    o: (3, N) starts, moved off their own faces.
    """
    out = np.copysign(1.0, dot(faces.n[:, own], o) - faces.c[own])
    up, down = sides(faces, own, other)
    reaches = np.where(out > 0.0, up, down) | ~faces.flat[own]
    ahead, behind = sides(faces, other, own)
    side = np.where(ahead, 1, np.where(behind, -1, 0))
    return np.where(reaches, side, 0), ahead & behind


def sides(faces, plane, body):
    """Whether faces `body` reach in front of the planes of faces `plane`, and behind them, two (N,) bool.

    Within rounding of the scene's precision they do neither, unless all of the face is so near and yet tilted
    against the plane by more than that: then the definition's own precision decides.
    """
    n, corners = faces.n[:, None, plane], faces.corners[:, :, body]
    height = dot(n, corners) - faces.c[plane]
    size = _SAME * (dot(np.abs(n), np.abs(corners)) + faces.reach[plane])
    ahead, behind = (height > faces.eps * size).any(axis=0), (height < -faces.eps * size).any(axis=0)
    near = np.flatnonzero(~(ahead | behind))
    if near.size:
        tilt = np.abs(cross(faces.n[:, plane[near]], faces.n[:, body[near]])).max(axis=0)
        near = near[tilt > _PARALLEL * faces.eps]
        size = np.finfo(np.float64).eps * size[:, near]
        ahead[near] = (height[:, near] > size).any(axis=0)
        behind[near] = (height[:, near] < -size).any(axis=0)
    return ahead, behind


def moved(faces, rays, distance=None):
    """The lanes (L,) of rays whose starts had to be moved off faces they touch, and their rays from there;
    with the distance (N,) to the points that rays are aimed at: towards these, and the distance (L,) now."""
    lanes, others = (np.concatenate(column) for column in zip(*rays.touched, strict=True))
    lanes, o = clear(faces, rays.o, rays.source, lanes, others)
    o = o.astype(rays.o.dtype)
    again = rays.take(lanes)
    if distance is None:
        return lanes, again._replace(o=o), None
    gap = again.o + distance[lanes] * again.d - o
    distance = length(gap)
    return lanes, Rays.towards(o, gap / distance, again.source, again.target), distance


def clear(faces, o, source, lanes, others):
    """Starts moved off other faces that they touch.

    o, source: (3, N) and (N,) of all rays; lanes, others: (M,) pairs of a ray and a face that is not its own.
    Returns the lanes (L,) of starts that had to be moved, ascending, and where to, (3, L) in float64.
    """
    order = np.lexsort((others, lanes))  # so that sums below do not depend on who else is here
    lanes, others = lanes[order], others[order]
    own, x = source[lanes], o[:, lanes].astype(np.float64)
    close = np.flatnonzero(faces.close(own, others, x))
    lanes, others, own, x = lanes[close], others[close], own[close], x[:, close]
    side, both = relation(faces, own, others, x)
    n, bound = side * faces.n[:, others], faces.bound(others, x)
    short = bound - (dot(n, x) - side * faces.c[others])
    near = np.flatnonzero((side != 0) & (short > _CLEAR * bound))
    moved, lane = np.unique(lanes[near], return_inverse=True)
    out = np.empty((3, moved.size))
    if moved.size:
        own, x = own[near], x[:, near]
        runs_on = both[near] | ~faces.flat[own]
        out[:, lane] = x + _steps(faces, own, x, n[:, near], short[near], runs_on, lane)
    return moved, out


def _steps(faces, own, x, n, short, runs_on, lane):
    """Steps (3, M) along their own faces that bring starts x (3, M) in front of planes with normals n (3, M),
    of which they fall `short` (M,); runs_on: whether their own face does not end there; lane: (M,) number of
    the ray, the same step for all pairs of one."""
    up = faces.n[:, own]
    away = n - dot(n, up) * up
    away = np.where(runs_on, away / np.maximum(length(away), np.finfo(away.dtype).tiny), 0.0)
    away = np.stack([np.bincount(lane, part)[lane] for part in away])
    first = _far_enough(away, n, np.where(runs_on, short, 0.0), lane, np.inf)
    home = faces.corners[:, :, own].mean(axis=1) - x - first
    home = home - dot(home, up) * up
    return first + _far_enough(home, n, np.where(runs_on, 0.0, short - dot(n, first)), lane, 1.0)


def _far_enough(way, n, short, lane, most):
    """The steps (3, M) along `way`, the same for all pairs of a lane, that rise by `short` over each plane;
    none is longer than `most` times the way, and planes along which it leads are left out."""
    rate = dot(n, way)
    rising = (rate > _LEAST * length(way)) & (short > 0.0)
    share = np.where(rising, short, 0.0) / np.where(rising, rate, 1.0)
    largest = np.zeros(lane.max() + 1)
    np.maximum.at(largest, lane, share)
    return np.minimum(largest, most)[lane] * way
