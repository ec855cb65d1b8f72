"""The intersection routine of triangle meshes."""

import numpy as np

from tracer.frame import cross, dot, length
from tracer.lanes import gather
from tracer.shape import bvh, start

_TESTS = 1 << 14  # pairs of a ray and a triangle in flight: few enough to stay in the cache
_GRAZING = 1e-3  # cosine below which the distance to a plane may lie outside the triangle


class MeshKernel:
    """Watertight test of triangles (Woop, Benthin and Wald 2013), on pairs of a ray and a leaf of the tree.

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
        corners = mesh.vertices.astype(dtype)[mesh.faces]
        # (3 corners, 3, F), in this order in memory: `take` would copy all of any other.
        self.corners = np.ascontiguousarray(corners.transpose(1, 2, 0), np.float64)
        self.turn = -1.0 if mesh.flip_normals else 1.0
        n, c = mesh.planes()
        self.n = np.ascontiguousarray(_normals(self.corners, n))
        self.rough_n, self.rough_corner = self.n.astype(dtype), self.corners[0].astype(dtype)
        # Wide enough for a ray that starts on a face and, by rounding, behind it.
        self.margin = np.zeros(self.faces) if others is None else others.margin(first, self.faces)
        self.margin = self.margin.astype(dtype)
        pad = self.margin[:, None]
        low, high = corners.min(axis=1) - pad, corners.max(axis=1) + pad
        self.low, self.high = low.T.copy(), high.T.copy()
        self.tree = bvh.build(low, high)
        # Corners of a leaf's triangles side by side; an empty place has those of another triangle.
        self.block = corners[self.tree.leaves].transpose(0, 2, 3, 1).reshape(len(self.tree.leaves), -1)
        self.plane = _same_plane(n, c)

    def closest(self, rays, within=np.inf):
        """Distance to the nearest triangle before `within` (N,), inf where there is none, and which."""
        n, dtype = rays.source.size, rays.o.dtype
        limit, crossed = np.full(n, within, dtype), []
        over_d = bvh.inverse(rays.d)
        near, starting = bvh.enter(self.tree, rays.o, over_d, limit)
        for begin in range(0, near.size, bvh.GROUP):
            some = slice(begin, begin + bvh.GROUP)
            self._cross(rays, near[some], over_d, limit, starting[some], crossed)
        t, face = np.full(n, np.inf, dtype), np.full(n, -1, np.int32)
        if crossed:
            self.nearest(t, face, rays, *(np.concatenate(column) for column in zip(*crossed, strict=True)))
            beyond = t > within
            t[beyond], face[beyond] = np.inf, -1
        return t, self.first + face

    def _cross(self, rays, lanes, over_d, limit, starting, crossed):
        """Put triples of triangle, lane and heading into `crossed`, those of the nearest hits of the rays
        `lanes` among them. starting: which of these start in the box around everything."""
        o, d, over_d = (gather(v, lanes) for v in (rays.o, rays.d, over_d))
        within = gather(limit, lanes)
        sheared, axis = sheared_onto_axis(o, d)
        if self.tree.steps:
            leaf, lane = bvh.first_leaves(self.tree, o, over_d, within)
            met, lane, _ = self.through(rays, lanes, sheared, axis, leaf, lane)
            self._shorten(within, met, lane, gather(o, lane), gather(d, lane))
        leaf, lane, starting = bvh.all_leaves(self.tree, o, over_d, within, starting)
        if rays.touched is not None and starting.any():
            begun = np.flatnonzero(starting)
            self.touching(self.tree.leaves[leaf[begun]], rays, lanes[lane[begun]])
        met, lane, sums = self.through(rays, lanes, sheared, axis, leaf, lane)
        if met.size:
            crossed.append(
                (met, gather(lanes, lane), self.heading(rays, gather(lanes, lane), gather(axis, lane), sums))
            )

    def through(self, rays, lanes, sheared, axis, leaf, lane):
        """Triangles (M,) of leaves (P,) that rays pass through, which of `lanes` (M,), and the sums (M,) of
        the edge functions. lane: (P,) the leaves' rays, counted in `lanes`, as are the columns of sheared
        (5, L) and axis (L,). A ray's own triangle and the one it is aimed at are left out."""
        found, of_pair = [], gather(axis, lane)
        step = max(1, _TESTS // self.tree.leaves.shape[1])
        for k in range(3):
            pairs = np.flatnonzero(of_pair == k)
            for begin in range(0, pairs.size, step):
                some = pairs[begin : begin + step]
                ray, leaves = gather(lane, some), gather(leaf, some)
                sums, inside = self._inside(leaves, ((k + 1) % 3, (k + 2) % 3, k), gather(sheared, ray))
                row, column = np.nonzero(inside)
                if row.size:
                    found.append((self.tree.leaves[leaves[column], row], ray[column], sums[row, column]))
        if not found:
            return np.empty(0, np.intp), np.empty(0, np.intp), np.empty(0, sheared.dtype)
        met, lane, sums = (np.concatenate(column) for column in zip(*found, strict=True))
        number, there = self.first + met, met >= 0
        there &= rays.source[lanes[lane]] != number
        if rays.target is not None:
            there &= rays.target[lanes[lane]] != number
        return met[there], lane[there], sums[there]

    def heading(self, rays, lane, axis, sums):
        """Above 0 where rays `lane` (M,) go out through the front of triangles, below 0 where they come in.
        axis: (M,) that they point along most; sums: (M,) of the edge functions."""
        return -self.turn * sums * rays.d[axis, lane]

    def _shorten(self, within, met, lane, o, d):
        """Lower the limits of rays to a little beyond the triangles that they surely meet."""
        n = gather(self.rough_n, met)
        height, cos = dot(n, o - gather(self.rough_corner, met)), dot(n, d)
        slack, steep = self.margin[met], np.abs(cos)
        sure = (height * cos < 0.0) & (np.abs(height) > slack) & (steep > _GRAZING)
        beyond = (1.001 * np.abs(height) + slack) / steep
        np.minimum.at(within, lane[sure], beyond[sure])

    def nearest(self, t, face, rays, met, lane, heading):
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
        away = gather(rays.o, lanes[own]) - gather(self.corners[0], source[own])
        side[own] = np.copysign(1.0, dot(gather(self.n, source[own]), away))
        return side

    def _planes(self, rays, lanes):
        """Numbers (N,) of the planes that rays start in, as in self.plane; -1 for other shapes, and -2 where
        they start on none."""
        source = gather(rays.source, lanes)
        own = np.flatnonzero((source >= self.first) & (source < self.first + self.faces))
        plane = np.where(source < 0, -2, -1)
        plane[own] = self.plane[source[own] - self.first]
        return plane

    def touching(self, triangles, rays, lanes):
        """Say which rays, starting in leaves' boxes, may touch which of their triangles (L, K)."""
        plane = self._planes(rays, lanes)
        o = gather(rays.o, lanes)[:, :, None]
        inside = (triangles >= 0) & (plane[:, None] > -2) & (plane[:, None] != self.plane[triangles])
        for low, high, x in zip(self.low, self.high, o, strict=True):
            inside &= (low[triangles] <= x) & (x <= high[triangles])
        row, column = np.nonzero(inside)
        if row.size:
            met = triangles[row, column]
            height = dot(gather(self.n, met), o[:, row, 0] - gather(self.corners[0], met))
            on = np.abs(height) <= self.margin[met]
            rays.touched.append((lanes[row[on]], self.first + met[on]))

    def _inside(self, leaf, axes, sheared):
        """Sums of the edge functions (K, P) of the triangles of leaves (P,) and sheared rays (5, P), and
        whether they pass through."""
        corners = bvh.columns(self.block, leaf).reshape(3, 3, self.tree.leaves.shape[1], -1)
        x, y = _shear(corners, axes, sheared)
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
        o, d = gather(rays.o, lane).astype(np.float64), gather(rays.d, lane).astype(np.float64)
        n, away = gather(self.n, met), o - gather(self.corners[0], met)
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
    order = np.lexsort(digits)
    other = np.diff(gather(digits, order), axis=1) != 0.0
    number = np.zeros(c.size, np.intp)
    number[order[1:]] = np.cumsum(other.any(axis=0))
    return number


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


def sheared_onto_axis(o, d):
    """What shears rays onto the axis they point along most, (5, N), and that axis, (N,)."""
    axis = np.argmax(np.abs(d), axis=0)
    sheared = np.empty((5, axis.size), o.dtype)
    for k in range(3):
        lanes = np.flatnonzero(axis == k)
        (ox, oy, oz), (dx, dy, dz) = ([gather(v[(k + j) % 3], lanes) for j in (1, 2, 3)] for v in (o, d))
        sheared[:, lanes] = ox, oy, oz, dx / dz, dy / dz
    return sheared, axis


def _shear(corners, axes, sheared):
    """Corners of triangles (3 corners, 3, K, P) across the sheared rays: x and y, each three (K, P)."""
    ox, oy, oz, shear_x, shear_y = sheared
    x, y = [], []
    for corner in corners:
        away = corner[axes[2]] - oz
        x.append((corner[axes[0]] - ox) - shear_x * away)
        y.append((corner[axes[1]] - oy) - shear_y * away)
    return x, y


def _edges(x, y):
    """The three edge functions: twice the signed areas that the sheared ray's axis cuts off."""
    return x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]
