"""Embree finds what castray's own tree finds, and its pictures are as repeatable as others."""

import pickle
from importlib.util import find_spec

import numpy as np
import pytest
from meshes import icosphere
from suite import missing, suite_seed

import tracer
from tracer import Settings, TracerError
from tracer.doctor import examine
from tracer.doctor.evidence import Evidence
from tracer.shape import Mesh, embree_kernel
from tracer.shape.embree_kernel import EmbreeKernel, through_embree
from tracer.shape.rays import Rays
from tracer.shape.start import Faces
from tracer.trace import gather

N = 4000


@pytest.fixture(autouse=True)
def embree():
    """Every test here needs it."""
    if find_spec("embreex") is None:
        missing("embreex")


@pytest.fixture
def kernels():
    """A ball's own kernel and the one through Embree."""
    vertices, faces = icosphere(4)
    mesh = Mesh("ball", 0.7 * vertices + [0.3, -0.2, 0.1], faces)
    exact = mesh.kernel(0, 1.0, np.float32, Faces.of((mesh,), np.float32))
    return mesh, exact, EmbreeKernel(exact)


def unit(v):
    return v / np.linalg.norm(v, axis=0)


def aimed(mesh, rng):
    """Rays from outside, three quarters of which meet the mesh, and limits (N,) that cut some short."""
    o = 3.0 * unit(rng.normal(size=(3, N)))
    d = unit(rng.uniform(-0.6, 0.6, (3, N)) + [[0.3], [-0.2], [0.1]] - o)
    return Rays.towards(o.astype("f"), d.astype("f"), np.full(N, -1, np.int32)), rng.uniform(1.0, 9.0, N)


def leaving(mesh, rng):
    """Rays from points on the mesh, a quarter on edges, to all sides; aimed at triangles at random."""
    face, other = rng.integers(mesh.primitives, size=(2, N)).astype(np.int32)
    weight = rng.dirichlet([1, 1, 1], N)
    weight[: N // 4, 0] = 0.0
    weight /= weight.sum(axis=1, keepdims=True)
    at = (mesh.vertices[mesh.faces[face]] * weight[:, :, None]).sum(axis=1).T
    rays = Rays.towards(at.astype("f"), unit(rng.normal(size=(3, N))).astype("f"), face, other, [])
    return rays, np.full(N, np.inf)


def reported(rays):
    pairs = np.concatenate([np.stack(pair, axis=1) for pair in rays.touched])
    return pairs[np.lexsort(pairs.T)].tolist()


@pytest.mark.parametrize("kind", [aimed, leaving])
def test_embree_leads_to_the_same_triangles_and_distances(kernels, kind):
    mesh, exact, by_embree = kernels
    rays, within = kind(mesh, np.random.default_rng(suite_seed()))
    with np.errstate(all="ignore"):
        t, face = exact.closest(rays, within.astype("f"))
        t_embree, face_embree = by_embree.closest(rays, within.astype("f"))
    assert (t == t_embree).all() and (face == face_embree).all()
    assert 0.2 < np.isfinite(t).mean() < 0.9


def test_embree_alone_would_meet_the_triangles_that_rays_start_on(kernels):
    """The broken twin: its word is not enough."""
    mesh, _, by_embree = kernels
    rays, within = leaving(mesh, np.random.default_rng(suite_seed()))
    assert (by_embree._propose(rays.o, rays.d, within.astype("f")) == rays.source).any()


def test_starts_that_touch_other_faces_are_reported_all_the_same(kernels):
    mesh, exact, by_embree = kernels
    rays, _ = leaving(mesh, np.random.default_rng(suite_seed()))
    again = rays._replace(touched=[])
    with np.errstate(all="ignore"):
        exact.closest(rays)
        by_embree.closest(again)
    assert reported(rays) == reported(again) and len(reported(rays)) > N // 10


@pytest.mark.parametrize("kind", [aimed, leaving])
def test_a_ray_alone_meets_what_it_meets_in_company(kernels, kind):
    mesh, _, by_embree = kernels
    rays, within = kind(mesh, np.random.default_rng(suite_seed()))
    with np.errstate(all="ignore"):
        t, face = by_embree.closest(rays, within.astype("f"))
        for lane in range(0, N, 40):
            alone = rays.take(np.array([lane]), [])
            t_alone, face_alone = by_embree.closest(alone, within[[lane]].astype("f"))
            assert t_alone[0] == t[lane] and face_alone[0] == face[lane]


def test_a_scene_sent_to_another_process_is_the_same_scene(kernels):
    mesh, _, by_embree = kernels
    rays, within = aimed(mesh, np.random.default_rng(suite_seed()))
    with np.errstate(all="ignore"):
        t, _ = by_embree.closest(rays)
        t_sent, _ = pickle.loads(pickle.dumps(by_embree)).closest(rays)
    assert (t == t_sent).all()


def test_it_is_asked_for_large_meshes_only(kernels):
    mesh, exact, _ = kernels
    vertices, faces = icosphere(0)
    small = Mesh("small", vertices, faces).kernel(0, 1.0, np.float32)
    assert through_embree(small) is small
    assert isinstance(through_embree(exact), EmbreeKernel)


def test_the_setting_decides():
    scene = tracer.load("smooth_ball")
    kinds = {
        accel: [type(kernel) for kernel in scene.at(Settings(accel=accel)).arrangement.closest]
        for accel in ("bvh", "embree")
    }
    assert EmbreeKernel in kinds["embree"] and EmbreeKernel not in kinds["bvh"]


def test_a_picture_by_embree_says_so_and_is_made_again_bit_for_bit():
    settings = Settings(width=24, height=24, spp=2, accel="embree", max_depth=6)
    picture, again = (tracer.render(tracer.load("smooth_ball"), settings) for _ in range(2))
    assert picture.settings.accel == "embree"
    assert (picture.rgb == again.rgb).all() and picture.rgb.mean() > 0.0


def test_the_doctor_judges_a_trace_by_embree_without_it():
    settings = Settings(width=16, height=16, spp=4, accel="embree")
    assert not examine(gather(tracer.load("smooth_ball"), settings)).findings
    assert Evidence(gather(tracer.load("smooth_ball"), settings)).scene.accel == "bvh"


def test_without_embreex_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setattr(embree_kernel, "find_spec", lambda name: None)
    with pytest.raises(TracerError, match="accel: .*pip install embreex") as refused:
        tracer.load("cornell_unit").at(Settings(accel="embree"))
    assert "\n" not in str(refused.value)
