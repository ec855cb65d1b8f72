"""Light in coloured glass: closed forms, the three loops, and any strength of absorption.

Statistical comparisons allow 4 standard errors and 1e-5 for single precision.
"""

import warnings

import checks
import numpy as np
import pytest
from cases import INTEGRATORS
from glass import ROUGH, SIGMA_T, SMOOTH, THICK, eye, filled, lamp_behind, lit_inside, slab, slab_shares
from stats import mean_and_error
from truth import close, entry, keys

import tracer
from lessons import zoo
from tracer import Settings
from tracer.bsdf import fresnel
from tracer.events import HIT

DEEP = {"max_depth": 24, "roulette": "off"}  # what is left out by then is below 1e-12
both = pytest.mark.parametrize("precision", [32, 64])


def off(scene, truth, steps=zoo.RIGHT, **options):
    """How far a scene's picture is from the truth, in units of what is allowed."""
    mean, error = mean_and_error(checks.samples(scene, Settings(**DEEP | options), steps))
    return checks.off(mean, truth, error, 1e-5 * np.asarray(truth) + 1e-9)


def left(thick=THICK):
    return np.exp(-thick * np.array(SIGMA_T))


@pytest.mark.parametrize("key", [k for k in keys("slab.T.scalar.", "slab.R.scalar.")])
def test_the_series_without_absorption_is_that_of_clear_glass(key):
    """The closed form that the tests below rest on, at a = 1, against the table of exact values."""
    p, value = entry(key)
    rs, rp, _ = fresnel.dielectric(np.cos(np.radians([p["theta_deg"]])), np.array([p["n"]]))
    crossings = 2 * p["terms"] - 1 if "terms" in p else np.inf
    got = slab_shares(0.5 * (rs + rp), np.ones(1), crossings)[key.startswith("slab.R")]
    assert close(got[0], value)


def test_the_closed_form_is_its_series():
    for got, want in zip(slab_shares(0.3, left(), 200), slab_shares(0.3, left()), strict=True):
        assert np.allclose(got, want, rtol=1e-13)


@pytest.mark.statistical
@both
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_slab_lets_through_what_the_series_says(suite_seed, integrator, precision):
    scene, truth = lamp_behind(slab=slab(interior=filled())), slab_shares(0.04, left())[0]
    assert off(scene, truth, spp=4000, seed=suite_seed, integrator=integrator, precision=precision) <= 1.0


@pytest.mark.statistical
@pytest.mark.parametrize("depth", [2, 3, 4, 5])
def test_a_slab_at_every_length_of_paths(suite_seed, depth):
    """A path of max_depth k has crossed the slab at most k - 2 times."""
    scene, truth = lamp_behind(slab=slab(interior=filled())), slab_shares(0.04, left(), depth - 2)[0]
    assert off(scene, truth, spp=4000, seed=suite_seed, max_depth=depth) <= 1.0


@pytest.mark.statistical
def test_a_slab_reflects_what_the_series_says(suite_seed):
    """The lamp is behind the camera, large, and all else is black."""
    lamp = {
        "type": "rectangle",
        "to_world": [{"scale": 60}, {"rotate": [1, 0, 0], "angle": 180}, {"translate": [0, 0, 5]}],
        "emitter": {"type": "area", "radiance": 1.0},
    }
    scene = tracer.load_dict({"sensor": eye(), "slab": slab(interior=filled()), "lamp": lamp})
    assert off(scene, slab_shares(0.04, left())[1], spp=8000, seed=suite_seed) <= 1.0


