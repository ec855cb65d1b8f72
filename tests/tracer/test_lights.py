"""Lamps: uniform points, true densities, and one answer whichever way a lamp is found.

Chi-square at 1 %, shared out by Sidak's formula among the lamps.
"""

import numpy as np
import pytest
from stats import chi_square, sidak, uniform

import tracer
from tracer import Settings
from tracer.frame import dot

N = 60_000
LOOK = {"look_at": {"origin": [0, 0, 9], "target": [0, 0, 0], "up": [0, 1, 0]}}
TURN = [{"scale": [1.5, 0.6, 1]}, {"rotate": [1, 2, 3], "angle": 37.0}, {"translate": [0.3, -0.2, 0.5]}]
LAMPS = {
    "rectangle": {"type": "rectangle", "to_world": TURN},
    "cube": {"type": "cube", "to_world": [{"scale": [1.5, 0.6, 0.9]}, *TURN[1:]]},
    "sphere": {"type": "sphere", "radius": 0.8, "center": [0.3, -0.2, 0.5]},
    "tall box": {"type": "obj", "filename": "meshes/cornell_tall_box.obj", "to_world": [{"scale": 0.01}]},
}


def room(*lamps):
    """A scene of lamps; each is (its table, radiance)."""
    objects = {
        f"lamp{k}": {**lamp, "emitter": {"type": "area", "radiance": radiance}}
        for k, (lamp, radiance) in enumerate(lamps)
    }
    from scenes import __file__ as beside

    sensor = {"type": "perspective", "fov": 40, "to_world": [LOOK]}
    return tracer.load_dict({"sensor": sensor, **objects}, folder=beside.rpartition("/")[0] or ".")


def sampled(scene, seed, n=N, precision=64, p=None, by="area"):
    """Light samples for receivers far away, or at p (3,)."""
    scene = scene.at(Settings(precision=precision, light_sampling=by))
    bits = {32: 24, 64: 32}[precision]
    u = (np.random.default_rng(seed).integers(0, 2**bits, (3, n)) * 2.0**-bits).astype(scene.dtype)
    p = np.array([3.0, 40.0, 20.0] if p is None else p)
    return scene, scene.sample_light(np.repeat(p[:, None], n, axis=1).astype(scene.dtype), u)


@pytest.mark.statistical
@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("name", LAMPS)
def test_points_are_uniform_over_a_lamp(suite_seed, name, precision):
    """Faces by their areas, and 8 x 8 cells of each face's own coordinates."""
    scene, light = sampled(room((LAMPS[name], 1.0)), suite_seed, precision=precision)
    shape = scene.shapes[0]
    chances = shape.area() / shape.area().sum()
    faces = np.bincount(light.primitive, minlength=shape.primitives)
    assert chi_square(faces, N * chances) > sidak(4 * len(LAMPS))
    face = int(np.argmax(chances))
    q = light.q[:, light.primitive == face]
    a, b = scene.uv(q, np.full(q.shape[1], face))
    if name == "sphere":
        a, b = a, 0.5 - 0.5 * np.cos(np.pi * b)
    elif name == "tall box":  # barycentric coordinates of the second and third corner
        a, b = (a + b) ** 2, a / np.maximum(a + b, 1e-30)
    assert uniform(np.clip([a, b], 0, 1), 8) > sidak(4 * len(LAMPS))


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("name", LAMPS)
def test_points_lie_on_their_lamp(suite_seed, name, precision):
    scene, light = sampled(room((LAMPS[name], 1.0)), suite_seed, 2000, precision)
    eps = np.finfo(scene.dtype).eps
    assert np.abs(np.sqrt(dot(light.wi, light.wi)) - 1).max() < 4 * eps
    assert np.abs(np.sqrt(dot(light.nq, light.nq)) - 1).max() < 8 * eps
    if name == "sphere":
        out = light.q - scene.shapes[0].center[:, None]
        assert np.abs(np.sqrt(dot(out, out)) - 0.8).max() < 16 * eps
    else:
        n, c = scene.shapes[0].planes()
        off = (n[:, light.primitive] * light.q).sum(axis=0) - c[light.primitive]
        assert np.abs(off).max() < 32 * eps * max(1.0, np.abs(light.q).max())


