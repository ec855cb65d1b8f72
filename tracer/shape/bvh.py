"""A tree of boxes over triangles, so that a ray meets few of them (Kay and Kajiya 1986).

Every box is halved at the median of the axis along which its triangles spread most, all boxes of a level in
one NumPy call, until few triangles are left: a complete tree, which needs no pointers. It is kept with eight
children to a node (Wald, Benthin and Boulos 2008), so that a ray goes down in few steps; only the root has
two, four or eight. Child k of node i is node W i + k of the next step, for nodes of W children.

All rays go down together, step by step, as pairs of a ray and a node: the number of NumPy calls depends on
the depth of the tree and on what fits into the cache, not on the number of nodes. A first way down, to the
nearest child only, finds most rays a hit and so a limit; the second leaves out what lies beyond.
"""

from typing import NamedTuple

import numpy as np

from tracer.lanes import gather

LEAF = 4  # triangles in a leaf
ALONE = 32  # triangles that a tree would not make faster: they are one leaf
_HALVINGS = 3  # in one step: 8 children to a node
_PAIRS = 1 << 12  # of a ray and a node in flight: few enough for their boxes to stay in the cache
GROUP = 1 << 13  # rays that go down together: few enough for all their pairs to stay in the cache


class Tree(NamedTuple):
    """Boxes and triangles."""

    low: np.ndarray  # (3,) corners of the box around everything
    high: np.ndarray  # (3,)
    steps: tuple  # of the way down: (nodes, 6 W), low x, y, z and high x, y, z of each node's W children
    leaves: np.ndarray  # (L, K) numbers of triangles, -1 where a leaf has fewer


def build(low, high):
    """The Tree over the boxes low, high (F, 3) of F triangles."""
    count = len(low)
    levels = 0 if count <= ALONE else int(np.ceil(np.log2(count / LEAF)))
    size = -(-count // (1 << levels))
    # The leaves are filled up with triangles that are in the row already; their second places stay empty.
    numbers = _halved(np.arange(size << levels), 0.5 * (low.astype(np.float64) + high), levels)
    numbers = numbers.reshape(-1, size)
    own = numbers % count
    boxes = np.stack((low[own].min(axis=1), high[own].max(axis=1)), axis=1)  # (L, 2, 3)
    steps = []
    while len(boxes) > 1:
        width = 1 << (levels - _HALVINGS * len(steps) if len(boxes) < 1 << _HALVINGS else _HALVINGS)
        group = boxes.reshape(-1, width, 6)
        steps.append(np.ascontiguousarray(group.transpose(0, 2, 1)).reshape(-1, 6 * width))
        boxes = np.stack((group[:, :, :3].min(axis=1), group[:, :, 3:].max(axis=1)), axis=1)
    return Tree(*boxes[0], tuple(steps[::-1]), np.where(numbers < count, numbers, -1).astype(np.int32))


def _halved(numbers, centre, levels):
    """`numbers` (M,) in the order of the leaves of a tree of so many levels; number k stands for the triangle
    with centre k modulo F of (F, 3)."""
    place = gather(centre.T, numbers % len(centre))
    for level in range(levels):
        rows = place.reshape(3, 1 << level, -1)
        node, size = np.arange(1 << level), rows.shape[2]
        along = rows[np.ptp(rows, axis=2).argmax(axis=0), node]
        order = np.argpartition(along, size // 2 - 1, axis=1) + size * node[:, None]
        numbers, place = gather(numbers, order.ravel()), gather(place, order.ravel())
    return numbers


def inverse(d):
    """1/d (3, N) for boxes.

    A component of 0 would make 0 times infinity where a ray lies in a face of a box; a tiny one gives the
    same answer without NaN.
    """
    tiny = d.dtype.type(np.finfo(d.dtype).tiny ** 0.5)
    return 1.0 / np.where(np.abs(d) < tiny, np.copysign(tiny, d), d)


def enter(tree, o, over_d, within):
    """The lanes (L,) of rays o + t d, with over_d = inverse(d), that pass the box around everything before
    `within` (N,), and which of them start in it, (L,)."""
    box = np.stack((tree.low, tree.high))[:, :, None, None]
    met, near = _enters(box, o, over_d, within)
    lanes = np.flatnonzero(met[0])
    return lanes, gather(near[0], lanes) <= 0.0


def first_leaves(tree, o, over_d, within):
    """Leaves (L,) that rays come to who always go on to the child whose box they enter first, and their lanes
    (L,)."""
    leaves, lanes = [], []
    for begin in range(0, o.shape[1], _PAIRS):
        lane = np.arange(begin, min(begin + _PAIRS, o.shape[1]))
        node = np.zeros(lane.size, np.intp)
        for step in tree.steps:
            met, near = _children(step, node, lane, o, over_d, within)
            near[~met] = np.inf
            best, child = near[0], np.zeros(lane.size, np.intp)
            for k in range(1, len(near)):
                np.copyto(child, k, where=near[k] < best)
                best = np.minimum(best, near[k])
            going = np.flatnonzero(best < np.inf)
            node, lane = gather((node * len(near) + child), going), gather(lane, going)
        leaves.append(node)
        lanes.append(lane)
    return np.concatenate(leaves), np.concatenate(lanes)


def all_leaves(tree, o, over_d, within, starting):
    """Leaves (L,) whose boxes rays pass before `within` (N,), their lanes (L,), and which start there, (L,).

    starting: (N,) which of the rays start in the box around everything.
    """
    lane = np.arange(o.shape[1])
    node = np.zeros(lane.size, np.intp)
    for step in tree.steps:
        if not lane.size:
            return node, lane, starting[:0]
        last = step is tree.steps[-1]
        nodes, lanes, inside = [], [], []
        for begin in range(0, lane.size, _PAIRS):
            some, parent = lane[begin : begin + _PAIRS], node[begin : begin + _PAIRS]
            met, near = _children(step, parent, some, o, over_d, within)
            place = np.flatnonzero(met)
            child, pair = np.divmod(place, some.size)
            nodes.append(gather(parent, pair) * len(met) + child)
            lanes.append(gather(some, pair))
            if last:
                inside.append(gather(near.ravel(), place) <= 0.0)
        node, lane = np.concatenate(nodes), np.concatenate(lanes)
        if last:
            starting = np.concatenate(inside)
    return node, lane, starting


def _children(step, node, lane, o, over_d, within):
    """_enters for the W children of nodes (P,) and the rays of lanes (P,)."""
    boxes = columns(step, node).reshape(2, 3, step.shape[1] // 6, -1)
    return _enters(boxes, gather(o, lane), gather(over_d, lane), gather(within, lane))


def columns(table, row):
    """Rows (P,) of a table (R, C) as columns (C, P), or (C, 1) where it has but one row."""
    return table.T if len(table) == 1 else np.ascontiguousarray(table.take(row, axis=0).T)


def _enters(boxes, o, inverse, within):
    """Whether rays, (3, P) and (P,), pass boxes (2, 3, W, P) before `within`, or miss them by less than
    rounding (Ize 2013), (W, P), and the distance at which they enter, not above 0 where they start inside."""
    slack = 8.0 * np.finfo(o.dtype).eps
    near, far = None, within
    for k in range(3):
        one, other = (boxes[0, k] - o[k]) * inverse[k], (boxes[1, k] - o[k]) * inverse[k]
        enter, leave = np.minimum(one, other), np.maximum(one, other)
        near = enter if near is None else np.maximum(near, enter)
        far = np.minimum(far, leave)
    far = far + slack * np.abs(far)
    return (near - slack * np.abs(near) <= far) & (far >= 0.0), near
