"""Triangle meshes by Embree, where it is asked for: it finds the nearest triangle of a large mesh sooner.

Embree only proposes. What it finds is tested as the tree's leaves are (see mesh_kernel), together with its
neighbours in the leaf: distance, order and side are castray's own. The tree itself is asked where
- the test does not confirm a proposal, or it is the triangle a ray starts on or is aimed at;
- a ray may meet a face that it starts within rounding of (see start): which these are, the tree says as well.

What is taken on trust is that there is nothing where Embree, in float32, finds nothing, and nothing nearer
than what it finds. So a ray at an edge may meet another of the triangles that share it than by the tree
alone, and how many rays escape from closed meshes is measured apart (ACCURACY.md).
"""

from importlib.util import find_spec

import numpy as np

from tracer.lanes import gather
from tracer.settings import TracerError
from tracer.shape import bvh, start
from tracer.shape.mesh_kernel import MeshKernel, sheared_onto_axis

LEAST = 64  # triangles of a mesh from which it pays
_BEYOND = 8.0 * np.finfo(np.float32).eps  # relative: how far behind a limit Embree looks, for its rounding


def through_embree(kernel):
    """The kernel of a shape, as EmbreeKernel if that pays. TracerError unless embreex is installed."""
    if find_spec("embreex") is None:
        raise TracerError(
            "accel: embree needs the package embreex, which is not installed: "
            "pip install embreex, or choose accel bvh"
        )
    return EmbreeKernel(kernel) if isinstance(kernel, MeshKernel) and kernel.faces >= LEAST else kernel


class EmbreeKernel:
    """A MeshKernel `exact` in float32, asked through Embree."""

    def __init__(self, exact):
        self.exact, self.first = exact, exact.first
        leaves = exact.tree.leaves
        self.leaf_of = np.empty(exact.faces, np.intp)
        row, column = np.nonzero(leaves >= 0)
        self.leaf_of[leaves[row, column]] = row
        self._embree = None

    def __getstate__(self):
        return {**self.__dict__, "_embree": None}  # cannot be sent to another process, which makes its own

    def closest(self, rays, within=np.inf):
        """Distance to the nearest triangle before `within` (N,), inf where there is none, and which."""
        exact, n = self.exact, rays.source.size
        limit = np.full(n, within, rays.o.dtype)
        over_d = bvh.inverse(rays.d)
        lanes, starting = bvh.enter(exact.tree, rays.o, over_d, limit)
        t, face = np.full(n, np.inf, rays.o.dtype), np.full(n, -1, np.int32)
        proposed = self._propose(gather(rays.o, lanes), gather(rays.d, lanes), gather(limit, lanes))
        found = np.flatnonzero(proposed >= 0)
        self._confirm(t, face, rays, gather(lanes, found), gather(self.leaf_of, gather(proposed, found)))
        again = np.zeros(n, bool)
        again[lanes[found]] = np.isinf(t[lanes[found]])
        if rays.touched is not None:
            again[self._touching(rays, lanes[starting], over_d)] = True
        beyond = t > within
        t[beyond], face[beyond] = np.inf, -1
        again = np.flatnonzero(again)
        if again.size:
            t[again], number = exact.closest(rays.take(again), limit[again])
            face[again] = number - self.first
        return t, self.first + face

    def _propose(self, o, d, limit):
        """Numbers (L,) of triangles that rays (3, L) meet first, -1 for none."""
        if self._embree is None:
            self._embree = _embree(self.exact.corners)
        rows = (np.ascontiguousarray(v.T, np.float32) for v in (o, d))
        return self._embree[0].run(*rows, dists=limit * np.float32(1.0 + _BEYOND), output=True)["primID"]

    def _confirm(self, t, face, rays, lanes, leaves):
        """Write into t and face which triangles of leaves (L,) the rays `lanes` (L,) meet first, if any."""
        shear, axis = sheared_onto_axis(gather(rays.o, lanes), gather(rays.d, lanes))
        met, lane, sums = self.exact.through(rays, lanes, shear, axis, leaves, np.arange(lanes.size))
        if met.size:
            ray = gather(lanes, lane)
            self.exact.nearest(
                t, face, rays, met, ray, self.exact.heading(rays, ray, gather(axis, lane), sums)
            )

    def _touching(self, rays, lanes, over_d):
        """Report which of the rays `lanes`, which start in the box around the mesh, may touch which
        triangles. Returns the lanes of those that may meet one that they touch."""
        exact, before, nowhere = self.exact, len(rays.touched), np.zeros(lanes.size, rays.o.dtype)
        o, over_d = gather(rays.o, lanes), gather(over_d, lanes)
        leaf, lane, _ = bvh.all_leaves(exact.tree, o, over_d, nowhere, nowhere == 0.0)
        exact.touching(exact.tree.leaves[leaf], rays, lanes[lane])
        if len(rays.touched) == before:
            return np.empty(0, np.intp)
        lanes, other = rays.touched[-1]
        own, x = rays.source[lanes], gather(rays.o, lanes).astype(np.float64)
        near = np.flatnonzero(exact.others.close(own, other, x))
        side, _ = start.relation(exact.others, own[near], other[near], x[:, near])
        return lanes[near[side != 0]]


def _embree(corners):
    """Embree's scene of triangles with corners (3 corners, 3, F), ready to be asked."""
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene

    scene = EmbreeScene(robust=True)
    mesh = TriangleMesh(scene, np.ascontiguousarray(corners.transpose(2, 0, 1), np.float32))
    scene.run(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))  # which makes it ready
    return scene, mesh
