"""What a tracer must survive of lamps: stress cases S16 to S26, in both precisions."""

import warnings

import checks
import lamps
import numpy as np
import pytest
import trimesh
from cases import slow_but
from stats import mean_and_error
from truth import entry, keys
from values.lights import from_rectangle

import tracer
from tracer import Settings
from tracer.events import TECHNIQUES
from tracer.frame import dot

both = pytest.mark.parametrize("precision", [32, 64])
GREY = {"type": "diffuse", "reflectance": 0.5}


@pytest.fixture(autouse=True)
def no_warnings():
    """Nothing may warn but what a kernel does on lanes whose result it throws away."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def floor(**more):
    return {
        "type": "rectangle",
        "to_world": [{"scale": 5}],
        "bsdf": {"type": "diffuse", "reflectance": 1.0},
        **more,
    }


WALLS = {
    "rectangle": ({"type": "rectangle"}, [{"scale": 5}]),
    "cube": ({"type": "cube"}, [{"scale": 5}, {"translate": [0, 0, -5]}]),
    "mesh": ({"type": "ply", "filename": "box.ply"}, [{"scale": 5}, {"translate": [0, 0, -5]}]),
}
PLACES = {
    "here": [],
    "turned": [{"rotate": [1, 2, 3], "angle": 33}],
    "far": [{"rotate": [1, 2, 3], "angle": 33}, {"translate": [70.3, -7.3, 31.7]}],
}


def lamp_in_a_wall(kind, place, order, folder):
    """A lamp in the plane of a wall's face, seen at a slant; its camera sees nothing else."""
    trimesh.creation.box((2, 2, 2)).export(folder / "box.ply")
    shape, there = WALLS[kind]
    wall = {**shape, "to_world": [*there, *place], "bsdf": GREY}
    lamp = {"type": "rectangle", "to_world": place, "emitter": {"type": "area", "radiance": 3.0}}
    look = {"look_at": {"origin": [0.3, -2, 4], "target": [0, 0, 0], "up": [0, 1, 0.1]}}
    camera = lamps.sensor(side=8) | {"fov": 15, "to_world": [look, *place]}
    objects = {"a": lamp, "b": wall} if order == "lamp first" else {"a": wall, "b": lamp}
    return tracer.load_dict({"sensor": camera, **objects}, folder=folder)


@both
@pytest.mark.parametrize("order", ["lamp first", "wall first"])
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("kind", WALLS)
def test_s16_a_lamp_in_the_plane_of_a_wall_is_seen_before_it(
    suite_seed, tmp_path, kind, place, order, precision
):
    """The rule: of a lamp and another face that only rounding tells apart the lamp is met, from its front."""
    scene = lamp_in_a_wall(kind, PLACES[place], order, tmp_path)
    for seed in range(8):
        radiance = checks.samples(
            scene, Settings(spp=1, seed=suite_seed + seed, max_depth=1, precision=precision)
        )
        assert (radiance == 3.0).all()


def test_s16_without_the_rule_rounding_decides(suite_seed, tmp_path):
    """The broken twin."""
    scene = lamp_in_a_wall("cube", PLACES["here"], "wall first", tmp_path).at(Settings(precision=64))
    kernels = scene.arrangement.closest
    kernels[:] = [getattr(kernel, "kernel", kernel) for kernel in kernels]
    radiance = checks.samples(scene, Settings(spp=1, seed=suite_seed, max_depth=1, precision=64))
    assert {0.0, 3.0} == set(np.unique(radiance))


@pytest.mark.statistical
@both
@pytest.mark.parametrize("d", [1e-4, 1e-6, 1e-12])
def test_s18_a_lamp_nearer_than_a_hair_stays_finite(suite_seed, d, precision):
    """Where float32 cannot tell the receiver from the lamp's plane it samples by area: no light then, but no
    infinity either, and the event says so."""
    scene = lamps.scene(lamps.rectangle([0, 0, 0.5], [0, 0.5, 0], [0, 0, 0.5], towards=[1, 0, 0.5]))
    light = lamps.light_samples(scene, [d, 0, 0], suite_seed, 200_000, precision)
    assert np.isfinite(light.wi).all() and np.isfinite(light.Le).all()
    if precision == 32 and d < 1e-5:
        assert (light.technique == TECHNIQUES.index("area")).all()
        assert np.isfinite(lamps.irradiance(light)).all()
        return
    key = f"rect.wall_touching_floor.d={'1e-4' if d == 1e-4 else '1e-6' if d == 1e-6 else '1e-12'}"
    assert (light.technique == TECHNIQUES.index("solid_angle")).all()
    assert lamps.close(lamps.irradiance(light), entry(key)[1], slack=1e-5)


