"""The stress cases of single triangles, by their ids: slivers, fans, and what has no area."""

import numpy as np
import pytest
from bare_scenes import DTYPES, going_on, scene_of, unit
from meshes import icosphere

from tracer import TracerError
from tracer.shape import Mesh

both = pytest.mark.parametrize("dtype", DTYPES)
quiet = pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value", "ignore:overflow")


def with_slivers(ratio):
    """A ball of triangles, each of 80 cut in three by a point next to one of its edges: slivers that are
    `ratio` times as high as long, and one fan of a thousand thin triangles around a vertex."""
    vertices, faces = icosphere(1)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    inner = (a + b) / 2.0 + ratio * (c - (a + b) / 2.0)
    number = len(vertices) + np.arange(len(faces))
    parts = [np.stack((faces[:, k], faces[:, (k + 1) % 3], number), axis=1) for k in range(3)]
    vertices, faces = np.concatenate((vertices, inner)), np.concatenate(parts)
    first, second, third = faces[-1]
    share = np.linspace(0.0, 1.0, 1001)[1:-1, None]
    rim = vertices[first] + share * (vertices[second] - vertices[first])
    ring = np.concatenate(([first], len(vertices) + np.arange(len(rim)), [second]))
    fan = np.stack((ring[:-1], ring[1:], np.full(1000, third)), axis=1)
    edge = {first, second}
    other = next(k for k, face in enumerate(faces[:-1]) if edge <= set(face))
    apex = (set(faces[other]) - edge).pop()
    back = np.stack((ring[1:], ring[:-1], np.full(1000, apex)), axis=1)
    faces = np.concatenate((np.delete(faces, [other, len(faces) - 1], axis=0), fan, back))
    return np.concatenate((vertices, rim)), faces


@pytest.mark.slow
@quiet
@both
@pytest.mark.parametrize("ratio", [1e-7, 1e-12])
def test_s13_slivers_and_fans_leave_no_crack(suite_seed, ratio, dtype):
    """Rays from the middle at their edges, corners and points; what they meet has a normal of length 1."""
    vertices, faces = with_slivers(ratio)
    mesh = Mesh("slivers", 2.0 * vertices + [0.3, -0.1, 0.2], faces)
    scene, rng, n = scene_of([mesh], dtype), np.random.default_rng(suite_seed), 6000
    middle = mesh.vertices.mean(axis=0).astype(dtype).astype(float)
    rounded = mesh.vertices.astype(dtype).astype(float)
    for weights in ((1, 0, 0), (1, 1, 0), (1, 1, 1)):
        w = rng.random((n, 3)) * weights
        at = (
            rounded[mesh.faces[rng.integers(0, len(mesh.faces), n)]]
            * (w / w.sum(axis=1)[:, None])[:, :, None]
        )
        d = at.sum(axis=1).T - middle[:, None]
        d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
        o = np.tile(middle[:, None], n).astype(dtype)
        t, met = scene.intersect(o, d, np.full(n, -1))
        assert (met >= 0).all() and np.isfinite(t).all()
        hit = scene.hit(o, d, t, met)
        assert np.abs(np.linalg.norm(hit.ng, axis=0) - 1.0).max() < 1e-6 and np.isfinite(hit.p).all()


@pytest.mark.slow
@both
def test_s13_no_ray_that_goes_on_from_a_sliver_escapes(suite_seed, dtype):
    vertices, faces = with_slivers(1e-7)
    mesh = Mesh("slivers", vertices, faces[:, ::-1])
    scene, rng, n = scene_of([mesh], dtype), np.random.default_rng(suite_seed), 20_000
    face = rng.integers(0, len(mesh.faces), n).astype(np.int32)
    corners = mesh.vertices[mesh.faces[face]]
    p = (corners * rng.dirichlet([0.3, 0.3, 0.3], n)[:, :, None]).sum(axis=1).T.astype(dtype)
    d = unit(rng, n, dtype)
    normal = mesh.planes()[0][:, face]
    d = np.where((d * normal).sum(axis=0) < 0.0, -d, d)
    _, _, _, met = going_on(scene, p, d, face)
    assert (met >= 0).all()


PBRT = (-1113.45459, -79.049614, -56.2431908), (-1113.45459, -87.0922699, -56.2431908), (
    -1113.45459, -79.2090149, -56.2431908,
)  # fmt: skip
NO_AREA = {
    "repeated": ((0.2, 0.1, 0.4), (0.2, 0.1, 0.4), (0.7, 0.3, 0.4)),
    "a point": ((0.2, 0.1, 0.4),) * 3,
    "collinear": ((0.0, 0.0, 0.4), (0.25, 0.25, 0.4), (0.75, 0.75, 0.4)),
    "pbrt": PBRT,
}


@pytest.mark.filterwarnings("error")
@both
@pytest.mark.parametrize("kind", NO_AREA)
@pytest.mark.parametrize("shines", [False, True])
def test_s14_triangles_without_area_are_never_met_nor_sampled(suite_seed, kind, shines, dtype):
    """Beside the good ones of a ball; pbrt's is its Triangle.BadCases."""
    vertices, faces = icosphere(2)
    more = np.concatenate((vertices, np.array(NO_AREA[kind])))
    bad = np.array([[0, 1, 2]]) + len(vertices)
    clean, spoilt = Mesh("ball", vertices, faces), Mesh("ball", more, np.concatenate((bad, faces, bad)))
    light = {0: np.ones(3)} if shines else {}
    a, b = scene_of([clean], dtype, light), scene_of([spoilt], dtype, light)
    assert spoilt.primitives == len(faces) and (spoilt.area() > 0.0).all()
    rng, n = np.random.default_rng(suite_seed), 2000
    o, d = (4.0 * unit(rng, n, float)).astype(dtype), unit(rng, n, dtype)
    with np.errstate(all="ignore"):  # as the loop has it
        answers = [scene.intersect(o, d, np.full(n, -1)) for scene in (a, b)]
    assert (answers[0][0] == answers[1][0]).all() and (answers[0][1] == answers[1][1]).all()
    if shines:
        u = rng.random((3, n)).astype(dtype)
        one, other = (scene.sample_light(o, u) for scene in (a, b))
        assert (one.q == other.q).all() and (one.pdf == other.pdf).all() and np.isfinite(other.pdf).all()


@both
def test_s14_pbrts_ray_meets_nothing(dtype):
    good = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    mesh = Mesh("bad", np.array([*PBRT, *good]), np.arange(6).reshape(2, 3))
    o = np.array([[-1081.47925], [99.9999542], [87.7701111]]).astype(dtype)
    d = np.array([[-32.1072998], [-183.355865], [-144.607635]])
    d = (d / np.linalg.norm(d)).astype(dtype)
    with np.errstate(all="ignore"):
        t, met = scene_of([mesh], dtype).intersect(o, d, np.full(1, -1))
    assert np.isinf(t).all() and (met == -1).all()


def test_s14_a_mesh_of_nothing_else_is_refused():
    with pytest.raises(TracerError, match="flat: no triangle has any area"):
        Mesh("flat", np.array(PBRT), np.array([[0, 1, 2]]))
