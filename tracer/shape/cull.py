"""Rays that cannot meet a shape are not given to its routine.

For the nearest hit a box around the shape tells. For shadows the start alone does: a shape hides no point on
a lamp from outside the shadow that all lamps together could give it, which a box bounds, nor from in front of
all its planes if all lamps are in front of them, too.
"""

import numpy as np

from tracer.lanes import gather
from tracer.shape.rays import linear

_SLACK = 16.0  # machine epsilons by which rounding may put off a distance
_PLANES = 4  # of a shape that are worth asking on which side a start is


class Around:
    """A box around a shape, wider by more than any start is off its surface."""

    def __init__(self, shape, extent, dtype, others):
        vertices = shape.triangles()[0]
        pad = 16.0 * np.finfo(dtype).eps * max(extent, np.abs(vertices).max())
        pad += 0.0 if others is None else 2.0 * others.most
        self.low, self.high = vertices.min(axis=0) - pad, vertices.max(axis=0) + pad
        self._planes = [(dtype(low), dtype(high)) for low, high in zip(self.low, self.high, strict=True)]
        self._longer = dtype(1.0 + _SLACK * np.finfo(dtype).eps)

    def passing(self, rays):
        """Whether rays pass the box, or start in it, (N,); never False for one that meets the shape."""
        near = far = None
        for (low, high), o, inverse in zip(self._planes, rays.o, rays.inv_d, strict=True):
            one, other = (low - o) * inverse, (high - o) * inverse
            enter, leave = np.minimum(one, other), np.maximum(one, other)
            # fmax, fmin: where a ray runs along a plane that it starts in, 0 times infinity says nothing.
            near = enter if near is None else np.fmax(near, enter)
            far = leave if far is None else np.fmin(far, leave)
        return ~((near > far * self._longer) | (far < 0.0))


class Shadow:
    """Whether a shape blocks shadow rays, asked where it can.

    kernel: the shape's; corners, lamps: points (3, K) whose convex hulls hold the shape and all that shines;
    shines: whether the shape does; bounds: corners of the scene; faces: the Faces of all primitives.
    """

    def __init__(self, kernel, shape, corners, shines, lamps, bounds, dtype, faces):
        self.kernel, self._shines = kernel, shines
        self.first, self.last = kernel.first, kernel.first + shape.primitives - 1
        pad = 8.0 * faces.most
        low, high = _shadow(_grown(_bounds(corners), pad), _grown(_bounds(lamps), pad), bounds)
        self._sides = [
            (axis, dtype(low[axis]), dtype(high[axis]))
            for axis in range(3)
            if low[axis] > bounds[0][axis] or high[axis] < bounds[1][axis]
        ]
        self._fronts = []
        n, c = shape.planes()
        if c.size <= _PLANES and n.any() and ((n.T @ lamps).min(axis=1) - c > pad).all():
            self._fronts = [(tuple(dtype(v) for v in n[:, k]), dtype(c[k])) for k in range(c.size)]
            self._margin = dtype(faces.margin(kernel.first, c.size).max())

    @property
    def tells(self):
        """Whether there are starts that need not be asked."""
        return bool(self._sides or self._fronts)

    def __call__(self, rays, distance):
        """Whether the shape lies between each ray's start and the point `distance` (N,) along it, (N,)."""
        if not self._shines:  # no ray is aimed at it
            rays = rays._replace(target=None)
        lanes = np.flatnonzero(self._reached(rays))
        some, distance = rays.take(lanes, None if rays.touched is None else []), gather(distance, lanes)
        blocked = np.zeros(rays.source.shape, bool)
        blocked[lanes] = self.kernel.closest(some, distance)[0] < distance
        hand_on(some, rays, lanes)
        return blocked

    def _reached(self, rays):
        """Which rays start where the shape may hide a point on a lamp, (N,)."""
        asked = np.ones(rays.source.shape, bool)
        for axis, low, high in self._sides:
            asked &= (rays.o[axis] >= low) & (rays.o[axis] <= high)
        if self._fronts:
            lowest = np.min([linear(n, rays.o) - c for n, c in self._fronts], axis=0)
            own = (rays.source >= self.first) & (rays.source <= self.last)
            # Within rounding of a plane the definition decides for starts on other shapes (see start).
            asked &= (lowest <= 0.0) | ((lowest <= self._margin) & ~own)
        return asked


def hand_on(some, rays, lanes):
    """Tell `rays` which starts the rays `some`, those of its lanes (L,), may touch what."""
    if some.touched:
        rays.touched.extend((lanes[lane], number) for lane, number in some.touched)


def _bounds(points):
    """Corners of the box around points (3, K)."""
    return points.min(axis=1), points.max(axis=1)


def _grown(box, pad):
    return box[0] - pad, box[1] + pad


def _shadow(body, lamps, bounds):
    """The box (low, high) around the shadow that one box casts from lamps in another, within `bounds`: all
    x + s (x - q), s >= 0, with x in the body and q in the lamps' box."""
    least, most = body[0] - lamps[1], body[1] - lamps[0]  # of the directions x - q
    with np.errstate(divide="ignore", invalid="ignore"):
        down = np.where(most < 0.0, (body[1] - bounds[0]) / -most, np.inf)
        up = np.where(least > 0.0, (bounds[1] - body[0]) / least, np.inf)
    far = max(min(down.min(), up.min()), 0.0)  # s up to which the shadow is within the bounds
    if np.isinf(far):
        return bounds
    low, high = body[0] + far * np.minimum(least, 0.0), body[1] + far * np.maximum(most, 0.0)
    return np.maximum(low, bounds[0]), np.minimum(high, bounds[1])
