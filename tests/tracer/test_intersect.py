"""Rays meet what they should, once: no self hits, no lost rays on faces and seams, nothing odd ends a run.

All of it exact: zero failures are allowed, at every size and in both precisions.
"""

import numpy as np
import pytest
from cases import loaded

import tracer
from lessons import zoo
from tracer import Settings
from tracer.integrator.wave import Wave
from tracer.shape import Cube, Sphere
from tracer.shape.rays import Rays

DTYPES = (np.float32, np.float64)
SCALES = (1e-6, 1e-3, 1.0, 1e4, 1e8)
SENSOR = {
    "type": "perspective",
    "fov": 40.0,
    "to_world": [{"look_at": {"origin": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}],
}

both = pytest.mark.parametrize("dtype", DTYPES)
scaled = pytest.mark.parametrize("scale", SCALES)


def scene_of(shapes, dtype, scale=1.0, shift=(0, 0, 0)):
    """A scene of dicts, all of it scaled and moved, in one precision."""
    place = [{"scale": scale}, {"translate": [float(v) * scale for v in shift]}]
    objects = {
        f"shape{k}": {**shape, "to_world": [*shape.get("to_world", []), *place]}
        for k, shape in enumerate(shapes)
    }
    look = {"origin": [0, 0, 4 * scale], "target": [0, 0, 0], "up": [0, 1, 0]}
    sensor = {**SENSOR, "to_world": [{"look_at": look}]}
    return tracer.load_dict({"sensor": sensor, **objects}).at(Settings(precision=dtype().itemsize * 8))


def directions(n, seed, dtype):
    d = np.random.default_rng(seed).normal(size=(3, n))
    return (d / np.linalg.norm(d, axis=0)).astype(dtype)


def quiet(function, *args):
    with np.errstate(all="ignore"):
        return function(*args)


def left_again(scene, shape_size, n, seed, dtype):
    """Rays shot at a shape, and rays that leave its points to random sides: hits and what they meet next."""
    rng = np.random.default_rng(seed)
    aim = rng.uniform(-1, 1, (3, n)) * shape_size
    o = (aim + 3 * shape_size * directions(n, seed + 1, np.float64)).astype(dtype)
    d = aim - o
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    t, primitive = quiet(scene.intersect, o, d, np.full(n, -1))
    met = np.flatnonzero(primitive >= 0)
    hit = quiet(scene.hit, o[:, met], d[:, met], t[met], primitive[met])
    wi = directions(met.size, seed + 2, dtype)
    start = scene.spawn(hit, wi)
    return hit, wi, *quiet(scene.intersect, start, wi, hit.primitive)


TURN = [{"rotate": [1, 2, 3], "angle": 37.0}]


@both
@scaled
@pytest.mark.parametrize("shift", [(0, 0, 0), (3, -2, 5)], ids=["here", "there"])
def test_s09_a_rectangle_is_never_met_from_itself(suite_seed, shift, scale, dtype):
    scene = scene_of([{"type": "rectangle", "to_world": TURN}], dtype, scale, shift)
    rays = 4000
    o = np.array(shift).reshape(3, 1) * scale + directions(rays, suite_seed, np.float64) * 2 * scale
    d = (np.array(shift).reshape(3, 1) * scale - o) / scale
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    t, primitive = quiet(scene.intersect, o.astype(dtype), d, np.full(rays, -1))
    met = np.flatnonzero(primitive == 0)
    assert met.size > rays // 2
    hit = scene.hit(o.astype(dtype)[:, met], d[:, met], t[met], primitive[met])
    wi = directions(met.size, suite_seed + 1, dtype)
    again, _ = quiet(scene.intersect, scene.spawn(hit, wi), wi, hit.primitive)
    assert np.isinf(again).all()


@both
@scaled
@pytest.mark.parametrize("kind", ["sphere", "cube"])
def test_s10_a_convex_body_is_left_from_outside_and_crossed_from_inside(suite_seed, kind, scale, dtype):
    """Outwards nothing is met. Inwards its far side is, at a distance that is not rounding."""
    scene = scene_of([{"type": kind, "to_world": TURN}], dtype, scale)
    hit, wi, t, primitive = left_again(scene, scale, 6000, suite_seed, dtype)
    assert hit.t.size > 1000
    cos = (hit.ng * wi).sum(axis=0)
    assert np.isinf(t[cos > 0]).all()
    inside = np.flatnonzero(cos < -1e-3)
    assert (primitive[inside] >= 0).all()
    assert kind == "sphere" or (primitive[inside] != hit.primitive[inside]).all()
    least = {"sphere": 1.9 * -cos[inside], "cube": 0.0 * cos[inside]}[kind]
    assert (t[inside] > least * scale).all()


def test_a_fixed_offset_is_caught_hitting_itself(suite_seed):
    """The broken twin: starting 1e-4 above the surface and excluding nothing."""
    scale, dtype, rays = 1e4, np.float32, 4000
    scene = scene_of([{"type": "rectangle", "to_world": TURN}], dtype, scale, (3, -2, 5))
    middle = np.array([[3.0], [-2.0], [5.0]]) * scale
    o = (middle + directions(rays, suite_seed, np.float64) * 2 * scale).astype(dtype)
    d = middle - o
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    t, primitive = quiet(scene.intersect, o, d, np.full(rays, -1))
    met = np.flatnonzero(primitive == 0)
    n = scene.hit(o[:, met], d[:, met], t[met], primitive[met]).ng
    wi = directions(met.size, suite_seed + 1, dtype)
    wi = np.where((n * wi).sum(axis=0) < 0, -wi, wi)
    start = o[:, met] + t[met] * d[:, met] + dtype(1e-4) * n
    again, _ = quiet(scene.intersect, start, wi, np.full(met.size, -1))
    assert np.isfinite(again).sum() > met.size // 10


@both
@pytest.mark.parametrize("shift", [(0, 0, 0), (7, -3, 2)])
def test_s44_rays_in_the_planes_of_a_cubes_faces_are_not_lost(shift, dtype):
    """0 times infinity: each ray runs along a face, or along an edge, of a cube that it does meet."""
    kernel = Cube("c", tracer_matrix(shift)).kernel(0, 10.0, dtype)
    o, d = [], []
    inner = np.linspace(-0.9, 0.9, 19)
    for axis in range(3):
        for sign in (-1, 1):
            for face in (-1, 1):
                for a in [*inner, -1.0, 1.0]:
                    start = np.roll([-5.0 * sign, face, a], axis) + shift
                    o += [start, np.roll([-5.0 * sign, a, face], axis) + shift]
                    d += [np.roll([1.0 * sign, 0.0, 0.0], axis), np.roll([1.0 * sign, -0.0, 0.0], axis)]
    o, d = np.array(o).T.astype(dtype), np.array(d).T.astype(dtype)
    t, _ = quiet(lambda: kernel.closest(Rays.towards(o, d, np.full(o.shape[1], -1))))
    assert np.allclose(t, 4.0)


def tracer_matrix(shift):
    matrix = np.eye(4)
    matrix[:3, 3] = shift
    return matrix


@both
@pytest.mark.parametrize("shift", [(0.0, 0.0, 0.0), (0.1, 1 / 3, -7.7), (278.0, 548.8, 279.6)])
def test_no_ray_falls_between_two_rectangles_that_share_an_edge(suite_seed, shift, dtype):
    """A floor of two halves, one of them turned the other way round; rays aimed at the seam exactly."""
    size = np.array([1.3, 2.1])
    halves = []
    for side, turn in ((-1, 0.0), (1, 180.0)):
        halves.append(
            {
                "type": "rectangle",
                "to_world": [
                    {"scale": [size[0], size[1], 1.0]},
                    {"rotate": [0, 0, 1], "angle": turn},
                    {"translate": [side * size[0], 0, 0]},
                    {"rotate": [1, 0, 0], "angle": 30.0},
                ],
            }
        )
    scene = scene_of(halves, dtype, 1.0, shift)
    rng = np.random.default_rng(suite_seed)
    n = 20_000
    along = rng.uniform(-0.99, 0.99, n) * size[1]
    tilt = np.radians(30.0)
    seam = np.stack((np.zeros(n), along * np.cos(tilt), along * np.sin(tilt))) + np.reshape(shift, (3, 1))
    above = seam + np.array([[0.0], [-np.sin(tilt)], [np.cos(tilt)]]) + rng.uniform(-0.5, 0.5, (3, n))
    o = above.astype(dtype)
    d = seam - o
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    _, primitive = quiet(scene.intersect, o, d, np.full(n, -1))
    assert (primitive >= 0).all()
    for kernel in scene.arrangement.closest:  # the broken twin: rectangles that end exactly at their edge
        kernel.limits = [dtype(1.0)] * 2
    _, primitive = quiet(scene.intersect, o, d, np.full(n, -1))
    assert not (primitive >= 0).all()


@both
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", ["cornell", "cornell_unit", "cornell_glass", "furnace", "smooth_ball"])
def test_s48_a_ray_that_is_none_meets_nothing(name, bad, dtype):
    scene = loaded(name).at(Settings(precision=dtype().itemsize * 8))
    good_o, good_d = np.array([0.1, 0.2, 0.3]), np.array([0.6, 0.0, -0.8])
    o, d = [], []
    for k in range(3):
        for spoil_origin in (True, False):
            one, other = good_o.copy(), good_d.copy()
            (one if spoil_origin else other)[k] = bad
            o.append(one)
            d.append(other)
    o, d = np.array(o).T.astype(dtype), np.array(d).T.astype(dtype)
    t, primitive = quiet(scene.intersect, o, d, np.full(6, -1))
    lost = np.isnan(o).any(axis=0) | np.isnan(d).any(axis=0) | np.isinf(o).any(axis=0)
    assert (primitive[lost] == -1).all() and np.isinf(t[lost]).all()


def not_a_ray(scene, hit, wi):
    """Every third path goes on along no direction at all."""
    o, d = zoo.RIGHT.next_ray(scene, hit, wi)
    return o, np.where(np.arange(d.shape[1]) % 3 == 0, np.nan, d).astype(d.dtype)


@pytest.mark.parametrize("integrator", ["walk", "direct", "path"])
@pytest.mark.parametrize("name", ["cornell", "cornell_unit", "cornell_glass", "furnace"])
def test_paths_whose_ray_is_none_end(name, integrator, suite_seed):
    settings = Settings(width=16, height=16, spp=4, integrator=integrator, seed=suite_seed)
    picture = tracer.render(loaded(name), settings, steps=zoo.changed(next_ray=not_a_ray))
    assert np.isfinite(picture.rgb).all()


@both
@pytest.mark.parametrize("kind", ["cube", "sphere"])
def test_a_closed_room_leaks_nothing(suite_seed, kind, dtype):
    """Of some 200 000 rays inside a room, turned and stretched if it is a box, none escapes."""
    stretch = [{"scale": [3.0, 0.7, 11.0]}] if kind == "cube" else []
    room = {
        "type": kind,
        "flip_normals": True,
        "to_world": stretch + TURN,
        "bsdf": {"type": "diffuse", "reflectance": 1},
    }
    scene = scene_of([room], dtype, 1.0, (0, 0, 4))
    settings = Settings(
        width=80, height=80, spp=2, integrator="walk", max_depth=17, roulette="off", seed=suite_seed,
        precision=dtype().itemsize * 8,
    )  # fmt: skip
    assert not escaped(scene, settings)


@both
@pytest.mark.parametrize("integrator", ["direct", "path"])
def test_the_furnace_leaks_nothing(suite_seed, integrator, dtype):
    settings = Settings(
        spp=2, integrator=integrator, max_depth=20, seed=suite_seed, precision=dtype().itemsize * 8
    )
    assert not escaped(loaded("furnace"), settings)


def escaped(scene, settings):
    """How many paths end because they leave the scene."""
    from tracer.engine import waves
    from tracer.events import ESCAPE

    settings = settings.at_size_of(scene)
    pixel, sample = np.divmod(np.arange(settings.width * settings.height * settings.spp), settings.spp)
    wave = Wave(pixel % settings.width, pixel // settings.width, sample, settings)
    return sum(e.lane.size for e in waves.events(scene.at(settings), settings, wave) if e.kind is ESCAPE)


@both
@pytest.mark.parametrize("distance", [1.0, 1e2, 1e4])
def test_a_sphere_far_away_keeps_its_digits(suite_seed, distance, dtype):
    """The naive quadratic is off by 0.87 radii at 1e4 in float32 (Haines et al. 2019)."""
    sphere = Sphere("s", np.zeros(3), 1.0).kernel(0, 1.0, dtype)
    rng = np.random.default_rng(suite_seed)
    n = 1000
    aim = rng.uniform(-0.5, 0.5, (3, n))
    o = (directions(n, suite_seed + 1, np.float64) * (2 + distance)).astype(dtype)
    d = aim - o.astype(float)
    d = (d / np.linalg.norm(d, axis=0)).astype(dtype)
    t, _ = quiet(sphere.closest, Rays.towards(o, d, np.full(n, -1)))
    o, d = o.astype(np.longdouble), d.astype(np.longdouble)
    b, size = (o * d).sum(axis=0), (d * d).sum(axis=0)
    truth = (-b - np.sqrt(b * b - size * ((o * o).sum(axis=0) - 1))) / size
    assert np.abs((t - truth) / truth).max() < 16 * np.finfo(dtype).eps
