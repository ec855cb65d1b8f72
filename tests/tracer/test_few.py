"""Few triangles met by planes: the answers are the exact kernel's. No shadow is left out where it falls."""

import numpy as np
import pytest
from bare_scenes import placed, scene_of
from continuation import box
from suite import suite_seed

from tracer.shape import Cube, Mesh, Rectangle, cull, few
from tracer.shape.rays import Rays
from tracer.shape.start import Faces

N = 4000
both = pytest.mark.parametrize("dtype", [np.float32, np.float64])
pytestmark = pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value", "ignore:overflow")


def block():
    return Mesh("block", *box((-0.4, -0.3, -0.5), (0.7, 0.5, 0.4)))


def without_a_side():
    vertices, faces = box((-0.4, -0.3, -0.5), (0.7, 0.5, 0.4))
    return Mesh("open", vertices, faces[2:])


def folded():
    """Two triangles that are not quite in one plane."""
    corners = np.array([[0, 0, 0], [1, 0, 0.01], [1, 1, 0], [0, 1, 0]], float)
    return Mesh("folded", corners, np.array([[0, 1, 2], [0, 2, 3]]))


def soup():
    """Triangles in each other's way, some of them twice, one of those from behind."""
    corners = np.random.default_rng(suite_seed()).normal(size=(45, 3))
    faces = np.arange(45).reshape(-1, 3)
    return Mesh("soup", corners, np.concatenate((faces, faces[:4], faces[:1, ::-1])))


meshes = pytest.mark.parametrize("make", [block, without_a_side, folded, soup])


def kernels(mesh, dtype):
    """The kernel by planes and the exact one."""
    others = Faces.of((mesh,), dtype)
    exact = mesh.kernel(0, 4.0, dtype, others)
    return few.by_planes(exact, mesh, 4.0, dtype, others), exact


def points(mesh, rng):
    """Points (N, 3) on triangles, on edges and at vertices, and their triangles (N,)."""
    face = rng.integers(mesh.primitives, size=N)
    weight = rng.dirichlet([1, 1, 1], N)
    weight[: N // 4, 0] = 0.0
    weight[N // 4 : N // 2] = [1.0, 0.0, 0.0]
    weight /= weight.sum(axis=1, keepdims=True)
    return (mesh.vertices[mesh.faces[face]] * weight[:, :, None]).sum(axis=1), face


def aimed(mesh, rng, dtype):
    """Rays from all around at points on the mesh, some along axes, some past it; some have a target."""
    at, face = points(mesh, rng)
    at[-N // 10 :] += rng.normal(size=(N // 10, 3))
    d = rng.normal(size=(N, 3))
    d[: N // 10, rng.integers(3)] = 0.0
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    target = np.where(rng.random(N) < 0.2, face, -1).astype(np.int32)
    return Rays.towards(
        (at - 2.0 * d).T.astype(dtype), d.T.astype(dtype), np.full(N, -1, np.int32), target, []
    )


def leaving(mesh, rng, dtype):
    """Rays from points on the mesh to all sides, a tenth nearly along their triangles."""
    at, face = points(mesh, rng)
    d = rng.normal(size=(N, 3))
    n = mesh.planes()[0].T[face]
    d[::10] -= (1.0 - 1e-5) * (d * n).sum(axis=1, keepdims=True)[::10] * n[::10]
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return Rays.towards(at.T.astype(dtype), d.T.astype(dtype), face.astype(np.int32), touched=[])


def answers(kernel, rays):
    """Distances (N,), triangles (N,), -1 for none, and pairs of a start and a triangle it may touch."""
    rays = rays._replace(touched=[])
    t, number = kernel.closest(rays)
    met = np.flatnonzero(np.isfinite(t))
    triangle = np.full(t.size, -1)
    triangle[met] = number(met) if callable(number) else number[met]
    pairs = {
        (a, b) for lanes, faces in rays.touched for a, b in zip(lanes.tolist(), faces.tolist(), strict=True)
    }
    return t, triangle, pairs


def differences(planes, exact, rays):
    """Lanes whose triangle is another; distances of the others agree as far as the precision goes."""
    (t, triangle, touched), (t_exact, wanted, touched_exact) = answers(planes, rays), answers(exact, rays)
    same = (triangle == wanted) & (wanted >= 0)
    steep = np.abs((planes.exact.n[:, wanted[same]] * rays.d[:, same]).sum(axis=0))
    off = np.abs(t[same] - t_exact[same]) * np.maximum(steep, 1e-3)
    assert off.max() <= 64.0 * np.finfo(t.dtype).eps * 4.0
    assert touched == touched_exact
    return np.flatnonzero(triangle != wanted)


@both
@meshes
@pytest.mark.parametrize("kind", [aimed, leaving])
def test_planes_give_the_triangles_that_the_exact_test_gives(make, kind, dtype):
    mesh = make()
    planes, exact = kernels(mesh, dtype)
    assert isinstance(planes, few.FewKernel)
    rays = kind(mesh, np.random.default_rng(suite_seed()), dtype)
    assert differences(planes, exact, rays).size == 0
    assert 0.05 < (answers(planes, rays)[1] >= 0).mean() < 1.0 or make is folded


@pytest.mark.parametrize("make", [block, soup])
def test_without_doubt_at_edges_some_triangles_are_others(make, monkeypatch):
    mesh = make()
    planes, exact = kernels(mesh, np.float32)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), np.float32)
    sure = [plane._replace(doubt=[0.0 * doubt for doubt in plane.doubt]) for plane in planes._planes]
    monkeypatch.setattr(planes, "_planes", sure)
    monkeypatch.setattr(planes, "_blur", np.float32(-1.0))
    assert differences(planes, exact, rays).size > 10


@both
def test_a_ray_alone_meets_what_it_meets_in_company(dtype):
    mesh = soup()
    planes, _ = kernels(mesh, dtype)
    rays = aimed(mesh, np.random.default_rng(suite_seed()), dtype)
    t, triangle, _ = answers(planes, rays)
    for lane in range(0, N, 20):
        t_alone, alone, _ = answers(planes, rays.take(np.array([lane]), []))
        assert t_alone[0] == t[lane] and alone[0] == triangle[lane]


def test_many_triangles_keep_their_own_kernel():
    mesh = Mesh("fine", *box((-1, -1, -1), (1, 1, 1), 2))
    _, exact = kernels(mesh, np.float32)
    assert few.by_planes(exact, mesh, 4.0, np.float32, None) is exact


@both
@pytest.mark.parametrize("thin", [1e-9, 1e-6])
def test_slivers_and_what_the_precision_cannot_hold_keep_theirs(thin, dtype):
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, thin, 0], [0, thin, 0]]) + 3.0
    mesh = Mesh("sliver", corners, np.array([[0, 1, 2], [0, 2, 3]]))
    planes, exact = kernels(mesh, dtype)
    assert planes is exact or (dtype == np.float64 and isinstance(planes, few.FewKernel))


