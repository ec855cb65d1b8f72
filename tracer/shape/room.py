"""Walls that are faces of one box, met as that box: three pairs of planes instead of up to six rectangles.

A ray that starts inside a convex box leaves it through exactly one of its faces: through the nearest of the
three planes it moves towards. No wall's edges are asked for, so there is no gap between two walls; a start
that rounding left outside a plane it moves towards meets that wall at once, at a distance of 0. Sides without
a wall are open: rays leave there. What starts outside (the camera before an open side, what pokes through a
wall) asks the walls themselves.

Between two points inside no wall ever blocks.
"""

import numpy as np

from tracer.lanes import gather
from tracer.shape.rays import box_side
from tracer.shape.rectangle import Rectangle

_SLACK = 1e-9  # of the box's size: edges that differ by less are the same edge
FEWEST = 3  # walls that are worth it
_GRAZING = 8.0  # machine epsilons: cosines that rounding may have turned round


def find(shapes, sealed):
    """Numbers of the shapes that wall a box up: along -x, +x, -y, +y, -z and +z, -1 for an open side.

    None if there is no such box. sealed: of each shape, whether no path ever goes on behind its front. Walls
    are rectangles across the axes that face inwards and reach from edge to edge of the box around them all.
    """
    flat = [k for k, shape in enumerate(shapes) if sealed[k] and _across_an_axis(shape)]
    if len(flat) < FEWEST:
        return None
    low, high = np.array([_bounds(shapes[k]) for k in flat]).transpose(1, 0, 2)
    low, high = low.min(axis=0), high.max(axis=0)
    walls = [-1] * 6
    for k in flat:
        side = _side(shapes[k], low, high)
        if side is not None and walls[side] < 0:
            walls[side] = k
    return walls if sum(k >= 0 for k in walls) >= FEWEST else None


def _across_an_axis(shape):
    """Whether a shape is a rectangle whose normal and edges run along the axes."""
    if not isinstance(shape, Rectangle):
        return False
    return np.count_nonzero(shape.planes()[0]) == 1 and np.count_nonzero(np.stack(shape.edges)) == 2


def _bounds(shape):
    vertices = shape.triangles()[0]
    return vertices.min(axis=0), vertices.max(axis=0)


def _side(rectangle, low, high):
    """The side of the box from low to high that a rectangle closes, None if it closes none."""
    n = rectangle.planes()[0][:, 0]
    axis = int(np.argmax(np.abs(n)))
    upper = int(n[axis] < 0.0)
    wanted = np.stack((low, high))
    wanted[:, axis] = wanted[upper, axis]
    found = np.stack(_bounds(rectangle))
    return 2 * axis + upper if np.abs(found - wanted).max() <= _SLACK * (high - low).max() else None


class RoomKernel:
    """Three slabs with the planes of the walls.

    walls: as from find; kernels: of all shapes, for what starts outside. never_blocks: whether all that
    shines lies in the box, so that no wall hides it from what is in there, too.
    """

    faces = 6

    def __init__(self, walls, shapes, kernels, dtype):
        self._walls = [kernels[k] for k in walls if k >= 0]
        self._number = np.array([kernels[k].first if k >= 0 else -1 for k in walls], np.int32)
        self.never_blocks, self._open = False, bool((self._number < 0).any())
        bounds = np.array([_bounds(shapes[k]) for k in walls if k >= 0])
        self._low, self._high = (
            [dtype(v) for v in corner] for corner in (bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0))
        )
        self._margin = max(wall.margin for wall in self._walls)

    def holds(self, o):
        """Whether all points (3, N) lie in the box, but for rounding."""
        return self._past(o) <= self._margin

    def _past(self, o):
        """How far points (3, N) lie outside the box at most; below 0 if they all lie in it."""
        if not o.size:
            return np.inf
        past = [
            (low - x.min(), x.max() - high) for low, x, high in zip(self._low, o, self._high, strict=True)
        ]
        return np.max(past)  # not a number if any point is none

    def blocks(self, rays, distance):
        """Whether a wall lies between each ray's start and the point `distance` (N,) along it."""
        if self.never_blocks and self.holds(rays.o):
            return np.zeros(distance.shape, bool)
        return self.closest(rays)[0] < distance

    def closest(self, rays, within=np.inf):
        """Distance to the wall each ray meets, inf where there is none, and the wall's primitive."""
        past = self._past(rays.o)
        if past <= self._margin:
            if past > 0.0 and rays.touched is not None:
                self._touch(rays)
            return self._from_inside(rays)
        t, primitive = self._one_by_one(rays)
        within = np.ones(t.shape, bool)
        for k in range(3):
            within &= rays.o[k] >= self._low[k] - self._margin
            within &= rays.o[k] <= self._high[k] + self._margin
        lanes = np.flatnonzero(within)
        if lanes.size:
            t[lanes], primitive[lanes] = self._from_inside(rays.take(lanes))
        return t, primitive

    def _touch(self, rays):
        """Say which rays start outside a wall, by rounding."""
        for k in range(3):
            for number, past in (
                (self._number[2 * k], rays.o[k] < self._low[k]),
                (self._number[2 * k + 1], rays.o[k] > self._high[k]),
            ):
                lanes = np.flatnonzero(past & (rays.source >= 0) & (rays.source != number))
                if lanes.size and number >= 0:
                    rays.touched.append((lanes, np.full(lanes.size, number)))

    def _one_by_one(self, rays):
        t = np.full(rays.source.shape, np.inf, rays.o.dtype)
        primitive = np.full(t.shape, -1, np.int32)
        for wall in self._walls:
            t_wall, _ = wall.closest(rays)
            primitive[np.flatnonzero(t_wall < t)] = wall.first
            t = np.fmin(t, t_wall)
        return t, primitive

    def _from_inside(self, rays):
        # fmax: where a ray runs along a plane that it starts in, 0 times infinity says nothing.
        far = [
            np.fmax((low - o) * inverse, (high - o) * inverse)
            for low, high, o, inverse in zip(self._low, self._high, rays.o, rays.inv_d, strict=True)
        ]
        t, primitive = self._exit(rays, far)
        own = np.flatnonzero(primitive == rays.source)
        if own.size:
            t[own], primitive[own] = self._from_own_plane(rays.take(own), gather(np.stack(far), own))
        if self._open or rays.target is not None:
            out = primitive < 0
            if rays.target is not None:
                out |= primitive == rays.target
            t[np.flatnonzero(out)] = np.inf
        return t, primitive

    def _from_own_plane(self, rays, far):
        """The same for rays that would meet the wall they start on: they leave the box for good, or graze the
        wall so closely that only rounding turned them towards it."""
        axis = np.argmax(self._number == rays.source[:, None], axis=1) // 2
        far[axis, np.arange(axis.size)] = np.inf
        t, primitive = self._exit(rays, far)
        grazing = np.abs(rays.d[axis, np.arange(axis.size)]) <= _GRAZING * np.finfo(t.dtype).eps
        return np.where(grazing, t, np.inf), np.where(grazing, primitive, -1)

    def _exit(self, rays, far):
        """Distance and wall where rays leave that reach their far planes at `far`, three (N,)."""
        xy = np.minimum(far[0], far[1])
        z = far[2] < xy
        y = (far[1] < far[0]) & ~z
        side = box_side(y, z, [inverse > 0.0 for inverse in rays.inv_d])
        return np.maximum(np.minimum(xy, far[2]), 0.0), gather(self._number, side)