@pytest.mark.statistical
def test_lamps_are_chosen_by_their_power_and_say_so(suite_seed):
    lamps = [(LAMPS["rectangle"], [1, 2, 3]), (LAMPS["sphere"], 0.5), (LAMPS["cube"], [4, 0, 0])]
    scene, light = sampled(room(*lamps), suite_seed)
    weights = np.array([0.212671, 0.715160, 0.072169])
    colours = np.array([[1, 2, 3], [0.5] * 3, [4, 0, 0]])
    power = colours @ weights * [shape.area().sum() for shape in scene.shapes]
    chance = power / power.sum()
    assert np.allclose(light.pick, chance[light.light])
    assert chi_square(np.bincount(light.light, minlength=3), N * chance) > sidak(1)


@pytest.mark.parametrize("name", LAMPS)
def test_the_density_per_solid_angle_is_that_per_area_seen_from_the_receiver(suite_seed, name):
    """pdf cos_light = pick pdf_area distance^2 where the lamp faces the receiver; elsewhere it is dark."""
    scene, light = sampled(room((LAMPS[name], [3, 2, 1]), (LAMPS["rectangle"], 0.7)), suite_seed)
    cos = -dot(light.nq, light.wi)
    area = np.array([shape.area().sum() for shape in scene.shapes])
    want = light.pick / area[light.light] * light.distance**2
    facing = cos > 0
    assert np.allclose((light.pdf * cos)[facing], want[facing], rtol=1e-12)
    assert not light.pdf[~facing].any() and not light.Le[:, ~facing].any()
    assert (light.Le[:, facing] > 0).all()


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("by", ["area", "solid_angle"])
@pytest.mark.parametrize("name", LAMPS)
def test_a_bounce_that_finds_a_lamp_names_the_density_of_the_light_sample(suite_seed, name, by, precision):
    """Both techniques see the same lamp: radiance and density agree along every direction."""
    scene, light = sampled(room((LAMPS[name], [3, 2, 1])), suite_seed, 4000, precision, by=by)
    facing = np.flatnonzero(light.pdf > 0)
    light = light.take(facing)
    o = np.repeat(np.array([[3.0], [40.0], [20.0]]), facing.size, axis=1).astype(scene.dtype)
    with np.errstate(all="ignore"):
        t, primitive = scene.intersect(o, light.wi, np.full(facing.size, -1))
        same = np.flatnonzero((primitive == light.primitive) & (-dot(light.nq, light.wi) > 0.1))
        hit = scene.hit(o[:, same], light.wi[:, same], t[same], primitive[same])
    assert same.size > 0.3 * facing.size
    assert (scene.shining(hit) == np.arange(same.size)).all()
    Le, pdf = scene.emission(hit, o[:, same], np.arange(same.size))
    assert np.array_equal(Le, light.Le[:, same])
    assert np.allclose(pdf, light.pdf[same], rtol={32: 3e-3, 64: 1e-10}[precision])


@pytest.mark.statistical
def test_a_root_in_the_choice_of_the_face_is_caught(suite_seed):
    """The broken twin, from a framework that thousands have used: sqrt(u) where u chooses among areas."""
    scene = room((LAMPS["tall box"], 1.0)).at(Settings(precision=64, light_sampling="area"))
    u = np.random.default_rng(suite_seed).random((3, N))
    light = scene.sample_light(np.full((3, N), 40.0), np.stack((np.sqrt(u[0]), u[1], u[2])))
    area = scene.shapes[0].area()
    faces = np.bincount(light.primitive, minlength=area.size)
    assert chi_square(faces, N * area / area.sum()) < sidak(4 * len(LAMPS))