@pytest.mark.statistical
@pytest.mark.parametrize("angle", [45.0, 80.0])
def test_a_slab_seen_aslant_absorbs_along_the_refracted_way(suite_seed, angle):
    """theta: a = exp(-sigma_t d / cos_t)."""
    theta = np.radians(angle)
    origin = (4 * np.sin(theta), 0, 4 * np.cos(theta))
    scene = lamp_behind(slab=slab(interior=filled()), sensor=eye(origin))
    rs, rp, cos_t = fresnel.dielectric(np.cos([theta]), np.array([1.5]))
    truth = slab_shares(0.5 * (rs + rp), left(THICK / cos_t))[0]
    assert off(scene, truth, spp=8000, seed=suite_seed, max_depth=60) <= 1.0


@pytest.mark.statistical
def test_a_slab_of_three_percent_less_colour_is_caught(suite_seed):
    """The broken twin: the smallest fault that the comparison of slabs claims to see."""
    scene = lamp_behind(slab=slab(interior=filled(scale=0.97)))
    assert off(scene, slab_shares(0.04, left())[0], spp=4000, seed=suite_seed) > 1.0


@pytest.mark.statistical
@both
def test_a_ball_under_an_even_sky(suite_seed, precision):
    """Radiance along a ray at the distance b from the middle: R + (1 - R)^2 a / (1 - R a), a over the chord.

    All ways inside a ball are chords of one length, and R is the same at both ends, so with s = (1 - R)^2
    the light is R + s a + s a (R a) + ... The pixel is a square of rays within the ball's disc, taken by a
    product rule of 40 x 40 Gauss-Legendre points.
    """
    far, edge = 5.0, 0.66
    ball = {"type": "sphere", "bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1}}
    fov = 2 * np.degrees(np.arctan(edge / far))
    scene = tracer.load_dict(
        {
            "sensor": eye((0, 0, far), fov=fov),
            "ball": {**ball, "interior": filled()},
            "sky": {"type": "constant", "radiance": 1.0},
        }
    )
    x, weight = np.polynomial.legendre.leggauss(40)
    square = (edge * x[:, None]) ** 2 + (edge * x) ** 2
    b = (far * np.sqrt(square / (square + far * far))).ravel()  # from the middle of the ball to the ray
    rs, rp, cos_t = fresnel.dielectric(np.sqrt(1 - b * b), np.full(b.size, 1.5))
    R, a = 0.5 * (rs + rp), np.exp(-2 * cos_t * np.array(SIGMA_T)[:, None])
    truth = ((R + (1 - R) ** 2 * a / (1 - R * a)) * np.outer(weight, weight).ravel() / 4).sum(axis=1)
    assert off(scene, truth, spp=6000, seed=suite_seed, precision=precision) <= 1.0
    short = ((R + (1 - R) ** 2 * a**0.95 / (1 - R * a)) * np.outer(weight, weight).ravel() / 4).sum(axis=1)
    assert off(scene, short, spp=6000, seed=suite_seed, precision=precision) > 1.0  # the broken twin


COLOURED_AIR = {"type": "dielectric", "int_ior": 1.0, "ext_ior": 1.0}


@both
@pytest.mark.parametrize("integrator", ["direct", "path"])
def test_a_lamp_a_wall_and_the_camera_in_coloured_air(integrator, precision):
    """Exact: (albedo / pi) I cos / r^2 of a point lamp, times exp(-sigma_t (r + t)), t the way to the camera.

    Coloured air has no surface that anybody sees; it is kept for what is inside.
    """
    wall = {"type": "rectangle", "to_world": [{"scale": 9}], "bsdf": {"type": "diffuse", "reflectance": 0.6}}
    air = {"type": "sphere", "radius": 30.0, "bsdf": COLOURED_AIR, "interior": filled((0.1, 0.7, 3.0))}
    bulb = {"type": "point", "position": [1.0, 0, 2.0], "intensity": 5.0}
    scene = tracer.load_dict({"sensor": eye((0, 0, 1.5), fov=1e-4), "wall": wall, "air": air, "bulb": bulb})
    settings = Settings(spp=1, max_depth=2, precision=precision, integrator=integrator, jitter=False)
    r = np.sqrt(5.0)
    truth = 0.6 / np.pi * 5.0 * (2.0 / r) / 5.0 * np.exp(-np.array([0.1, 0.7, 3.0]) * (r + 1.5))
    got = tracer.render(scene, settings).rgb[0, 0]
    assert np.allclose(got, truth, rtol=2e-6)  # a picture is in single precision


@pytest.mark.statistical
def test_air_of_index_1_neither_reflects_nor_bends(suite_seed):
    scene = lamp_behind(slab=slab(index=1.0, interior=filled()), sensor=eye((2, 0, 4), (0, 0, 0)))
    way = THICK * np.hypot(2, 4) / 4
    record = tracer.inspect(scene, Settings(spp=8, max_depth=4, jitter=False, precision=64), 0, 0)
    for path in record.paths:
        assert len([e for e in path.events if e.kind is HIT]) == 3
        assert np.allclose(path.radiance, left(way), rtol=1e-12)


def forgets_the_way_from_the_lamp(scene, hit, u):
    """A light sample that thinks it is made on the lamp itself: the shadow ray loses nothing."""
    light = zoo.RIGHT.light_point(scene, hit, u)
    return light._replace(distance=np.zeros_like(light.distance))


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("material", [SMOOTH, ROUGH], ids=["smooth", "rough"])
def test_the_loops_agree_on_what_is_lit_inside_glass(suite_seed, material):
    """At the ball, and at the face of rough glass, the light sample goes through the inside."""
    scene, found = lit_inside(material), {}
    for k, (integrator, spp) in enumerate((("walk", 128), ("direct", 64), ("path", 64))):
        settings = Settings(spp=spp, integrator=integrator, seed=suite_seed + k, max_depth=6)
        found[integrator] = checks.samples(scene, settings)
    for a, b in (("walk", "path"), ("direct", "path"), ("walk", "direct")):
        assert checks.agreement([found[a]], [found[b]]) <= 1.0, (a, b)
    wrong = zoo.changed(light_point=forgets_the_way_from_the_lamp)
    twin = checks.samples(scene, Settings(spp=64, integrator="direct", seed=suite_seed, max_depth=6), wrong)
    assert checks.agreement([twin], [found["walk"]]) > 1.0


@both
@pytest.mark.parametrize("nothing", [filled(0.0), filled([0, 0, 0.0]), filled(scale=0.0)])
def test_glass_filled_with_nothing_is_clear_glass_to_the_last_bit(suite_seed, nothing, precision):
    settings = Settings(spp=8, seed=suite_seed, precision=precision)
    pictures = []
    for interior in (None, nothing):
        scene = lamp_behind(slab=slab(interior=interior), sensor=eye(fov=20, size=(8, 8)))
        pictures.append(tracer.render(scene, settings).rgb)
        assert scene.media is None
    assert pictures[0].tobytes() == pictures[1].tobytes()


@both
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(
    ("sigma_t", "scale"), [(1e15, 1.0), (1.0, 1e15), (1e4, 1.0), (1e-30, 1.0), (1e-300, 1)]
)
def test_any_strength_gives_numbers(suite_seed, sigma_t, scale, integrator, precision):
    """Black glass ends its paths; what is too weak to see changes nothing."""
    scene = lamp_behind(slab=slab(interior=filled([sigma_t] * 3, scale=scale)))
    settings = Settings(spp=64, seed=suite_seed, integrator=integrator, precision=precision, max_depth=40)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        picture = tracer.render(scene, settings)
        record = tracer.inspect(scene, settings, 0, 0)
    assert np.isfinite(picture.rgb).all() and picture.dropped == 0
    assert (picture.rgb == 0).all() if sigma_t * scale > 1 else (picture.rgb > 0.5).all()
    if sigma_t * scale > 1:
        assert {path.end for path in record.paths} <= {"absorbed", "escaped"}
        assert max(len(path.events) for path in record.paths) <= 6
