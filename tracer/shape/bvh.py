"""A tree of boxes over triangles, so that a ray meets few of them (Kay and Kajiya 1986).

Built by splitting at the median centroid; walked by a whole wave at once: each node is visited with the
rays that meet its box, the nearer child first.
"""

from typing import NamedTuple

import numpy as np

LEAF = 16  # triangles in a leaf: a block the triangle test takes in one go


class Node(NamedTuple):
    """One box. A leaf holds triangles; another node two children and the axis they were split on."""

    low: np.ndarray  # (3,)
    high: np.ndarray  # (3,)
    triangles: np.ndarray | None  # numbers, ascending
    axis: int
    children: tuple


def build(low, high):
    """The root over the boxes low, high (F, 3) of F triangles."""
    return _build(np.arange(len(low)), low, high, 0.5 * (low.astype(np.float64) + high))


def _build(triangles, low, high, centre):
    bottom, top = low[triangles].min(axis=0), high[triangles].max(axis=0)
    if triangles.size <= LEAF:
        return Node(bottom, top, np.sort(triangles), 0, ())
    spread = centre[triangles]
    axis = int(np.argmax(np.ptp(spread, axis=0)))
    half = triangles.size // 2
    order = np.argpartition(spread[:, axis], half)
    children = tuple(_build(triangles[part], low, high, centre) for part in (order[:half], order[half:]))
    return Node(bottom, top, None, axis, children)


def walk(root, o, over_d, within, visit):
    """Visit every leaf that rays o + t d may meet before `within` (N,); o, over_d = inverse(d): (3, N).

    visit(triangles, lanes, starting) tests a leaf and may lower within[lanes]; starting (N,) bool: which of
    the lanes start in its box.
    """
    ahead = np.count_nonzero(over_d > 0.0, axis=1) >= 0.5 * over_d.shape[1]
    waiting = [(root, np.arange(o.shape[1]))]
    while waiting:
        node, lanes = waiting.pop()
        met, near = _enters(node, o.take(lanes, axis=1), over_d.take(lanes, axis=1), within[lanes])
        lanes = lanes[met]
        if not lanes.size:
            continue
        if node.triangles is not None:
            visit(node.triangles, lanes, near[met] <= 0.0)
            continue
        first, second = node.children if ahead[node.axis] else node.children[::-1]
        waiting.append((second, lanes))
        waiting.append((first, lanes))


def inverse(d):
    """1/d (3, N) for `meets`.

    A component of 0 would make 0 times infinity where a ray lies in a face of a box; a tiny one gives the
    same answer without NaN.
    """
    tiny = d.dtype.type(np.finfo(d.dtype).tiny ** 0.5)
    return 1.0 / np.where(np.abs(d) < tiny, np.copysign(tiny, d), d)


def meets(node, o, inverse, within):
    """Whether rays o + t d, with inverse = 1/d, pass a node's box before `within`, or miss it by less than
    rounding (Ize 2013), (N,)."""
    return _enters(node, o, inverse, within)[0]


def _enters(node, o, inverse, within):
    """`meets`, and the distance at which rays enter the box, not above 0 where they start in it."""
    slack = 8.0 * np.finfo(o.dtype).eps
    near, far = None, within
    for k in range(3):
        one, other = (node.low[k] - o[k]) * inverse[k], (node.high[k] - o[k]) * inverse[k]
        enter, leave = np.minimum(one, other), np.maximum(one, other)
        near = enter if near is None else np.maximum(near, enter)
        far = np.minimum(far, leave)
    far = far + slack * np.abs(far)
    return (near - slack * np.abs(near) <= far) & (far >= 0.0), near
