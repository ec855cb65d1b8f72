"""Vectors as three rows of lanes: products, lengths, local frames.

Everything here is element-wise, so a lane's numbers never depend on which other lanes it travels with:
matrix products and einsum are not used because their rounding does depend on that.
"""

from typing import NamedTuple

import numpy as np

from tracer.lanes import gather, signed


def dot(a, b):
    """a . b of two (3, N) arrays, as (N,)."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    """a x b of two (3, N) arrays, as (3, N)."""
    return np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def length(a):
    """|a| of a (3, N) array, as (N,)."""
    return np.sqrt(dot(a, a))


def normalize(a):
    """a / |a| of a (3, N) array; a zero vector gives NaN."""
    return a / length(a)


def cos_theta(w):
    """Cosine between a local direction and the normal, which is the local z axis."""
    return w[2]


def same_side(a, b):
    """Whether two local directions lie on the same side of the surface; grazing ones on neither."""
    return a[2] * b[2] > 0.0


class Frame(NamedTuple):
    """Right-handed orthonormal frame (s, t, n), each (3, N); n is the local z axis."""

    s: np.ndarray
    t: np.ndarray
    n: np.ndarray

    @classmethod
    def around(cls, n):
        """The frame around a unit normal that has no singular direction (Duff et al. 2017)."""
        sign = signed(np.ones_like(n[2]), n[2])
        a = -1.0 / (sign + n[2])
        b = n[0] * n[1] * a
        s = np.stack((1.0 + sign * (n[0] * n[0]) * a, sign * b, -sign * n[0]))
        t = np.stack((b, sign + n[1] * n[1] * a, -n[1]))
        return cls(s, t, n)

    @classmethod
    def along(cls, n, tangent):
        """The frame around a unit normal with s as near to a unit tangent (3, N) as it can be; where that is
        0, or within half a degree of the normal, the frame of `around`."""
        s = tangent - n * dot(n, tangent)
        size = length(s)
        lost = ~(size > 0.01)
        s = s / np.where(lost, 1.0, size).astype(size.dtype)
        followed = cls(s, cross(n, s), n)
        return followed.with_lanes(np.flatnonzero(lost), cls.around) if lost.any() else followed

    def with_lanes(self, lanes, make):
        """These frames, but with make(n) for the normals of some lanes."""
        s, t = self.s.copy(), self.t.copy()
        s[:, lanes], t[:, lanes], _ = make(gather(self.n, lanes))
        return Frame(s, t, self.n)

    def take(self, lanes):
        """The frames of some lanes."""
        return Frame(*(gather(axis, lanes) for axis in self))

    def to_local(self, w):
        """World direction (3, N) in this frame."""
        return np.stack((dot(self.s, w), dot(self.t, w), dot(self.n, w)))

    def to_world(self, w):
        """Local direction (3, N) in world space."""
        return self.s * w[0] + self.t * w[1] + self.n * w[2]