@both
def test_s19_a_lamp_edge_on_sends_nothing(suite_seed, precision):
    given, _ = entry("rect.edge_on")
    lamp = lamps.rectangle(*(given[k] for k in ("light_center", "half_u", "half_v")))
    for by in ("area", "solid_angle"):
        light = lamps.light_samples(lamps.scene(lamp), [0, 0, 0], suite_seed, 20_000, precision, by)
        assert not lamps.irradiance(light).any() and not light.pdf.any() and not light.Le.any()
        assert not np.isnan(light.pdf).any()


@pytest.mark.slow
@pytest.mark.statistical
@both
@pytest.mark.parametrize("by", ["area", "solid_angle"])
@pytest.mark.parametrize("key", keys("rect.clipped", "rect.tilted"))
def test_s20_a_lamp_partly_below_the_horizon(suite_seed, key, by, precision):
    given, value = entry(key)
    found = from_rectangle(key, given, precision, suite_seed, 2_000_000, by)
    assert lamps.close(found, value, slack=1e-5)


@pytest.mark.statistical
@both
def test_s22_a_lamp_that_fills_the_hemisphere(suite_seed, precision):
    lamp = lamps.rectangle([0, 0, 1], [1e4, 0, 0], [0, 1e4, 0], towards=[0, 0, 0])
    light = lamps.light_samples(lamps.scene(lamp), [0, 0, 0], suite_seed, 200_000, precision)
    omega = entry("solidangle.rect.centred.half=1e4x1e4.h=1")[1]
    assert np.abs(1 / light.pdf.astype(float) / omega - 1).max() < {32: 3e-7, 64: 1e-12}[precision]
    # Float32 rounds points of so large a lamp to 1e-3 of its height.
    assert lamps.close(lamps.irradiance(light), np.pi, slack={32: 1e-3, 64: 1e-4}[precision])


@pytest.mark.slow
@pytest.mark.statistical
@both
def test_s23_a_receiver_on_a_sphere_and_one_inside(suite_seed, precision):
    outside = lamps.scene(lamps.sphere([0, 0, 0], 1.0))
    light = lamps.light_samples(outside, [0, 0, 1.001], suite_seed, 400_000, precision)
    assert lamps.close(lamps.irradiance(light, [0, 0, -1]), np.pi / 1.001**2, slack=1e-4)
    assert (light.technique == TECHNIQUES.index("cone")).all()
    assert not lamps.light_samples(outside, [0, 0, 0.5], suite_seed, 1000, precision).Le.any()
    room = lamps.scene(lamps.sphere([0, 0, 0], 1.0, flip_normals=True))
    light = lamps.light_samples(room, [0, 0.3, 0.5], suite_seed, 1_600_000, precision)
    assert (light.Le == 1.0).all() and (light.technique == TECHNIQUES.index("area")).all()
    assert lamps.close(lamps.irradiance(light), np.pi, slack=1e-5)
    assert not lamps.light_samples(room, [0, 0, 1.5], suite_seed, 1000, precision).Le.any()


@both
@pytest.mark.parametrize("by", ["area", "solid_angle"])
@pytest.mark.parametrize("strategy", ["light", "mis"])
@pytest.mark.parametrize("place", [([0, 0, 0], 1.0), ([5.07, 0.15, -6.24], 0.1), ([100, 20, 30], 1.0)])
def test_s23_a_ball_that_shines_and_reflects_does_not_light_itself(place, strategy, by, precision):
    """A point on it, by rounding inside or outside, is lit by no other point of it."""
    center, radius = place
    ball = lamps.sphere(center, radius, bsdf={"type": "diffuse", "reflectance": 1.0})
    camera = lamps.sensor(np.add(center, [0, 0, 3 * radius]), center, side=12)
    picture = tracer.render(
        lamps.scene(ball, camera=camera),
        Settings(spp=16, max_depth=4, precision=precision, strategy=strategy, light_sampling=by),
    )
    assert picture.dropped == 0 and picture.rgb.max() == 1.0
    assert (picture.rgb[4:8, 4:8] == 1.0).all()


