"""Which routine answers for which shapes, decided once per scene: what cannot matter is not asked.

For the nearest hit, walls of one box are asked together (see room), and meshes of few triangles plane by
plane (see few). For shadows three sorts of shape are not asked at all: walls, where the box holds receiver
and lamp; a rectangle with everything in front of it, which no segment between two surfaces crosses; and the
only face that shines, which every shadow ray ends on. The others are asked where their shadow may fall (see
cull).
"""

from functools import partial
from typing import NamedTuple

import numpy as np

from tracer.shape import embree_kernel, few, room
from tracer.shape.cull import Shadow
from tracer.shape.rays import linear
from tracer.shape.rectangle import Rectangle
from tracer.shape.sphere import Sphere

_SLACK = 1e-9  # relative: what lies behind a plane by less lies in it
_HAIR = (
    32.0  # machine epsilons of the largest coordinates: more than rounding makes of the distance to a plane
)


class Arrangement(NamedTuple):
    """The routines of a scene, in the order in which they are asked."""

    closest: list  # for the nearest hit
    blocking: list  # for shadows: blocks(rays, distance) -> (N,) bool
    walls: tuple  # numbers of the shapes that are walls of one box
    walls_never_block: bool  # what lies in it
    harmless: tuple  # numbers of the other shapes that never block
    shading: tuple  # numbers of the shapes that block light only from part of the scene
    few: tuple  # numbers of the meshes that are met plane by plane


def arrange(shapes, first, sealed, shining, elsewhere, extent, others, dtype, accel):
    """The Arrangement of a scene.

    first: number of each shape's first primitive; sealed: (S,) whether nothing goes on behind its front;
    shining: (S,) whether it shines; elsewhere: whether there are lights that are no shapes; others: the
    Faces of all primitives; accel: who looks for triangles, as in Settings.
    """
    kernels = [shape.kernel(int(k), extent, dtype, others) for shape, k in zip(shapes, first, strict=True)]
    if accel == "embree":
        kernels = [embree_kernel.through_embree(kernel) for kernel in kernels]
    corners = np.hstack([_corners(shape) for shape in shapes])
    kernels = [
        few.by_planes(kernel, shape, extent, dtype, others)
        for kernel, shape in zip(kernels, shapes, strict=True)
    ]
    # Lamps first: of surfaces at exactly the same distance the first is met.
    order = sorted(range(len(shapes)), key=lambda k: not shining[k])
    sides = room.find(shapes, sealed)
    walls = () if sides is None else tuple(k for k in sides if k >= 0)
    order = [k for k in order if k not in walls]
    closest = [
        _ahead_of_walls(kernels[k], shapes, k, extent, dtype) if shining[k] else kernels[k] for k in order
    ]
    harmless = () if elsewhere else tuple(_harmless(shapes, shining, walls))
    lamps = None
    if any(shining) and not elsewhere:
        lamps = np.hstack([_corners(shape) for shape, lit in zip(shapes, shining, strict=True) if lit])
    blockers = [k for k in order if k not in harmless]
    blocking = [_blocker(kernels[k], shapes[k], shining[k], lamps, corners, dtype, others) for k in blockers]
    never = False
    if walls:
        box = room.RoomKernel(sides, shapes, kernels, dtype)
        box.never_blocks = never = not elsewhere and (lamps is None or box.holds(lamps))
        closest.insert(sum(bool(shining[k]) for k in order), box)
        blocking.append(box.blocks)
    shading = tuple(k for k, blocks in zip(blockers, blocking, strict=False) if isinstance(blocks, Shadow))
    by_planes = tuple(k for k, kernel in enumerate(kernels) if isinstance(kernel, few.FewKernel))
    return Arrangement(closest, blocking, walls, never, harmless, shading, by_planes)


class InAWall:
    """A flat lamp in the plane of another face: from its front it is met a hair before that face.

    The hair is what rounding may make of the distance between the two, so that neither rounding nor the order
    of the shapes decides which is seen.
    """

    def __init__(self, kernel, n, hair):
        self.kernel, self.n, self.hair = kernel, n, hair

    def closest(self, rays, within=np.inf):
        """Distance along each ray, inf or NaN for a miss, and the primitive."""
        t, primitive = self.kernel.closest(rays, within)
        return np.maximum(t + self.hair / linear(self.n, rays.d), 0.0), primitive


def _ahead_of_walls(kernel, shapes, lamp, extent, dtype):
    """The kernel of shape number `lamp`, as InAWall if it is a rectangle in the plane of another face."""
    if not isinstance(shapes[lamp], Rectangle):
        return kernel
    (n,), (c,) = (np.moveaxis(a, -1, 0) for a in shapes[lamp].planes())
    hair = dtype(_HAIR * np.finfo(dtype).eps * (np.abs(n).sum() * extent + abs(c)))
    corners = _corners(shapes[lamp])
    for k, shape in enumerate(shapes):
        if k != lamp and not isinstance(shape, Sphere):
            n_wall, c_wall = shape.planes()
            if (np.abs(n_wall.T @ corners - c_wall[:, None]) <= hair).all(axis=1).any():
                return InAWall(kernel, tuple(dtype(v) for v in n), hair)
    return kernel


def _blocker(kernel, shape, shines, lamps, corners, dtype, others):
    """What tells whether a shape blocks shadow rays; lamps, corners: points (3, K) whose convex hulls
    hold all lights and the scene; lamps is None where there are others."""
    if lamps is not None:
        bounds = corners.min(axis=1), corners.max(axis=1)
        shadow = Shadow(kernel, shape, _corners(shape), shines, lamps, bounds, dtype, others)
        if shadow.tells:
            return shadow
    return partial(_blocks, kernel)


def _blocks(kernel, rays, distance):
    return kernel.closest(rays, distance)[0] < distance


def _harmless(shapes, shining, walls):
    """Shapes that never lie between a surface and a point on a shape that shines."""
    lit = [k for k in range(len(shapes)) if shining[k]]
    for k, shape in enumerate(shapes):
        if k in walls or shape.primitives > 1:
            continue
        n, c = shape.planes()
        alone = lit == [k]
        if alone or (
            isinstance(shape, Rectangle) and all(_in_front(other, n[:, 0], c[0]) for other in shapes)
        ):
            yield k


def _in_front(shape, n, c):
    """Whether no part of a shape lies behind the plane n . x = c, but for rounding."""
    heights = n @ _corners(shape) - c
    return heights.min() >= -_SLACK * max(abs(c), np.abs(heights).max())


def _corners(shape):
    """Points (3, K) whose convex hull holds the shape."""
    if isinstance(shape, Sphere):
        sides = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        return (shape.center + shape.radius * sides).T
    return shape.triangles()[0].T
