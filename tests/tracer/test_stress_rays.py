"""The stress cases of rays and what they meet, by their ids, in both precisions."""

import numpy as np
import pytest
from bare_scenes import DTYPES, TURN, going_on, placed, scene_of, unit
from cases import slow_but
from continuation import PLACES, box
from escapes import AIMS, closed_mesh, escapes
from escapes import PLACES as EMBREE
from meshes import icosphere
from white_room import segments, white_room

import tracer
from tracer import Settings, TracerError
from tracer.bsdf.diffuse import Diffuse
from tracer.camera import Camera
from tracer.definition import Definition, Surface
from tracer.light.sample import AREA, LightSample
from tracer.scene import Scene
from tracer.shape import Cube, Mesh, Rectangle, Sphere
from tracer.shape.rays import Rays

both = pytest.mark.parametrize("dtype", DTYPES)
quiet = pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value", "ignore:overflow")


@pytest.mark.slow
@pytest.mark.parametrize("aim", AIMS)
def test_s03_nothing_escapes_a_small_ball_where_embree_tests_itself(suite_seed, aim):
    """20480 triangles on a sphere of 2 m, 270 km from the origin."""
    assert escapes(EMBREE[1], aim, np.float64, 20_000, suite_seed, fine=5, radius=2.0) == 0


def test_s03_single_precision_refuses_it_in_one_line():
    vertices, faces = icosphere(2)
    middle = np.array(EMBREE[1])
    camera = Camera(middle, middle + [0, 0, 1.0], np.array([0.0, 1.0, 0.0]), 40.0)
    surfaces = (Surface(Mesh("ball", 2.0 * vertices + middle, faces), "white"),)
    scene = Scene(Definition("far", surfaces, {"white": Diffuse(np.ones((3, 1)))}, camera, 8, 8))
    with pytest.raises(TracerError, match=r"ball: .*single precision.*") as refusal:
        scene.at(Settings(precision=32))
    assert "\n" not in str(refusal.value)
    assert tracer.render(scene, Settings(precision=64, spp=1)).rgb.shape == (8, 8, 3)


@quiet
@both
@pytest.mark.parametrize("place", EMBREE, ids=["origin", "far"])
def test_s04_a_ray_through_an_edge_meets_one_of_its_two_owners(suite_seed, place, dtype):
    kernel, vertices, faces = closed_mesh(place, dtype)
    rng, n = np.random.default_rng(suite_seed), 40_000
    owner = rng.integers(0, len(faces), n)
    a, b = vertices[faces[owner, 0]].T.astype(float), vertices[faces[owner, 1]].T.astype(float)
    at = a + rng.uniform(0.01, 0.99, n) * (b - a)
    edges = {
        tuple(sorted(edge)): set() for face in faces for edge in zip(face, np.roll(face, 1), strict=True)
    }
    for number, face in enumerate(faces):
        for edge in zip(face, np.roll(face, 1), strict=True):
            edges[tuple(sorted(edge))].add(number)
    o = np.tile(vertices.astype(float).mean(axis=0)[:, None], n).astype(dtype)
    d = at - o.astype(float)
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    t, met = kernel.closest(Rays.towards(o, d, np.full(n, -1)))
    assert np.isfinite(t).all()
    owners = [edges[tuple(sorted((faces[k, 0], faces[k, 1])))] for k in owner]
    assert all(len(two) == 2 and m in two for two, m in zip(owners, met, strict=True))


@both
def test_s05_a_ray_at_a_vertex_meets_one_of_its_owners(suite_seed, dtype):
    kernel, vertices, faces = closed_mesh(EMBREE[0], dtype)
    vertex = np.random.default_rng(suite_seed).integers(0, len(vertices), 20_000)
    d = vertices[vertex].T.astype(float)
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    with np.errstate(all="ignore"):
        t, met = kernel.closest(Rays.towards(np.zeros_like(d), d, np.full(vertex.size, -1)))
    assert np.isfinite(t).all() and (faces[met] == vertex[:, None]).any(axis=1).all()


@pytest.mark.slow
@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("integrator", ["walk", "path"])
@pytest.mark.parametrize("place", PLACES[:3], ids=lambda place: place.name)
def test_s08_half_a_million_segments_bring_no_light_into_a_closed_room(
    place, integrator, precision, suite_seed
):
    found = segments(place, precision, suite_seed, integrator=integrator)
    assert found == {"segments": 500_000, "lit": 0.0}


def test_s08_a_room_with_a_hole_is_lit(suite_seed, monkeypatch):
    """The broken twin: one triangle of its walls is not asked."""
    scene = white_room(PLACES[0], "fine").at(Settings())
    (mesh,) = scene.arrangement.closest
    monkeypatch.setattr(mesh, "through", lambda *a, ask=mesh.through: holed(*ask(*a)))
    assert segments(PLACES[0], 32, suite_seed, side=8, name="fine")["lit"] > 0.0


def holed(triangles, lane, sums):
    there = triangles != 5
    return triangles[there], lane[there], sums[there]


