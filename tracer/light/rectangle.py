"""A rectangle sampled uniformly over the solid angle it covers (Urena et al. 2013).

In the rectangle's own axes, seen from the receiver, its points are (x0..x1, y0..y1, z). The strip of it
beyond x covers, together with what would follow up to infinity, the solid angle

    gamma(x) = 2 atan( z (y1 - y0) / (|a||b| + a.b + x (|a| + |b|)) ),  a = (x, y0, z), b = (x, y1, z),

the limit of Van Oosterom and Strackee 1983 for a corner at infinity. Its inverse has a closed form too, with
sin a_i = y_i / sqrt(y_i^2 + z^2):

    x = z sin(D - gamma) / sqrt(4 sin(D - gamma/2) sin(gamma/2) cos(a1 - gamma/2) cos(a0 + gamma/2)),

D = a1 - a0. Measured from the end of the rectangle that is nearer to the horizon, gamma keeps its digits
where the sum of angles of the original, 2 pi too large, loses them: there machine epsilon over the solid
angle is lost, here epsilon over its root, as in the coordinates themselves.
"""

from typing import NamedTuple

import numpy as np

from tracer.frame import dot
from tracer.lanes import choose

# Below these solid angles points of a rectangle look alike from the receiver: sampling by area is as good,
# and the map above has lost more than a ten-thousandth of the rectangle's side.
LEAST = {np.dtype(np.float32): 1e-6, np.dtype(np.float64): 1e-14}


# Square of the length below which the sums of Van Oosterom and Strackee are computed otherwise.
_OPPOSITE = 0.1


class Seen(NamedTuple):
    """Rectangles in their own axes, from receivers; lengths in metres."""

    x0: np.ndarray  # (N,) of the corner along the first side
    x1: np.ndarray
    y0: np.ndarray  # (N,) ... along the second
    y1: np.ndarray
    z: np.ndarray  # (N,) height of the receiver over the rectangle's plane; positive on the side that shines
    width: np.ndarray  # (N,) or (1,) x1 - x0
    height: np.ndarray  # (N,) or (1,) y1 - y0


def seen_from(p, corner, x, y, n, width, height):
    """Rectangles as receivers p (3, N) see them; x, y: unit sides (3, N or 1); n: the normal that shines."""
    to_corner = corner - p
    x0, y0 = dot(x, to_corner), dot(y, to_corner)
    return Seen(x0, x0 + width, y0, y0 + height, -dot(n, to_corner), width, height)


def solid_angle(r):
    """Solid angle (N,) in sr, as that of two triangles (Van Oosterom and Strackee 1983); 0 from behind."""
    xx, yy, zz = r.x0 * r.x1, r.y0 * r.y1, r.z * r.z
    low, high = r.x0 * r.x0, r.x1 * r.x1
    near, far = r.y0 * r.y0 + zz, r.y1 * r.y1 + zz
    r00, r10, r01, r11 = np.sqrt(low + near), np.sqrt(high + near), np.sqrt(low + far), np.sqrt(high + far)
    diagonal = r00 * r11
    volume = r.z * r.width * r.height / diagonal
    both = 1.0 + (xx + yy + zz) / diagonal
    sine_a, cosine_a = volume / r10, both + (xx + near) / (r00 * r10) + (high + yy + zz) / (r10 * r11)
    sine_b, cosine_b = volume / r01, both + (low + yy + zz) / (r00 * r01) + (xx + far) / (r01 * r11)
    omega = 2.0 * np.arctan2(sine_a * cosine_b + sine_b * cosine_a, cosine_a * cosine_b - sine_a * sine_b)
    # Corners that lie nearly opposite to one another, as seen from close by, cost these sums their digits.
    left = np.minimum(sine_a * sine_a + cosine_a * cosine_a, sine_b * sine_b + cosine_b * cosine_b)
    lanes = np.flatnonzero(left < _OPPOSITE)
    if lanes.size:
        omega[lanes] = _from_close(Seen(*(np.broadcast_to(v, omega.shape)[lanes] for v in r)))
    return omega * (r.z > 0.0)


