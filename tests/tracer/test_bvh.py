"""The tree of boxes finds what testing every triangle finds, bit for bit, and visits few."""

import numpy as np
import pytest
from meshes import icosphere
from suite import suite_seed

from tracer.shape import Mesh, bvh
from tracer.shape.rays import Rays
from tracer.shape.start import Faces

N = 2000
both = pytest.mark.parametrize("dtype", [np.float32, np.float64])
pytestmark = pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value", "ignore:overflow")


def ball(level=3):
    vertices, faces = icosphere(level)
    return Mesh("ball", vertices + [3.0, -2.0, 1.0], faces)


def soup():
    """Triangles in each other's way, every third of them twice."""
    corners = np.random.default_rng(suite_seed()).normal(size=(900, 3))
    faces = np.arange(900).reshape(-1, 3)
    return Mesh("soup", corners, np.concatenate((faces, faces[::3])))


def plates():
    """Two plates of many coplanar triangles each, in one edge."""
    u, v = (k.ravel() for k in np.meshgrid(np.arange(8), np.arange(8)))
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]])
    flat = (np.stack((u, v), axis=1)[:, None] + square).reshape(-1, 2) / 8.0
    rest = np.zeros(len(flat))
    corners = np.concatenate((np.c_[flat, rest], np.c_[flat[:, 0], rest, flat[:, 1]]))
    return Mesh("plates", corners, np.arange(len(corners)).reshape(-1, 3))


def kernels(mesh, dtype, monkeypatch):
    """The kernel of a mesh with its tree, and one that tests every triangle."""
    others = Faces.of((mesh,), dtype)
    tree = mesh.kernel(0, 1.0, dtype, others)
    monkeypatch.setattr(bvh, "ALONE", mesh.primitives)
    plain = mesh.kernel(0, 1.0, dtype, others)
    assert tree.tree.steps and not plain.tree.steps
    return tree, plain


