"""The intersection routine of triangle meshes."""

import numpy as np

from tracer.frame import cross, dot, length
from tracer.shape import bvh, start

# Lanes times triangles in flight: small enough to stay in cache.
_CHUNK = 1 << 15
_GRAZING = 1e-3  # cosine below which the distance to a plane may lie outside the triangle


class MeshKernel:
    """Watertight test of triangles (Woop, Benthin and Wald 2013), a leaf of the tree at a time.

    The ray is sheared onto the axis it points along most; the three edge functions of two triangles that
    share an edge are then the same numbers with opposite signs, so no ray passes between them. In float32
    an edge function that comes out as exactly zero is computed again in float64, where products are exact.
    The edge functions also say from which side the triangle is met.

    The distance is that of the plane through the corners as the precision has them, taken from a corner and
    in float64, and for a grazing ray no further than the triangle reaches. Of two triangles met within
    rounding of each other, as near an edge, the one that faces the ray's side is first: a ray that starts in
    front of a triangle is in front of its neighbours, too, and does not meet them from behind. Of triangles
    at the same distance the lowest number wins, whatever the order of the walk.
    """

    def __init__(self, mesh, first, dtype, others):
        self.first, self.faces, self.others = first, mesh.primitives, others
        self.vertices, self.corner_of = mesh.vertices.astype(dtype), mesh.faces
        corners = self.vertices[mesh.faces]
        self.corners = corners.astype(np.float64).transpose(1, 2, 0)  # (3 corners, 3, F)
        self.turn = -1.0 if mesh.flip_normals else 1.0
        self.n = _normals(self.corners, mesh.planes()[0])
        self.rough_n, self.rough_corner = self.n.astype(dtype), self.corners[0].astype(dtype)
        # Wide enough for a ray that starts on a face and, by rounding, behind it.
        self.margin = np.zeros(self.faces) if others is None else others.margin(first, self.faces)
        self.margin = self.margin.astype(dtype)
        pad = self.margin[:, None]
        low, high = corners.min(axis=1) - pad, corners.max(axis=1) + pad
        self.tree, self.low, self.high = bvh.build(low, high), low.T.copy(), high.T.copy()
        self.plane = _same_plane(*mesh.planes())

    def closest(self, rays, within=np.inf):
        """Distance to the nearest triangle before `within` (N,), inf where there is none, and which."""
        n, dtype = rays.source.size, rays.o.dtype
        limit, crossed = np.full(n, within, dtype), []
        over_d = bvh.inverse(rays.d)
        near = np.flatnonzero(bvh.meets(self.tree, rays.o, over_d, limit))
        major = np.argmax(np.abs(rays.d.take(near, axis=1)), axis=0)
        for axis in range(3):
            lanes = near[major == axis]
            if lanes.size:
                self._along(axis, rays, lanes, over_d, limit, crossed)
        t, face = np.full(n, np.inf, dtype), np.full(n, -1, np.int32)
        if crossed:
            self._first(t, face, rays, *(np.concatenate(column) for column in zip(*crossed, strict=True)))
            beyond = t > within
            t[beyond], face[beyond] = np.inf, -1
        return t, self.first + face

    def _along(self, axis, rays, lanes, over_d, limit, crossed):
        """Walk the tree with the rays whose largest component is `axis`; put triples of triangle, ray and
        heading into `crossed`."""
        kx, ky = (axis + 1) % 3, (axis + 2) % 3
        o, d, within = rays.o.take(lanes, axis=1), rays.d.take(lanes, axis=1), limit[lanes]
        sheared = np.stack((o[kx], o[ky], o[axis], d[kx] / d[axis], d[ky] / d[axis]))
        source = rays.source[lanes]
        target = None if rays.target is None else rays.target[lanes]
        plane = None if rays.touched is None else self._planes(rays, lanes)

        def visit(triangles, some, starting):
            if plane is not None:
                begun = some[starting & (plane[some] > -2)]
                if begun.size:
                    self._touching(triangles, rays, lanes[begun], plane[begun])
            step = max(1, _CHUNK // triangles.size)
            for begin in range(0, some.size, step):
                part = some[begin : begin + step]
                sums, inside = self._inside(triangles, (kx, ky, axis), sheared.take(part, axis=1))
                number = self.first + triangles[:, None]
                inside &= source[part] != number
                if target is not None:
                    inside &= target[part] != number
                row, column = np.nonzero(inside)
                if row.size:
                    met, lane = triangles[row], part[column]
                    crossed.append((met, lanes[lane], -self.turn * sums[row, column] * d[axis, lane]))
                    if self.tree.triangles is None:  # there are other leaves
                        self._shorten(within, met, lane, o.take(lane, axis=1), d.take(lane, axis=1))

        bvh.walk(self.tree, o, over_d.take(lanes, axis=1), within, visit)

    def _shorten(self, within, met, lane, o, d):
        """Lower the limits of rays to a little beyond the triangles that they surely meet."""
        n = self.rough_n.take(met, axis=1)
        height, cos = dot(n, o - self.rough_corner.take(met, axis=1)), dot(n, d)
        slack, steep = self.margin[met], np.abs(cos)
        sure = (height * cos < 0.0) & (np.abs(height) > slack) & (steep > _GRAZING)
        beyond = (1.001 * np.abs(height) + slack) / steep
        np.minimum.at(within, lane[sure], beyond[sure])

    def _first(self, t, face, rays, met, lane, heading):
        """Write the nearest of the triangles `met` into t and face of the rays `lane`."""
        t_met, place = self._distances(met, heading, rays, lane)
        first = np.full(t.size, np.inf)
        np.minimum.at(first, lane, place)
        best = np.flatnonzero((place == first[lane]) & np.isfinite(place))
        number = np.full(t.size, self.faces, np.int32)
        np.minimum.at(number, lane[best], met[best])
        best = best[met[best] == number[lane[best]]]
        t[lane[best]], face[lane[best]] = t_met[best], met[best]

    def _sides(self, rays, lanes):
        """On which side of the triangles rays are taken to be, +1 or -1 (N,): that to which they leave
        theirs, in front where they come from elsewhere."""
        side, source = np.ones(lanes.size), rays.source[lanes] - self.first
        own = np.flatnonzero((source >= 0) & (source < self.faces))
        away = rays.o.take(lanes[own], axis=1) - self.corners[0].take(source[own], axis=1)
        side[own] = np.copysign(1.0, dot(self.n.take(source[own], axis=1), away))
        return side

    def _planes(self, rays, lanes):
        """Numbers (N,) of the planes that rays start in, as in self.plane; -1 for other shapes, and -2 where
        they start on none."""
        source = rays.source.take(lanes)
        own = np.flatnonzero((source >= self.first) & (source < self.first + self.faces))
        plane = np.where(source < 0, -2, -1)
        plane[own] = self.plane[source[own] - self.first]
        return plane

    def _touching(self, triangles, rays, lanes, plane):
        """Say which rays, starting in a leaf's box and in these planes, may touch which of its triangles."""
        o = rays.o.take(lanes, axis=1)
        low, high = (
            self.low.take(triangles, axis=1)[:, :, None],
            self.high.take(triangles, axis=1)[:, :, None],
        )
        inside = ((low <= o[:, None]) & (o[:, None] <= high)).all(axis=0)
        row, column = np.nonzero(inside & (plane != self.plane[triangles, None]))
        if row.size:
            met = triangles[row]
            height = dot(self.n.take(met, axis=1), o[:, column] - self.corners[0].take(met, axis=1))
            on = np.abs(height) <= self.margin[met]
            rays.touched.append((lanes[column[on]], self.first + met[on]))

    def _inside(self, triangles, axes, sheared):
        """Sums of the edge functions (T, N) of sheared rays and triangles, and whether they pass through."""
        x, y = _shear(self.vertices, self.corner_of[triangles], axes, sheared)
        u, v, w = _edges(x, y)
        if u.dtype == np.float32:
            again = (u == 0.0) | (v == 0.0) | (w == 0.0)
            if again.any():
                exact = _edges(*([c[again].astype(np.float64) for c in side] for side in (x, y)))
                for edge, better in zip((u, v, w), exact, strict=True):
                    edge[again] = better
        sums = u + v + w
        inside = ((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) | ((u <= 0.0) & (v <= 0.0) & (w <= 0.0))
        return sums, inside & (sums != 0.0)

    def _distances(self, met, heading, rays, lane):
        """Distances (M,) along rays to the planes of triangles they pass through, inf where these are not
        met, and the place of each in the order in which they are met.

        heading: (M,) above 0 where the ray goes out through the front, below 0 where it comes in.
        """
        o, d = rays.o.take(lane, axis=1).astype(np.float64), rays.d.take(lane, axis=1).astype(np.float64)
        n, away = self.n.take(met, axis=1), o - self.corners[0].take(met, axis=1)
        height, cos = dot(n, away), dot(n, d)
        cos = np.where(cos == 0.0, np.finfo(cos.dtype).tiny, cos)
        t, steep = -height / cos, np.abs(cos)
        blur = 4.0 * np.finfo(rays.d.dtype).eps * (np.abs(t) + np.abs(away).max(axis=0)) / steep
        slanted = np.flatnonzero(steep < _GRAZING)
        if slanted.size:
            depth = [dot(corner[:, met[slanted]] - o[:, slanted], d[:, slanted]) for corner in self.corners]
            depth = depth / dot(d[:, slanted], d[:, slanted])
            least, most = depth.min(axis=0), depth.max(axis=0)
            t[slanted] = np.clip(t[slanted], least, most)
            blur[slanted] = np.minimum(blur[slanted], most - least)
        t = start.distance(t, height, heading, o, self.first + met, rays.source[lane], self.others)
        outwards = heading * self._sides(rays, lane)
        return t, np.where(np.isfinite(t), t + np.copysign(blur, outwards), np.inf)


def _same_plane(n, c):
    """A number (F,) for each plane n . x = c, the same for those that differ by rounding only."""
    digits = np.vstack((n, c / np.maximum(np.abs(c).max(), np.finfo(c.dtype).tiny))).round(12)
    return np.unique(digits + 0.0, axis=1, return_inverse=True)[1].reshape(-1)  # -0 + 0 is +0


def planes_through(a, b, c):
    """Unit normals of triangles with these corners, each (3, F), and a point of each plane; 0 without area.

    Rounding tilts the product of two sides of a sliver; its planes hold the longest side all the same.
    """
    n = _unit(cross(b - a, c - a))
    starts, sides = np.stack((a, b, c)), np.stack((b - a, c - b, a - c))
    longest = np.argmax([dot(side, side) for side in sides], axis=0), slice(None), np.arange(a.shape[1])
    along = _unit(sides[longest].T)
    return _unit(n - dot(n, along) * along), starts[longest].T


def _unit(v):
    size = length(v)
    return v / np.where(size > 0.0, size, 1.0)


def _normals(corners, ideal):
    """Unit normals (3, F) of triangles on the side of the ideal ones (3, F), which stand in where rounding
    left no area."""
    n, _ = planes_through(*corners)
    side = dot(n, ideal)
    return np.where(n.any(axis=0), np.where(side < 0.0, -n, n), ideal)


def _shear(vertices, corners, axes, sheared):
    """Corners of triangles (T, 3) across the sheared rays: x and y, each three (T, N)."""
    o, shear_x, shear_y = sheared[:3], sheared[3], sheared[4]
    x, y = [], []
    for k in range(3):
        v = vertices[corners[:, k]]
        away = v[:, axes[2], None] - o[2]
        x.append((v[:, axes[0], None] - o[0]) - shear_x * away)
        y.append((v[:, axes[1], None] - o[1]) - shear_y * away)
    return x, y


def _edges(x, y):
    """The three edge functions: twice the signed areas that the sheared ray's axis cuts off."""
    return x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]