def _from_close(r):
    """Solid angle where the receiver's foot lies between two opposite sides, from those two sides' shares.

    Each is the angle atan2(x1 y, z r1) - atan2(x0 y, z r0) in one, (Urena et al. 2013) with its
    differences taken out; they have opposite signs, so that nothing cancels.
    """
    swap = ~((r.y0 < 0.0) & (r.y1 > 0.0))
    x0, x1, y0, y1 = (np.where(swap, b, a) for a, b in zip(r[:4], (r.y0, r.y1, r.x0, r.x1), strict=True))
    width, zz = np.where(swap, r.height, r.width), r.z * r.z

    def share(y):
        rest = y * y + zz
        r0, r1 = np.sqrt(x0 * x0 + rest), np.sqrt(x1 * x1 + rest)
        one, other = x1 * r0, x0 * r1
        apart = np.where(x0 * x1 > 0.0, rest * width * (x0 + x1) / (one + other), one - other)
        return np.arctan2(y * r.z * apart, zz * r0 * r1 + x0 * x1 * y * y)

    return share(y1) - share(y0)


def uniform(r, omega, u, v):
    """Where on the rectangle, (s, t) each (N,) from 0 to 1, so that directions are uniform over its solid
    angle omega (N,); u, v: (N,) from 0 to 1."""
    x = np.fmin(np.fmax(_across(r, omega, u), r.x0), r.x1)
    d = x * x + r.z * r.z
    h0, h1 = r.y0 / np.sqrt(d + r.y0 * r.y0), r.y1 / np.sqrt(d + r.y1 * r.y1)
    h = h0 + v * (h1 - h0)
    y = h * np.sqrt(d / ((1.0 - h) * (1.0 + h)))
    s, t = (x - r.x0) / r.width, (y - r.y0) / r.height
    return np.fmin(s, 1.0), np.fmin(np.fmax(t, 0.0), 1.0)


def _across(r, omega, u):
    """x (N,) with the share u of the solid angle between x0 and x."""
    strip = _Strip(r)
    right = strip.beyond(r.x1) + (1.0 - u) * omega
    positive = right <= strip.whole
    gamma = choose(positive, right, strip.beyond(-r.x0) + u * omega)
    sin, cos = np.sin(0.5 * gamma), np.cos(0.5 * gamma)
    # All sines and cosines of D, a0 and a1 are multiplied by |a||b|, which cancels.
    side, level = strip.side, strip.level
    first = side * (1.0 - 2.0 * sin * sin) - level * (2.0 * sin * cos)
    second = (side * cos - level * sin) * sin
    third = (r.z * cos + r.y1 * sin) * (r.z * cos - r.y0 * sin)
    x = 0.5 * r.z * first / np.sqrt(second * third)
    return choose(positive, x, -x)


class _Strip:
    """What the whole strip, infinite both ways, has of the rectangle: all but x."""

    def __init__(self, r):
        self.zz = r.z * r.z
        self.near, self.far = r.y0 * r.y0 + self.zz, r.y1 * r.y1 + self.zz
        self.side, self.level = r.z * r.height, r.y0 * r.y1 + self.zz
        self.square_height = r.height * r.height
        self.whole = np.arctan2(self.side, self.level)  # D: half of its solid angle

    def beyond(self, x):
        """gamma(x), (N,); of no use far to the left of 0, where it loses its digits."""
        square = x * x
        a, b = np.sqrt(square + self.near), np.sqrt(square + self.far)
        product, inner = a * b, square + self.level
        # |a||b| + a.b: where the two are opposite, |a x b|^2 / (|a||b| - a.b) has the digits.
        cross = self.square_height * (square + self.zz) / (product + np.abs(inner))
        return 2.0 * np.arctan2(self.side, choose(inner < 0.0, cross, product + inner) + x * (a + b))