def points(mesh, rng):
    """Points (N, 3) on triangles, on edges and at vertices, and their triangles (N,)."""
    face = rng.integers(mesh.primitives, size=N)
    weight = rng.dirichlet([1, 1, 1], N)
    weight[: N // 4, 0] = 0.0  # on an edge
    weight[N // 4 : N // 2] = [1.0, 0.0, 0.0]  # at a vertex
    weight /= weight.sum(axis=1, keepdims=True)
    return (mesh.vertices[mesh.faces[face]] * weight[:, :, None]).sum(axis=1), face


def aimed(mesh, rng, dtype):
    """Rays from all around at points on the mesh, along axes, and past the mesh."""
    at, _ = points(mesh, rng)
    at[-N // 10 :] += rng.normal(size=(N // 10, 3))
    d = -rng.normal(size=(N, 3)) * 4.0
    o = at - d
    d[: N // 10, rng.integers(3)] = 0.0
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return Rays.towards(o.T.astype(dtype), d.T.astype(dtype), np.full(N, -1))


def leaving(mesh, rng, dtype):
    """Rays from points on the mesh to all sides, as they are before they are moved off what they touch."""
    at, face = points(mesh, rng)
    d = rng.normal(size=(N, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return Rays.towards(at.T.astype(dtype), d.T.astype(dtype), face.astype(np.int32), touched=[])


def reported(rays):
    """The pairs of a ray and a triangle that it may touch, in order."""
    pairs = np.concatenate([np.stack(pair, axis=1) for pair in rays.touched])
    return pairs[np.lexsort(pairs.T)]


@both
@pytest.mark.parametrize("make", [ball, soup, plates])
def test_the_tree_finds_what_every_triangle_in_turn_finds(make, dtype, monkeypatch):
    mesh = make()
    tree, plain = kernels(mesh, dtype, monkeypatch)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), dtype)
    t, face = tree.closest(rays)
    t_plain, face_plain = plain.closest(rays)
    assert (t == t_plain).all() and (face == face_plain).all()
    assert 0.5 < np.isfinite(t).mean() < 1.0


@both
@pytest.mark.parametrize("make", [ball, plates])
def test_the_tree_knows_all_the_triangles_that_starts_may_touch(make, dtype, monkeypatch):
    mesh = make()
    tree, plain = kernels(mesh, dtype, monkeypatch)
    rays = leaving(mesh, np.random.default_rng(suite_seed()), dtype)
    by_plain = rays._replace(touched=[])
    t, face = tree.closest(rays)
    t_plain, face_plain = plain.closest(by_plain)
    assert (t == t_plain).all() and (face == face_plain).all()
    found, wanted = reported(rays), reported(by_plain)
    assert len(found) > N // 10 and found.tolist() == wanted.tolist()


@both
@pytest.mark.parametrize("kind", [aimed, leaving])
def test_a_ray_alone_meets_what_it_meets_in_company(kind, dtype):
    mesh = ball()
    kernel = mesh.kernel(0, 1.0, dtype, Faces.of((mesh,), dtype))
    rays = kind(mesh, np.random.default_rng(suite_seed()), dtype)
    t, face = kernel.closest(rays)
    for lane in range(0, N, 20):
        t_alone, face_alone = kernel.closest(rays.take(np.array([lane]), []))
        assert t_alone[0] == t[lane] and face_alone[0] == face[lane]


def test_groups_of_rays_do_not_matter(monkeypatch):
    mesh = ball()
    kernel = mesh.kernel(0, 1.0, np.float32)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), np.float32)
    t, face = kernel.closest(rays)
    monkeypatch.setattr(bvh, "GROUP", 70)
    monkeypatch.setattr(bvh, "_PAIRS", 32)
    t_small, face_small = kernel.closest(rays)
    assert (t == t_small).all() and (face == face_small).all()


def test_what_lies_beyond_the_limit_is_left_out_and_the_rest_is_not():
    mesh = ball()
    tree = mesh.kernel(0, 1.0, np.float32)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), np.float32)
    t, _ = tree.closest(rays)
    limit = np.where(np.arange(N) % 2, t, np.float32(1.0)).astype(np.float32)
    within, _ = tree.closest(rays, limit * np.float32(1.001))
    assert (within[t < limit] == t[t < limit]).all()
    assert np.isinf(within[t > limit * np.float32(1.001)]).all()


def leaves_visited(level):
    """Leaves that rays at a mesh of 20 * 4^level triangles visit on average."""
    mesh = ball(level)
    kernel = mesh.kernel(0, 1.0, np.float32)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), np.float32)
    never = np.zeros(N, bool)
    leaves, _, _ = bvh.all_leaves(
        kernel.tree, rays.o, bvh.inverse(rays.d), np.full(N, np.inf, np.float32), never
    )
    return leaves.size / N


def test_64_times_as_many_triangles_make_few_more_leaves_to_visit():
    assert 1.0 < leaves_visited(5) < 2.0 * leaves_visited(2) < 40.0


@pytest.mark.parametrize("count", [1, 2, 31, 32, 33, 64, 65, 100, 1000])
def test_the_tree_holds_every_triangle_once_and_inside_its_boxes(count):
    low = np.random.default_rng(suite_seed()).random((count, 3))
    low[count // 2 :] = low[0]  # many in one place
    high = low + 0.1
    tree = bvh.build(low, high)
    assert sorted(tree.leaves[tree.leaves >= 0].tolist()) == list(range(count))
    assert (tree.low <= low).all() and (tree.high >= high).all()
    if tree.steps:
        boxes = (
            tree.steps[-1].reshape(len(tree.steps[-1]), 2, 3, -1).transpose(1, 0, 3, 2).reshape(2, -1, 1, 3)
        )
        there = tree.leaves >= 0
        assert (boxes[0] <= low[tree.leaves])[there].all() and (boxes[1] >= high[tree.leaves])[there].all()
