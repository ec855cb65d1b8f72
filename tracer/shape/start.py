"""Starts that rounding leaves on the wrong side of a neighbouring face.

A ray that starts on face A, so near the plane of face B that rounding decides on which side of it, is taken
to be on the side on which A lies: A's corners know. If they all lie behind B (a convex edge between them),
the start is behind; if any lies in front (a concave edge, or B stands on A), the start is in front; if they
lie in the plane of B, the ray has left that plane with A's. Without this, a ray from the floor's last ulp
starts behind the wall and leaves the room.
"""

import numpy as np

from tracer.frame import dot

_MARGIN = 32.0  # machine epsilons: twice the bound by which a ray leaves its own face (see error_bound)


def margin(n, c, p):
    """How near a point (3, N) must be to the plane n . x = c for rounding to decide on its side, (N,)."""
    eps = _MARGIN * np.finfo(p.dtype).eps
    return eps * (np.abs(n[0] * p[0]) + np.abs(n[1] * p[1]) + np.abs(n[2] * p[2]) + np.abs(c))


def side(n, c, corners):
    """+1, -1 or 0 (N,): whether faces with corners (3, 4, N) reach in front of planes n . x = c, lie behind
    them, or in them."""
    heights = [dot(n, corners[:, k]) - c for k in range(4)]
    margins = [margin(n, c, corners[:, k]) for k in range(4)]
    ahead = np.any([h > m for h, m in zip(heights, margins, strict=True)], axis=0)
    behind = np.any([h < -m for h, m in zip(heights, margins, strict=True)], axis=0)
    return np.where(ahead, 1, np.where(behind, -1, 0))


def distance(o, d, n, c, source, corners):
    """Distance (N,) along rays to planes n . x = c, inf where the plane lies behind them.

    source: (N,) primitive each ray starts on, -1 for none; corners: (3, 4, P) of every primitive, or None.
    """
    height, cos = dot(n, o) - c, dot(n, d)
    t = -height / cos
    hit = t > 0.0
    if corners is not None:
        lanes = np.flatnonzero((np.abs(height) <= margin(n, c, o)) & (source >= 0))
        if lanes.size:
            n, c = _some(n, lanes), c[lanes] if np.ndim(c) else c
            towards = side(n, c, corners[:, :, source[lanes]]) * cos[lanes] < 0.0
            hit[lanes] = towards
            t[lanes] = np.maximum(t[lanes], 0.0)
    return np.where(hit, t, np.inf)


def _some(n, lanes):
    return n if n.shape[1] == 1 else n.take(lanes, axis=1)