def hidden_scene(rng, dtype):
    """A floor, a lamp over it and a cube, a block and a rectangle, anywhere between."""
    down = np.diag([1.0, -1.0, -1.0])
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn = turn * np.sign(np.linalg.det(turn))
    vertices, faces = box((-0.2, -0.3, -0.1), (0.2, 0.1, 0.3))
    at = rng.uniform([-1.0, -1.0, 0.4], [1.0, 1.0, 1.6], (3, 3))
    shapes = [
        Rectangle("floor", placed(2.0, np.zeros(3), np.eye(3))),
        Rectangle("lamp", placed(0.3, np.append(rng.uniform(-1, 1, 2), 2.5), down)),
        Cube("cube", placed(0.25, at[0], turn)),
        Mesh("block", vertices @ turn.T + at[1], faces),
        Rectangle("sheet", placed(0.4, at[2], turn)),
    ]
    return scene_of(shapes, dtype, {1: np.ones(3)})


def shadow_rays(scene, rng, n=1000):
    """Hits on all shapes but the lamp, and points on the lamp for them."""
    counts = [shape.primitives for shape in scene.shapes]
    shape = rng.choice([0, 2, 3, 4], n)
    face = scene.first[shape] + rng.integers(1 << 16, size=n) % np.take(counts, shape)
    p = (scene.faces.corners[:, :, face] * rng.dirichlet(np.ones(4), n).T).sum(axis=1).astype(scene.dtype)
    hit = scene.hit(p, -scene._surfaces._n[:, face], np.zeros(n, scene.dtype), face.astype(np.int32))
    return hit, scene.sample_light(hit.p, rng.random((3, n)).astype(scene.dtype))


def shadows_left_out(dtype, monkeypatch, scenes=20):
    """Of how many shadow rays the answer is another than that of shapes that are always asked; and how many
    shapes are not always asked, and how many rays are blocked."""
    rng, other, told, blocked = np.random.default_rng(suite_seed()), 0, 0, 0
    for _ in range(scenes):
        scene = hidden_scene(rng, dtype)
        told += len(scene.arrangement.shading)
        hit, light = shadow_rays(scene, rng)
        found = scene.occluded(hit, light)
        with monkeypatch.context() as always:
            always.setattr(cull.Shadow, "_reached", lambda self, rays: np.ones(rays.source.shape, bool))
            wanted = scene.occluded(hit, light)
        other += np.count_nonzero(found != wanted)
        blocked += np.count_nonzero(wanted)
    return other, told, blocked


@both
def test_no_shadow_is_left_out(dtype, monkeypatch):
    other, told, blocked = shadows_left_out(dtype, monkeypatch)
    assert other == 0 and told >= 20 and blocked > 1000


def test_shadows_no_longer_than_the_shapes_are_caught(monkeypatch):
    monkeypatch.setattr(cull, "_shadow", lambda body, lamps, bounds: body)
    assert shadows_left_out(np.float32, monkeypatch)[0] > 100