@quiet
@both
@pytest.mark.parametrize("scale", slow_but((1e-6, 1e-3, 1.0, 1e4, 1e8), 1e8))
def test_s09_no_triangle_is_met_from_itself(suite_seed, scale, dtype):
    """20 000 rays from 2000 triangles of any shape: none comes back to its own."""
    rng, count, each = np.random.default_rng(suite_seed), 2000, 10
    corners = rng.normal(size=(count, 1, 3)) * 5.0 + rng.normal(size=(count, 3, 3))
    mesh = Mesh("soup", scale * corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    scene = scene_of([mesh], dtype)
    face = np.repeat(np.arange(count, dtype=np.int32), each)
    weight = rng.dirichlet([1, 1, 1], face.size)
    p = (scale * (corners[face] * weight[:, :, None]).sum(axis=1)).T.astype(dtype)
    _, _, t, met = going_on(scene, p, unit(rng, face.size, dtype), face)
    assert (met != face).all() and not np.isnan(t).any() and (t >= 0.0).all()


@both
@pytest.mark.parametrize("radius", [1e-4, 1e-2, 1.0, 1e2, 1e4])
@pytest.mark.parametrize("shift", [0.0, 3.0])
def test_s10_a_sphere_is_never_met_again_from_outside(suite_seed, radius, shift, dtype):
    rng = np.random.default_rng(suite_seed)
    centre = np.full(3, shift * radius)
    scene = scene_of([Sphere("ball", centre, radius)], dtype)
    n = np.repeat(unit(rng, 200, dtype), 100, axis=1)
    d = unit(rng, n.shape[1], dtype)
    d = np.where((d * n).sum(axis=0) < 0.0, -d, d)
    p = (centre[:, None] + radius * n.astype(float)).astype(dtype)
    hit, _, t, met = going_on(scene, p, d, np.zeros(n.shape[1], np.int32))
    outwards = (hit.ng * d).sum(axis=0) > 0.0
    assert outwards.mean() > 0.999 and np.isinf(t[outwards]).all() and (met[outwards] == -1).all()


@both
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("turn", [np.eye(3), TURN], ids=["straight", "turned"])
def test_s12_a_grazing_ray_leaves_to_its_side_and_sees_what_is_above(suite_seed, turn, scale, dtype):
    """n . w = 1e-8: the start lies on that side of the plane, and a point above it is seen."""
    rng, n = np.random.default_rng(suite_seed), 4000
    shift = scale * np.array([3.0, -2.0, 5.0])
    floor = Rectangle("floor", placed(scale, shift, turn))
    up = turn[:, 2:]
    lamp = placed(0.1 * scale, shift + 9.0 * scale * turn[:, 2], turn @ np.diag([1.0, -1.0, -1.0]))
    scene = scene_of([floor, Rectangle("lamp", lamp)], dtype, {1: np.ones(3)})
    local = np.vstack((rng.uniform(-1, 1, (2, n)), np.zeros(n)))
    p = (turn @ local * scale + shift[:, None]).astype(dtype)
    side = rng.choice([-1.0, 1.0], n)
    along = turn @ np.vstack((unit(rng, n, float)[:2], np.zeros(n)))
    along /= np.linalg.norm(along, axis=0)
    d = (along + 1e-8 * side * up).astype(dtype)
    hit, o, t, met = going_on(scene, p, d, np.zeros(n, np.int32))
    towards = np.sign((hit.ng * d).sum(axis=0).astype(float))
    towards[towards == 0.0] = 1.0
    height = (up * (o.astype(float) - shift[:, None])).sum(axis=0)
    assert (np.sign(height) == towards).all() and (met == -1).all() and np.isinf(t).all()
    if turn is not TURN:  # where the precision has this direction, it leaves as it was meant to
        assert (towards == side).all()
    q = (p + 3.0 * scale * d + 1e-3 * scale * up).astype(dtype)
    gap = q - hit.p
    distance = np.sqrt((gap * gap).sum(axis=0))
    light = LightSample(
        np.zeros(n, np.int32), np.ones(n, np.int32), np.ones(n, dtype), np.full(n, AREA), q,
        -hit.ng, gap / distance, distance, np.ones((3, n), dtype), np.ones(n, dtype),
    )  # fmt: skip
    with np.errstate(all="ignore"):
        assert not scene.occluded(hit, light).any()


@both
@pytest.mark.parametrize("kind", ["cube", "mesh", "rectangles"])
def test_s44_rays_along_the_axes_meet_what_they_meet_in_a_turned_scene(kind, dtype):
    """From outside, at and past a box from -1 to 1: among them rays in the planes of its faces."""
    inner = np.array([-1.5, -0.75, -0.3, 0.1, 0.6, 1.25])
    o, d = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            for a in inner:
                for b in inner:
                    o.append(np.roll([-4.0 * sign, a, b], axis))
                    d.append(np.roll([sign, 0.0, 0.0], axis))
    o, d = np.array(o).T, np.array(d).T
    answers = []
    for turn in (np.eye(3), TURN):
        scene = scene_of(box_of(kind, turn), dtype)
        with np.errstate(all="ignore"):
            start, way = (turn @ o).astype(dtype), (turn @ d).astype(dtype)
            answers.append(scene.intersect(start, way, np.full(o.shape[1], -1)))
    (t, met), (t_turned, met_turned) = answers
    assert (
        np.allclose(t, t_turned, rtol=32 * np.finfo(dtype).eps) and np.isfinite(t).any() and np.isinf(t).any()
    )
    assert (scene.shape_of[met[met >= 0]] == scene.shape_of[met_turned[met >= 0]]).all()
    assert kind == "mesh" or (met == met_turned).all()


@both
@pytest.mark.parametrize("kind", ["cube", "mesh"])
def test_s44_rays_in_the_plane_of_a_face_are_not_lost(kind, dtype):
    """1000 of them: the slabs of boxes, and those of the tree over a mesh, must keep 0 times infinity."""
    at = np.linspace(-0.999, 0.999, 1000)
    for axis in range(3):
        for face in (-1.0, 1.0):
            o = np.roll(np.stack((np.full(1000, -5.0), np.full(1000, face), at)), axis, axis=0).astype(dtype)
            d = np.roll(np.stack((np.ones(1000), np.zeros(1000), np.zeros(1000))), axis, axis=0).astype(dtype)
            with np.errstate(all="ignore"):
                t, _ = scene_of(box_of(kind, np.eye(3)), dtype).intersect(o, d, np.full(1000, -1))
            assert np.allclose(t, 4.0)


def box_of(kind, turn):
    """The box from -1 to 1 as one kind of shape."""
    if kind == "cube":
        return [Cube("box", placed(1.0, turn=turn))]
    if kind == "mesh":
        vertices, faces = box((-1, -1, -1), (1, 1, 1), 4)
        return [Mesh("box", vertices @ turn.T, faces)]
    walls = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            side = np.zeros((3, 3))
            side[axis, 2], side[(axis + 1) % 3, 0], side[(axis + 2) % 3, 1] = sign, 1.0, sign
            walls.append(Rectangle(f"side{axis}{sign}", placed(1.0, sign * turn[:, axis], turn @ side)))
    return walls


@pytest.mark.filterwarnings("error")
@both
def test_s67_a_tangent_ray_has_one_consistent_answer(dtype):
    """Where it touches at exactly one point: there or nowhere, alike from both ends and on all sides."""
    scene = scene_of([Sphere("ball", np.zeros(3), 1.0)], dtype)
    o, d = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            for height in (-1.0, 1.0):
                o.append(np.roll([-3.0 * sign, height, 0.0], axis))
                d.append(np.roll([sign, 0.0, 0.0], axis))
    o, d = np.array(o).T.astype(dtype), np.array(d).T.astype(dtype)
    with np.errstate(divide="ignore"):
        t, met = scene.intersect(o, d, np.full(o.shape[1], -1))
    assert (t == t[0]).all() and (met == met[0]).all() and (t[0] == 3.0 or np.isinf(t[0]))
    for off, hits in ((-1e-3, True), (1e-3, False)):
        with np.errstate(divide="ignore"):
            t, _ = scene.intersect(
                o * (1.0 + off * (np.abs(o) == 1.0)).astype(dtype), d, np.full(o.shape[1], -1)
            )
        assert np.isfinite(t).all() if hits else np.isinf(t).all()


@pytest.mark.filterwarnings("error")
@both
def test_s67_from_inside_and_from_the_surface_the_far_side_is_met(suite_seed, dtype):
    """Inside: one hit ahead at the distance that algebra gives. On it: outwards none, inwards the chord."""
    radius, centre = 1.7, np.array([0.4, -0.2, 0.9])
    scene, rng, n = scene_of([Sphere("ball", centre, radius)], dtype), np.random.default_rng(suite_seed), 4000
    d = unit(rng, n, dtype)
    o = (centre[:, None] + radius * 0.9 * rng.random(n) * unit(rng, n, float)).astype(dtype)
    with np.errstate(divide="ignore"):
        t, met = scene.intersect(o, d, np.full(n, -1))
    b = ((o - centre[:, None]) * d.astype(float)).sum(axis=0)
    c = ((o - centre[:, None]) ** 2).sum(axis=0) - radius**2
    assert (met == 0).all() and np.allclose(t, -b + np.sqrt(b * b - c), rtol=64 * np.finfo(dtype).eps)
    surface = (centre[:, None] + radius * unit(rng, n, float)).astype(dtype)
    with np.errstate(divide="ignore", invalid="ignore"):
        hit, _, t, met = going_on(scene, surface, d, np.zeros(n, np.int32))
    cos = (hit.ng * d).sum(axis=0)
    assert (np.isinf(t) == (cos >= 0.0)).all() and (met[cos < 0.0] == 0).all()
    inwards = cos < -1e-3
    assert np.allclose(t[inwards], -2.0 * radius * cos[inwards], rtol=1e-3)
