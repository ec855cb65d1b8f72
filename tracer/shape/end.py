"""Points on lamps that lie within rounding of other shapes' faces: shadow rays end there.

The rule is that of `start`: such a point is on the side of the other face on which the lamp lies. So a lamp
that stands on a wall's outside does not shine into the room, and one that hangs on its inside is not hidden.
"""

from typing import NamedTuple

import numpy as np

from tracer.frame import dot
from tracer.lanes import gather, put
from tracer.shape.start import clear, sides

_PAIRS = 1 << 20  # of faces looked at together


class Beside(NamedTuple):
    """The faces of other shapes that touch each primitive that shines and reach in front of it."""

    first: np.ndarray  # (P + 1,) where each primitive's begin in `other`
    many: np.ndarray  # (P + 1,) how many it has; the last entry is for primitive -1
    other: np.ndarray  # (M,)


def beside(faces, shape_of, shining):
    """The Beside of a scene, None if no lamp touches anything. shape_of: (P,); shining: numbers of the shapes
    that shine. Of touching faces in one plane there is one."""
    slack = faces.margin(0, faces.c.size)
    low, high = faces.corners.min(axis=1) - slack, faces.corners.max(axis=1) + slack
    pairs = [np.empty((2, 0), np.intp)]
    for shape in shining:
        own = np.flatnonzero((shape_of == shape) & faces.flat)
        other = np.flatnonzero((shape_of != shape) & faces.flat)
        if own.size:
            near = low[:, other] <= high[:, own].max(axis=1, keepdims=True)
            near &= high[:, other] >= low[:, own].min(axis=1, keepdims=True)
            pairs += _touching(faces, low, high, slack, own, other[near.all(axis=0)])
    own, other = np.concatenate(pairs, axis=1)
    if not own.size:
        return None
    plane = np.vstack((own, faces.n[:, other], faces.c[other] / max(np.abs(faces.c).max(), 1e-300))).round(9)
    once = np.sort(np.unique(plane, axis=1, return_index=True)[1])
    own, other = own[once], other[once]
    order = np.argsort(own, kind="stable")
    count = np.bincount(own, minlength=faces.c.size + 1)
    return Beside(np.cumsum(count) - count, count, other[order])


def _touching(faces, low, high, slack, own, other):
    """Pairs (2, M) of faces, some at a time."""
    step = max(1, _PAIRS // max(other.size, 1))
    for begin in range(0, own.size, step):
        some = own[begin : begin + step]
        near = (low[:, some, None] <= high[:, None, other]) & (high[:, some, None] >= low[:, None, other])
        row, column = np.nonzero(near.all(axis=0))
        a, b = some[row], other[column]
        height = dot(faces.n[:, None, b], faces.corners[:, :, a]) - faces.c[b]
        meets = (height.min(axis=0) <= slack[b]) & (height.max(axis=0) >= -slack[b])
        yield np.stack((a, b))[:, meets & sides(faces, a, b)[0]]


def clear_ends(faces, beside, end, target):
    """Move points (3, N) on primitives `target` (N,) off the faces that touch these there."""
    count = gather(beside.many, target)
    lanes = np.repeat(np.arange(target.size), count)
    place = np.arange(lanes.size) - np.repeat(np.cumsum(count) - count, count)
    other = beside.other[gather(beside.first, target)[lanes] + place]
    near = np.flatnonzero(faces.close(target[lanes], other, gather(end, lanes)))
    lanes, cleared = clear(faces, end, target, lanes[near], other[near])
    put(end, lanes, cleared)
