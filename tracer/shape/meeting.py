"""What rays meet among all the shapes of a scene.

The routines of its Arrangement are asked together; rays whose starts or ends touch other faces are moved off
these and asked once more (see `start` and `end`).
"""

import numpy as np

from tracer.frame import dot, length
from tracer.lanes import choose, put
from tracer.shape import end, start
from tracer.shape.rays import Rays


class Meeting:
    """An arrange.Arrangement with the start.Faces of all primitives and the end.Beside of its lamps."""

    def __init__(self, arrangement, faces, beside, dtype):
        self._closest, self._blocking = arrangement.closest, arrangement.blocking
        self._faces, self._beside, self._dtype = faces, beside, dtype

    def closest(self, rays, distance=None):
        """Where rays meet something first: t (N,), inf for nothing, and primitive (N,), -1 there.

        distance: (N,) to the point that rays are aimed at, if they are.
        """
        t, primitive = self._nearest(rays)
        if rays.touched:
            lanes, moved, _ = start.moved(self._faces, rays, distance)
            if lanes.size:
                t[lanes], primitive[lanes] = self._nearest(moved)
        if not np.isfinite(rays.o.sum() + rays.d.sum()):  # slabs alone would drop the NaN and hit
            none = ~np.isfinite(rays.o + rays.d).all(axis=0)
            t[none], primitive[none] = np.inf, -1
        return t, primitive

    def started(self, o, d, source):
        """Where rays that `closest` is asked of start in the end, (3, N): off other faces they touch."""
        rays, o = Rays.towards(o, d, source, touched=[]), o.copy()
        self._nearest(rays)
        if rays.touched:
            lanes, moved, _ = start.moved(self._faces, rays)
            put(o, lanes, moved.o)
        return o

    def _nearest(self, rays):
        t = np.full(rays.source.shape, np.inf, self._dtype)
        primitive = np.full(rays.source.shape, -1, np.int32)
        for kernel in self._closest:
            t_k, met = kernel.closest(rays, t)
            nearer = t_k < t
            if isinstance(met, np.ndarray):
                primitive = choose(nearer, met, primitive)
            else:
                lanes = np.flatnonzero(nearer)
                primitive[lanes] = met(lanes) if callable(met) else met
            t = np.fmin(t, t_k)  # fmin: a distance that is not a number is a miss
        return t, primitive

    def between(self, o, goal, n, source, target, wi):
        """Rays from starts o to goals on primitives `target`, their lengths (N,), and whether the face they
        start on, with normals n, hides an end that had to be moved, (N,); False where none had to be.

        o, goal: (3, N), both moved off their surfaces; wi: (3, N) from one to the other before that.
        """
        hidden = False
        if self._beside:
            end.clear_ends(self._faces, self._beside, goal, target)
            hidden = dot(n, goal - o) * dot(n, wi) < 0.0
        gap = goal - o
        distance = length(gap)
        return Rays.towards(o, gap / distance, source, target, []), distance, hidden

    def blocked(self, rays, distance):
        """Whether anything lies on the way of rays within a distance (N,), (N,) bool."""
        blocked = self._blocked(rays, distance)
        if rays.touched:
            lanes, moved, distance = start.moved(self._faces, rays, distance)
            if lanes.size:
                blocked[lanes] = self._blocked(moved, distance)
        return blocked

    def _blocked(self, rays, distance):
        blocked = np.zeros(distance.shape, bool)
        for blocks in self._blocking:
            blocked |= blocks(rays, distance)
        return blocked
