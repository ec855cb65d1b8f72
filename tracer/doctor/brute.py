"""Every primitive asked one by one, in float64, with no tree, no arrangement and no special case.

A point known up to `slack` metres leaves room for doubt near edges and where rays graze: each answer says
what is surely met, and what may be.
"""

from functools import cached_property

import numpy as np

from tracer.frame import dot, normalize
from tracer.shape.mesh import Mesh
from tracer.shape.sphere import Sphere

_PAIRS = 1 << 18  # rays times primitives looked at together: what fits into a cache
_GRAZING = 1e-9  # cosine below which a ray runs along a plane


class Brute:
    """The flat faces and spheres of a scene as tables, one column per primitive."""

    def __init__(self, scene):
        flat, spheres = [], []
        self._shapes = list(zip(scene.first, scene.shapes, strict=True))
        for first, shape in self._shapes:
            if isinstance(shape, Sphere):
                spheres.append((first, shape.center, shape.radius, -1.0 if shape.flip_normals else 1.0))
                continue
            triangles = isinstance(shape, Mesh)
            corner, e1, e2 = shape.corners() if triangles else shape.parallelograms()
            n, c = shape.planes()
            number = first + np.arange(shape.primitives)
            flat.append((number, np.full(number.size, triangles), corner, e1, e2, n, c))
        self.size = scene.shape_of.size
        self._prepare_flat(flat)
        self.sphere = np.array([s[0] for s in spheres], np.intp)
        self.center = np.array([s[1] for s in spheres]).reshape(-1, 3).T
        self.radius = np.array([s[2] for s in spheres])
        self.side = np.array([s[3] for s in spheres])
        self.column = np.full(self.size, -1)
        self.column[self.flat] = np.arange(self.flat.size)
        self.column[self.sphere] = np.arange(self.sphere.size)
        self.is_sphere = np.zeros(self.size, bool)
        self.is_sphere[self.sphere] = True

    def _prepare_flat(self, flat):
        if not flat:
            flat = [
                (np.empty(0, np.intp), np.empty(0, bool), *(np.empty((3, 0)) for _ in range(4)), np.empty(0))
            ]
        columns = [np.concatenate(parts, axis=-1) for parts in zip(*flat, strict=True)]
        self.flat, self.triangle, self.corner, self.e1, self.e2, self.n, self.c = columns
        self.flat = self.flat.astype(np.intp)
        # g1 . e1 = 1, g1 . e2 = 0, g1 . n = 0, and likewise g2: coordinates of a point in the face.
        d11, d12, d22 = dot(self.e1, self.e1), dot(self.e1, self.e2), dot(self.e2, self.e2)
        det = np.maximum(d11 * d22 - d12 * d12, np.finfo(float).tiny)
        self.g1 = (d22 * self.e1 - d12 * self.e2) / det
        self.g2 = (d11 * self.e2 - d12 * self.e1) / det
        size = max(np.abs(self.c).max(initial=0.0), 1e-300)
        turned = np.where(
            np.abs(self.n).argmax(axis=0) == 0,
            self.n[0],
            np.where(np.abs(self.n).argmax(axis=0) == 1, self.n[1], self.n[2]),
        )
        sign = np.where(turned < 0.0, -1.0, 1.0)
        key = np.vstack((sign * self.n, sign * self.c / size)).round(9) + 0.0
        self.plane = np.unique(key, axis=1, return_inverse=True)[1].ravel() if key.size else np.empty(0, int)

    @cached_property
    def reach(self):
        """Sum of the coordinates' sizes that enter each primitive's plane or sphere in metres, (P,)."""
        found = np.empty(self.size)
        found[self.flat] = sum(np.abs(v).sum(axis=0) for v in (self.corner, self.e1, self.e2))
        found[self.sphere] = np.abs(self.center).sum(axis=0) + self.radius
        return found

    def planes_of(self, primitive):
        """A number for the plane of each primitive (N,), the same for coplanar faces; -1 for spheres and for
        primitive -1."""
        column = self.column.take(primitive)
        none = (primitive < 0) | self.is_sphere.take(primitive)
        return np.where(
            none, -1, self.plane.take(np.where(none, 0, column), mode="clip") if self.plane.size else -1
        )

    def normals(self, p, primitive):
        """Normals (3, N) of the primitives at points p (3, N)."""
        column = self.column.take(primitive)
        if not self.sphere.size:
            return self.n.take(column, axis=1)
        ball = self.is_sphere.take(primitive)
        n = np.empty_like(p)
        n[:, ~ball] = self.n.take(column[~ball], axis=1)
        k = column[ball]
        n[:, ball] = self.side[k] * normalize(p[:, ball] - self.center[:, k])
        return n

    def shading(self, p, primitive, ng, wo):
        """Shading normals (3, N): interpolated on meshes that have some, ng elsewhere and where they would
        turn the side that is seen."""
        n = ng.copy()
        for first, shape in self._shapes:
            if not isinstance(shape, Mesh) or shape.normals is None:
                continue
            lanes = np.flatnonzero((primitive >= first) & (primitive < first + shape.primitives))
            with np.errstate(invalid="ignore"):
                smooth = shape.shading_normals(p[:, lanes], primitive[lanes] - first)
                good = lanes[dot(smooth, wo[:, lanes]) * dot(ng[:, lanes], wo[:, lanes]) > 0.0]
            n[:, good] = smooth[:, np.isin(lanes, good)]
        return n

    def off_surface(self, p, primitive):
        """How far points p (3, N) are from their primitives, (N,) in metres: from plane or sphere, and beyond
        the edge."""
        column, ball = self.column.take(primitive), self.is_sphere.take(primitive)
        found = np.empty(primitive.shape)
        k = column[~ball]
        if k.size:
            x = p[:, ~ball] - self.corner[:, k]
            a, b = dot(self.g1[:, k], x), dot(self.g2[:, k], x)
            high_a = np.where(self.triangle[k], np.minimum(1.0, 1.0 - b), 1.0)
            high_b = np.where(self.triangle[k], np.minimum(1.0, 1.0 - a), 1.0)
            beyond_a = np.maximum(np.maximum(-a, a - high_a), 0.0) * np.sqrt(
                dot(self.e1[:, k], self.e1[:, k])
            )
            beyond_b = np.maximum(np.maximum(-b, b - high_b), 0.0) * np.sqrt(
                dot(self.e2[:, k], self.e2[:, k])
            )
            found[~ball] = np.abs(dot(self.n[:, k], x)) + beyond_a + beyond_b
        k = column[ball]
        if k.size:
            out = p[:, ball] - self.center[:, k]
            found[ball] = np.abs(np.sqrt(dot(out, out)) - self.radius[k])
        return found

    def nearest(self, o, d, source, slack):
        """(sure, may, which): distance (N,) to the nearest primitive that is surely met, inf for none, and
        that may be; and the one surely met, -1.

        o, d: (3, N), unit d; source: (N,) primitive the rays start on, -1 for none; slack: metres by which
        points may be off.
        """
        n = source.size
        sure, may, which = np.full(n, np.inf), np.full(n, np.inf), np.full(n, -1)
        plane = self.planes_of(source)
        for part in self._chunks(n):
            for number, t, certain, possible, room, _ in self._met(
                o[:, part], d[:, part], source[part], plane[part], slack
            ):
                at = np.where(certain, t, np.inf)
                best = at.argmin(axis=1)
                low = at[np.arange(best.size), best]
                nearer = low < sure[part]
                which[part] = np.where(nearer, number[best], which[part])
                sure[part] = np.minimum(sure[part], low)
                may[part] = np.minimum(may[part], np.where(possible, t - room, np.inf).min(axis=1))
        return sure, may, which

    def between(self, p, q, source, target, slack, front_only=False):
        """(blocked, may): whether something surely lies between points p and q (3, N), and whether it may.

        source, target: (N,) the primitives these lie on, -1 for none. Faces in the plane of one of them are
        never in the way. front_only: what is met from behind may let the ray pass.
        """
        gap = q - p
        distance = np.sqrt(dot(gap, gap))
        d = gap / distance
        blocked, maybe = np.zeros(source.shape, bool), np.zeros(source.shape, bool)
        plane, aim = self.planes_of(source), self.planes_of(target)
        for part in self._chunks(source.size):
            end = distance[part, None]
            for number, t, certain, possible, room, front in self._met(
                p[:, part], d[:, part], source[part], plane[part], slack
            ):
                if front_only:
                    certain = certain & front
                other = number[None, :] != target[part, None]
                if not self.is_sphere[number].any():
                    other &= self.plane[None, :] != aim[part, None]
                blocked[part] |= (certain & other & (t < end - room)).any(axis=1)
                maybe[part] |= (possible & other & (t < end + room)).any(axis=1)
        return blocked, maybe

    def _chunks(self, n):
        step = max(1, _PAIRS // max(self.size, 1))
        for begin in range(0, n, step):
            yield slice(begin, begin + step)

    def _met(self, o, d, source, plane, slack):
        """Yield (numbers (P,), t, certain, possible, room, front), each (N, P), of the flat faces and of the
        spheres; room: by how much t may be off; front: whether the side is met that the normal points to."""
        if self.flat.size:
            yield self._met_flat(o, d, plane, slack)
        if self.sphere.size:
            yield self._met_spheres(o, d, source, slack)

    def _met_flat(self, o, d, plane, slack):
        cos = d.T @ self.n
        height = self.c - o.T @ self.n
        steep = np.maximum(np.abs(cos), _GRAZING)
        t = height / np.copysign(steep, cos)
        room = slack / steep
        a = o.T @ self.g1 + t * (d.T @ self.g1) - dot(self.g1, self.corner)
        b = o.T @ self.g2 + t * (d.T @ self.g2) - dot(self.g2, self.corner)
        slide = room + slack
        loose_a = slide * np.sqrt(dot(self.g1, self.g1))
        loose_b = slide * np.sqrt(dot(self.g2, self.g2))
        edge = np.where(self.triangle, 1.0 - a - b, np.minimum(1.0 - a, 1.0 - b))
        loose = np.maximum(loose_a, loose_b) * np.where(self.triangle, 2.0, 1.0)
        other = self.plane[None, :] != plane[:, None]
        certain = other & (a > loose_a) & (b > loose_b) & (edge > loose) & (t > 2.0 * room)
        possible = other & (a > -loose_a) & (b > -loose_b) & (edge > -loose) & (t > -2.0 * room)
        return self.flat, t, certain, possible, room, cos < 0.0

    def _met_spheres(self, o, d, source, slack):
        out = o[:, :, None] - self.center[:, None, :]
        along = (out * d[:, :, None]).sum(axis=0)
        across = out - along * d[:, :, None]
        miss = np.sqrt((across * across).sum(axis=0))
        half = np.sqrt(np.maximum((self.radius - miss) * (self.radius + miss), 0.0))
        # h^2 = r^2 - miss^2: what slack is in miss it is in h times miss / h, and no more than its root.
        room = slack + np.minimum(slack * miss / np.maximum(half, 1e-300), np.sqrt(2.0 * slack * self.radius))
        near, far = -along - half, -along + half
        own = self.sphere[None, :] == source[:, None]
        # From a point on the sphere itself the chord is twice the height that the ray loses.
        t = np.where(own, -2.0 * along, np.where(near <= -2.0 * room, far, near))
        room = np.where(own, 2.0 * slack, room)
        # A start within rounding of another sphere may be inside or outside of it.
        certain = (miss < self.radius - slack) & (t > 4.0 * room) & (np.abs(near) > 2.0 * room)
        certain = np.where(own, t > 4.0 * room, certain)
        possible = np.where(own, t > -room, (miss < self.radius + slack) & (t > -2.0 * room))
        return self.sphere, t, certain, possible, room, self.side[None, :] * (along + t) < 0.0
