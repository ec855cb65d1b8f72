"""A mesh of few triangles, met plane by plane: what is clear is decided at once, the rest by the exact test.

The distance to a plane and two coordinates in it are a few products, but they know an edge only up to
rounding. So a ray that passes a triangle's edge within what rounding may do, meets two triangles at the same
distance, or starts where it may touch one, is given to the mesh's own kernel (see mesh_kernel): one in
thousands. The answers are that kernel's, but for rounding of the distance, and as watertight.
"""

from functools import partial
from typing import NamedTuple

import numpy as np

from tracer.lanes import gather
from tracer.shape.cull import Around, hand_on
from tracer.shape.mesh_kernel import MeshKernel
from tracer.shape.rays import hits_only, linear

MOST = 24  # triangles that are few
# Machine epsilons of the largest coordinate by which a point on a plane may be off where the cosine is 1.
_ROUNDING = 64.0
_CLEAR = 0.05  # of a triangle that may be in doubt, so that most rays are not
_BESIDE = 1.001  # distances further apart than this are so whatever the rounding


class Plane(NamedTuple):
    """Triangles in one plane."""

    n: tuple  # normal, three numbers
    c: float  # n . x = c
    axes: tuple  # the two axes across which triangles are looked at
    triangles: list  # of (number, rows): (a, b, c) each, so that a x + b y + c is a barycentric coordinate
    doubt: list  # of each triangle, by how much rounding may move its coordinates where the cosine is 1
    low: np.ndarray  # (3,) corners of a box around them; starts elsewhere touch none
    high: np.ndarray


def by_planes(kernel, mesh, extent, dtype, others):
    """The kernel of a shape, as FewKernel if it is that of a mesh of few triangles, none of them a sliver."""
    if not isinstance(kernel, MeshKernel) or kernel.faces > MOST:
        return kernel
    blur = dtype(_ROUNDING * np.finfo(dtype).eps * extent)
    planes = [_plane(kernel, mesh, k, blur) for k in range(kernel.plane.max() + 1)]
    if any(doubt > _CLEAR for plane in planes for doubt in plane.doubt):
        return kernel
    return FewKernel(kernel, planes, blur, Around(mesh, extent, dtype, others))


def _plane(kernel, mesh, k, blur):
    """Plane number k of a mesh."""
    dtype, numbers = type(blur), np.flatnonzero(kernel.plane == k)
    n, c = (v[..., numbers[0]] for v in mesh.planes())
    n = np.where(np.abs(n) < 1e-15, 0.0, n)
    dropped = int(np.argmax(np.abs(n)))
    axes = (dropped + 1) % 3, (dropped + 2) % 3
    triangles, doubt = [], []
    for number in numbers:
        corners = kernel.corners[:, axes, number]
        one, other = corners[1:] - corners[0]
        doubled = one[0] * other[1] - one[1] * other[0]
        size = np.abs(corners - np.roll(corners, 1, axis=0)).sum(axis=1).max()
        doubt.append(dtype(blur * size / abs(doubled)) if doubled else dtype(np.inf))
        slopes = np.array([[other[1], -other[0]], [-one[1], one[0]]]) / (doubled or 1.0)
        rows = np.column_stack((slopes, -slopes @ corners[0]))
        triangles.append((int(number), [tuple(dtype(v) for v in row) for row in rows]))
    low, high = kernel.low[:, numbers].min(axis=1), kernel.high[:, numbers].max(axis=1)
    return Plane(tuple(dtype(v) for v in n), dtype(c), axes, triangles, doubt, low, high)


class FewKernel:
    """The planes of a mesh.

    exact: its MeshKernel; blur: metres by which a point on a plane may be off where the cosine is 1; around:
    the box that holds all triangles.
    """

    def __init__(self, exact, planes, blur, around):
        self.exact, self.first, self.faces = exact, exact.first, exact.faces
        # Before the first triangle and after the last there are other shapes' numbers, on no plane of these.
        self._home = np.concatenate(([-1], exact.plane, [-1]))
        self._planes, self._blur, self._around = planes, blur, around
        self._margin = exact.margin.max()

    def closest(self, rays, within=np.inf):
        """Distance to the nearest triangle, inf where there is none, and what tells which it is."""
        lanes = np.flatnonzero(self._around.passing(rays))
        o, d, source = gather(rays.o, lanes), gather(rays.d, lanes), gather(rays.source, lanes)
        target = None if rays.target is None else gather(rays.target, lanes)
        near, of_triangle, doubtful = self._met(o, d, source, target)
        t = np.full(rays.source.shape, np.inf, o.dtype)
        t[lanes] = near
        again = gather(lanes, np.flatnonzero(doubtful))
        exact = np.empty(0, np.int32)
        if again.size:
            some = rays.take(again, None if rays.touched is None else [])
            t[again], exact = self.exact.closest(some)
            hand_on(some, rays, again)
        return t, partial(self._numbers, t, lanes, of_triangle, again, exact)

    # A ray along a plane has no distance to it: inf or NaN, which no comparison below takes for a hit.
    @np.errstate(divide="ignore", invalid="ignore", over="ignore")
    def _met(self, o, d, source, target):
        """Distance (N,) to the nearest triangle, inf where there is none; pairs of a triangle and the
        distances (N,) at which it is met; and whether any of that is in doubt, (N,)."""
        home = gather(self._home, np.clip(source - (self.first - 1), 0, self.faces + 1))
        best, of_triangle = np.full(source.shape, np.inf, o.dtype), []
        doubtful = np.zeros(source.shape, bool)
        for k, plane in enumerate(self._planes):
            height, cos = linear(plane.n, o) - plane.c, linear(plane.n, d)
            t, steep, other = -height / cos, np.abs(cos), home != k
            close = (np.abs(height) <= self._margin) & other
            some_close = close.any()
            if some_close:
                doubtful |= close & _in_box(plane, o)
            x, y = (o[axis] + t * d[axis] for axis in plane.axes)
            for (number, (first, second)), doubt in zip(plane.triangles, plane.doubt, strict=True):
                u, v = (a * x + b * y + c for a, b, c in (first, second))
                inside = np.minimum(np.minimum(u, v), 1.0 - (u + v)) * steep
                ahead = other & (t > 0.0) & (t < best * _BESIDE)
                if target is not None:
                    ahead &= target != self.first + number
                hit = ahead & (inside > -doubt)
                doubtful |= hit & ((inside <= doubt) | (np.abs(t - best) * steep <= self._blur))
                if some_close:
                    doubtful |= hit & close
                met = hits_only(t, hit)
                of_triangle.append((number, met))
                best = np.fmin(best, met)
        return best, of_triangle, doubtful

    def _numbers(self, t, lanes, of_triangle, again, exact, asked):
        """The triangles that the rays `asked` meet at t."""
        place = np.empty(t.size, np.intp)
        place[lanes] = np.arange(lanes.size)
        place = gather(place, asked)
        t, number = gather(t, asked), np.zeros(asked.size, np.int32)
        for triangle, met in of_triangle[::-1]:
            number[gather(met, place) == t] = triangle
        number += self.first
        if again.size:
            place = np.minimum(np.searchsorted(again, asked), again.size - 1)
            same = gather(again, place) == asked
            number[same] = exact[place[same]]
        return number


def _in_box(plane, o):
    """Whether starts o (3, N) lie in a plane's box."""
    return np.all(
        [(x >= low) & (x <= high) for x, low, high in zip(o, plane.low, plane.high, strict=True)], axis=0
    )