@both
def test_s25_a_black_lamp_beside_others_is_never_chosen(suite_seed, precision):
    black = lamps.sphere([0, 0, 3], 0.5, 0.0)
    point = {"type": "point", "position": [0, 0, 2], "intensity": 0.0}
    sky = {"type": "constant", "radiance": 0.0}
    lit = lamps.rectangle([0, 0, 2], [0.5, 0, 0], [0, 0.5, 0], towards=[0, 0, 0])
    scene = lamps.scene(black, point, sky, lit)
    assert scene.light_names == ("object3",)
    light = lamps.light_samples(scene, [0, 0, 0], suite_seed, 1000, precision)
    assert (light.pick == 1.0).all() and (light.light == 0).all() and (light.Le[0] == 1.0).all()
    tracer.render(scene, Settings(width=4, height=4, spp=1, integrator="walk", max_depth=3))  # nothing unmet
    alone = lamps.scene(black, point, sky, floor())
    picture = tracer.render(alone, Settings(width=4, height=4, spp=4, precision=precision))
    assert not alone.light_names and not picture.rgb.any() and picture.dropped == 0


@both
@pytest.mark.parametrize("integrator", ["walk", "direct", "path"])
def test_s26_without_lamps_all_is_black_and_no_shadow_ray_is_cast(integrator, precision):
    scene = lamps.scene(floor(), camera=lamps.sensor([0, 0, 2], side=4))
    options = Settings(spp=4, integrator=integrator, precision=precision, max_depth=2)
    picture = tracer.render(scene, options)
    assert not picture.rgb.any() and picture.dropped == 0
    bounced = integrator != "direct"  # which knows that a last bounce adds nothing
    assert picture.rays == (1 + bounced) * picture.paths  # the camera's, and one bounce that leaves


@pytest.mark.statistical
@pytest.mark.parametrize("precision", slow_but((32, 64), 32))
def test_the_densities_of_a_lamp_integrate_to_one(suite_seed, precision):
    """Over all directions: 1 where they meet the lamp. Uniform directions in its own box around it."""
    lamp = lamps.rectangle([0.3, -0.2, 1], [0.5, 0.1, 0], [-0.16, 0.8, 0], towards=[0, 0, 0])
    for which in (lamp, lamps.sphere([0.3, -0.2, 1.5], 0.7)):
        scene = lamps.scene(which).at(Settings(precision=precision))
        d = np.random.default_rng(suite_seed).normal(size=(3, 1_000_000))
        d = (d / np.sqrt(dot(d, d))).astype(scene.dtype)
        o = np.zeros_like(d)
        with np.errstate(all="ignore"):
            t, primitive = scene.intersect(o, d, np.full(d.shape[1], -1))
            lanes = np.flatnonzero(primitive >= 0)
            hit = scene.hit(o[:, lanes], d[:, lanes], t[lanes], primitive[lanes])
            pdf = np.zeros(d.shape[1])
            lit = scene.shining(hit)
            pdf[lanes[lit]] = scene.emission(hit, o[:, lanes], lit)[1]
        whole = 4 * np.pi * pdf
        error = whole.std() / np.sqrt(whole.size)
        assert abs(whole.mean() - 1) < 4 * error < 0.02
        assert abs(0.97 * whole.mean() - 1) > 4 * error  # the broken twin: a density 3 % too small


@pytest.mark.slow
@pytest.mark.statistical
def test_many_lamps_light_a_room_whichever_way_they_are_found(suite_seed):
    scene = tracer.load("many_lights")
    assert len(scene.light_names) >= 50
    found = [
        checks.samples(
            scene, Settings(width=8, height=8, spp=n, seed=suite_seed + n, integrator=i, max_depth=3)
        )
        for i, n in (("path", 400), ("direct", 800), ("walk", 3000))
    ]
    for other in found[1:]:
        assert checks.agreement([found[0]], [other]) <= 1.0
    mean, error = mean_and_error(found[0])
    assert (error < 0.04 * mean).all()
    for other in found[1:]:  # the broken twin: a fifth too bright
        assert checks.agreement([1.2 * found[0]], [other]) > 1.0
