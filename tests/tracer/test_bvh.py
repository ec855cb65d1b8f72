"""The tree of boxes finds what testing every triangle finds, bit for bit, and visits fewer."""

import numpy as np
import pytest
import trimesh
from suite import suite_seed

from tracer.shape import Mesh, bvh
from tracer.shape.rays import Rays

N = 2000


def kernels(dtype, monkeypatch):
    """The kernel of one sphere of triangles with its tree, and one whose tree is a single leaf."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    mesh = Mesh("ball", ball.vertices + [3.0, -2.0, 1.0], ball.faces)
    tree = mesh.kernel(0, 1.0, dtype)
    monkeypatch.setattr(bvh, "LEAF", len(mesh.faces))
    return mesh, tree, mesh.kernel(0, 1.0, dtype)


def aimed(mesh, rng, dtype):
    """Rays from all around at points on triangles, on edges, at vertices, along axes, and past the mesh."""
    corner = mesh.vertices[mesh.faces[rng.integers(len(mesh.faces), size=N)]]
    weight = rng.dirichlet([1, 1, 1], N)
    weight[: N // 4, 0] = 0.0  # on an edge
    weight[N // 4 : N // 2] = [1.0, 0.0, 0.0]  # at a vertex
    weight /= weight.sum(axis=1, keepdims=True)
    at = (corner * weight[:, :, None]).sum(axis=1)
    at[-N // 10 :] += rng.normal(size=(N // 10, 3))
    o = at + rng.normal(size=(N, 3)) * 4.0
    d = at - o
    d[: N // 10, rng.integers(3)] = 0.0
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return Rays.towards(o.T.astype(dtype), d.T.astype(dtype), np.full(N, -1))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value", "ignore:overflow")
def test_the_tree_finds_what_every_triangle_in_turn_finds(dtype, monkeypatch):
    mesh, tree, plain = kernels(dtype, monkeypatch)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), dtype)
    t, face = tree.closest(rays)
    t_plain, face_plain = plain.closest(rays)
    assert (t == t_plain).all() and (face == face_plain).all()
    assert 0.5 < np.isfinite(t).mean() < 1.0


@pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value", "ignore:overflow")
def test_what_lies_beyond_the_limit_is_left_out_and_the_rest_is_not(monkeypatch):
    mesh, tree, _ = kernels(np.float32, monkeypatch)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), np.float32)
    t, _ = tree.closest(rays)
    limit = np.where(np.arange(N) % 2, t, np.float32(1.0)).astype(np.float32)
    within, _ = tree.closest(rays, limit * np.float32(1.001))
    assert (within[t < limit] == t[t < limit]).all()
    assert np.isinf(within[t > limit * np.float32(1.001)]).all()


def test_few_leaves_are_visited():
    ball = trimesh.creation.icosphere(subdivisions=4)
    low, high = (f(ball.vertices[ball.faces], axis=1) for f in (np.min, np.max))
    seen = []
    o, d = np.array([[0.0], [0.0], [5.0]]), np.array([[0.05], [0.02], [-1.0]])
    root, over_d = bvh.build(low, high), bvh.inverse(d)
    bvh.walk(root, o, over_d, np.full(1, np.inf), lambda triangles, lanes, starting: seen.extend(triangles))
    assert 0 < len(seen) < len(ball.faces) / 10


def test_the_tree_holds_every_triangle_once():
    rng = np.random.default_rng(suite_seed())
    low = rng.random((1000, 3))
    low[500:] = low[0]  # many in one place
    leaves, waiting = [], [bvh.build(low, low + 0.1)]
    while waiting:
        node = waiting.pop()
        waiting.extend(node.children)
        leaves.extend([] if node.triangles is None else node.triangles.tolist())
    assert sorted(leaves) == list(range(1000))
