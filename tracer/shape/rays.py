"""Rays on their way through the shapes, and the bound on where they may start."""

from typing import NamedTuple

import numpy as np

from tracer.frame import dot
from tracer.lanes import gather, signed


class Rays(NamedTuple):
    """A wave of rays."""

    o: np.ndarray  # (3, N) origin
    d: np.ndarray  # (3, N) unit direction
    inv_d: np.ndarray  # (3, N) 1/d, +infinite where a component is zero
    source: np.ndarray  # (N,) number of the primitive the ray starts on, -1 for none
    target: np.ndarray | None = None  # (N,) number of the primitive it is aimed at
    touched: list | None = None  # kernels put here (lanes, primitives) that starts may touch; see start

    @classmethod
    def towards(cls, o, d, source, target=None, touched=None):
        """Rays from o along d."""
        return cls(o, d, 1.0 / (d + 0.0), source, target, touched)  # -0 + 0 is +0

    def take(self, lanes, touched=None):
        """The rays of some lanes, which start afresh on what they touch."""
        target = None if self.target is None else self.target[lanes]
        return Rays(
            gather(self.o, lanes),
            gather(self.d, lanes),
            gather(self.inv_d, lanes),
            self.source[lanes],
            target,
            touched,
        )


def linear(row, v):
    """row . v for (3, N) v and three plain numbers, without the zero ones: walls are mostly axis-aligned."""
    total = None
    for axis in range(3):
        if row[axis] == 0.0:
            continue
        term = v[axis] if row[axis] == 1.0 else v[axis] * row[axis]
        total = term if total is None else total + term
    return np.zeros_like(v[0]) if total is None else total


def hits_only(t, hit):
    """t where `hit`, infinity elsewhere.

    Division by the mask (t/1 or t/0) costs a third of np.where; t must be positive where it counts.
    """
    return np.abs(t) / hit


def box_side(y, z, upper):
    """The side (N,) of a box, 0 to 5 for -x, +x, -y, +y, -z and +z: across y or z where those (N,) are set,
    else across x, and the upper one where `upper`, three (N,), is set for that axis."""
    above = (upper[2] & z) | (upper[1] & y) | (upper[0] & ~(y | z))
    return above.view(np.int8) + (y.view(np.int8) + 2 * z.view(np.int8)) * np.int8(2)


def error_bound(p, n, reach):
    """How far, along n, a computed point on a surface may lie from that surface, (N,).

    p: (3, N) point; n: (3, N) unit normal; reach: (N,) magnitude that entered beside |n||p| (the plane's
    offset, or a sphere's centre and radius). With u the unit roundoff: projecting onto the plane leaves at
    most 6u of |n||p| + reach, the tables of n and c add 2u, moving the point 1u, the neighbouring coplanar
    face's own rounding 2u and the numerator of its distance 4u: 15u in all (Higham 2002, 3.1, for the sums),
    rounded up to 16u = 8 machine epsilons.
    """
    eps = np.finfo(p.dtype).eps
    return (8.0 * eps) * (np.abs(n[0] * p[0]) + np.abs(n[1] * p[1]) + np.abs(n[2] * p[2]) + reach)


def leave(p, n, bound, w):
    """The point p moved off its surface by its error bound, to the side that w points to, (3, N)."""
    return p + n * signed(bound, dot(n, w))
