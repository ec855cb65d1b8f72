"""Pictures of textured and of brushed surfaces: their means are those of the areas that are seen.

Comparisons allow 4 standard errors, which a right tracer exceeds once in 16 000.
"""

from dataclasses import replace

import checks
import numpy as np
import pytest
from cases import loaded
from stats import mean_and_error
from truth import entry, keys

import tracer
from lessons import zoo
from tracer import Settings
from tracer.integrator.steps import light_term

both = pytest.mark.parametrize("precision", [32, 64])
pytestmark = [pytest.mark.statistical, pytest.mark.slow]
BLACK_WHITE = {"type": "checkerboard", "color0": 1.0, "color1": 0.0}
SKY = {"type": "constant", "radiance": 1.0}


def camera(distance, fov=90.0, width=32, height=32):
    """A camera on the z axis that looks back at the origin."""
    look = {"origin": [0, 0, distance], "target": [0, 0, 0], "up": [0, 1, 0]}
    film = {"width": width, "height": height}
    return {"type": "perspective", "fov": fov, "to_world": [{"look_at": look}], "film": film}


def floor(to_uv, **more):
    """A square under an even sky, black and white, that fills the view: a pixel is its share of white."""
    paint = {"type": "diffuse", "reflectance": {**BLACK_WHITE, "to_uv": to_uv}}
    return tracer.load_dict(
        {"eye": camera(1.0, **more), "floor": {"type": "rectangle", "bsdf": paint}, "sky": SKY}
    )


def direct_light(seed, precision=32, spp=256, **options):
    """Bounces into the sky alone: no other noise than where in its pixel a sample lies."""
    return Settings(spp=spp, seed=seed, precision=precision, max_depth=2, strategy="bsdf", **options)


def share(periods):
    """Part of so many periods that lies in the first halves of them."""
    whole, rest = divmod(periods, 1.0)
    return (0.5 * whole + min(rest, 0.5)) / periods


def white(precision, seed, shift=0.0):
    """Mean and error of a floor with 2.5 by 1.5 periods, the tracer's board shifted; and what is right."""
    radiance = checks.samples(
        floor([{"scale": [2.5, 1.5, 1]}, {"translate": [shift, 0, 0]}]), direct_light(seed, precision)
    )
    assert set(np.unique(np.round(radiance, 6))) == {0.0, 1.0}
    a, b = share(2.5), share(1.5)
    return (*mean_and_error(radiance.reshape(3, 1, -1)), a * b + (1 - a) * (1 - b))


@both
def test_a_checkered_floor_is_as_bright_as_the_area_of_its_squares(suite_seed, precision):
    mean, error, wanted = white(precision, suite_seed)
    assert checks.off(mean, wanted, error, 1e-6) <= 1.0 and (error < 0.002).all()


def test_a_board_that_lies_a_tenth_of_a_period_off_is_caught(suite_seed):
    """The broken twin."""
    mean, error, wanted = white(32, suite_seed, shift=0.1)
    assert checks.off(mean, wanted, error, 1e-6) > 1.0


@both
@pytest.mark.parametrize("across", [0.3, 0.31])
def test_s64_a_pixel_with_the_edge_of_a_square_at_three_tenths(suite_seed, across, precision):
    """Five pixels in a row, one edge: all white, all black, and 0.3 within the binomial error. An edge at
    0.31 is caught: 50 000 samples know the place to 0.002."""
    edge = (2.0 + across) / 5.0  # in u; it goes to where the board turns black, a period is two views wide
    row = floor([{"scale": [0.5, 0, 1]}, {"translate": [0.5 - 0.5 * edge, 0, 0]}], width=5, height=1)
    samples = checks.samples(row, direct_light(suite_seed, precision, spp=50_000))
    shares = samples[0].mean(axis=1)
    assert np.abs(shares[[0, 1, 3, 4]] - [1, 1, 0, 0]).max() < 1e-6
    sigma = np.sqrt(0.3 * 0.7 / 50_000)
    assert (abs(shares[2] - 0.3) <= 4.0 * sigma) == (across == 0.3)


@both
@pytest.mark.parametrize("key", keys("pixel."))
@pytest.mark.parametrize("radius", [1.0, 1.02])
def test_s64_a_sphere_covers_the_pixels_of_its_disc(suite_seed, key, radius, precision):
    """pi a^2 over the area of the picture, a = R / sqrt(d^2 - R^2); a sphere 2 % larger (from a place as
    much further away in the near case) is caught."""
    given, area = entry(key)
    half = 0.2 if given["d"] > 2.0 else 80.0  # of the picture, at unit distance
    fov = float(np.degrees(2.0 * np.arctan(half)))
    shining = {"type": "sphere", "radius": radius, "emitter": {"type": "area", "radiance": 1.0}}
    d = given["d"] if given["d"] > 2.0 or radius == 1.0 else radius * (1.0 + 1.05e-4)
    scene = tracer.load_dict({"eye": camera(d, fov, 48, 48), "ball": shining})
    settings = Settings(spp=128, seed=suite_seed, precision=precision, max_depth=1)
    radiance = checks.samples(scene, settings).reshape(3, 1, -1)
    assert set(np.unique(radiance)) == {0.0, 1.0}
    mean, _ = mean_and_error(radiance)
    wanted = area / (4.0 * half * half)
    sigma = np.sqrt(wanted * (1.0 - wanted) / radiance[0].size)
    assert (abs(mean[0] - wanted) <= 4.0 * sigma) == (radius == 1.0)


def ball(reflectance):
    """A painted ball under an even sky."""
    paint = {"type": "diffuse", "reflectance": reflectance}
    return tracer.load_dict(
        {"eye": camera(4.0, 40.0, 16, 16), "ball": {"type": "sphere", "bsdf": paint}, "sky": SKY}
    )


@both
def test_a_textured_ball_in_a_furnace_shows_its_albedo_and_a_white_one_nothing(suite_seed, precision):
    """L = rho: whichever way the sky is found, and exactly where it is bounced into."""
    paint = {"type": "checkerboard", "color0": 0.25, "color1": 0.75, "to_uv": [{"scale": [8, 4, 1]}]}
    exact = checks.samples(ball(paint), direct_light(suite_seed, precision))
    assert set(np.unique(np.round(exact, 6))) == {0.25, 0.75, 1.0}
    mean, error = mean_and_error(exact)
    for integrator in ("direct", "path"):
        settings = Settings(
            spp=256, seed=suite_seed + 1, precision=precision, max_depth=2, integrator=integrator
        )
        other, spread = mean_and_error(checks.samples(ball(paint), settings))
        assert checks.off(other, mean, np.hypot(error, spread), 1e-5) <= 1.0 and (spread < 0.004).all()
    invisible = checks.samples(ball({**BLACK_WHITE, "color1": 1.0}), direct_light(suite_seed, precision, 16))
    assert np.abs(invisible - 1.0).max() < 1e-6


def brighter(*arguments):
    """A light term that is a tenth too bright."""
    return 1.1 * light_term(*arguments)


def test_light_that_is_a_tenth_too_bright_on_a_textured_ball_is_caught(suite_seed):
    """The broken twin."""
    paint = {"type": "checkerboard", "color0": 0.25, "color1": 0.75}
    mean, error = mean_and_error(checks.samples(ball(paint), direct_light(suite_seed)))
    settings = Settings(spp=256, seed=suite_seed + 1, max_depth=2, integrator="direct")
    wrong = mean_and_error(checks.samples(ball(paint), settings, replace(zoo.RIGHT, light_term=brighter)))
    assert checks.off(wrong[0], mean, np.hypot(error, wrong[1]), 1e-5) > 1.0


def brushed(turn, alpha_u, alpha_v, kind="roughconductor"):
    """A brushed square that a lamp to one side is mirrored in, turned about its normal."""
    return tracer.load_dict(
        {
            "eye": camera(3.0, 40.0, 12, 12),
            "plate": {
                "type": "rectangle",
                "to_world": [{"rotate": [0, 0, 1], "angle": turn}],
                "bsdf": {"type": kind, "alpha_u": alpha_u, "alpha_v": alpha_v},
            },
            "lamp": {
                "type": "rectangle",
                "to_world": [
                    {"scale": 0.7},
                    {"rotate": [0, 1, 0], "angle": 150},
                    {"translate": [-1.5, 0, 2.0]},
                ],
                "emitter": {"type": "area", "radiance": 3.0},
            },
        }
    )


def difference(one, other, seed, precision=32):
    """How far two scenes are apart in 3 x 3 blocks, in units of what is allowed."""
    settings = [Settings(spp=192, seed=seed + k, precision=precision, max_depth=3) for k in (0, 1)]
    found = [
        list(checks.blocks(checks.samples(scene, s), s.at_size_of(scene), 3))
        for scene, s in zip((one, other), settings, strict=True)
    ]
    return checks.agreement(*found)


@both
@pytest.mark.parametrize("kind", ["roughconductor", "roughdielectric"])
def test_a_quarter_turn_and_alphas_that_change_places_give_the_same_picture(suite_seed, kind, precision):
    scenes = brushed(0.0, 0.1, 0.4, kind), brushed(90.0, 0.4, 0.1, kind)
    assert difference(*scenes, suite_seed, precision) <= 1.0


def test_a_quarter_turn_alone_gives_another_picture(suite_seed):
    """The broken twin: a frame that does not follow the surface, and alphas a tenth off."""
    assert difference(brushed(0.0, 0.1, 0.4), brushed(90.0, 0.1, 0.4), suite_seed) > 1.0
    assert difference(brushed(0.0, 0.1, 0.4), brushed(90.0, 0.44, 0.11), suite_seed) > 1.0


def test_walk_direct_and_path_agree_on_the_scene_of_textures(suite_seed):
    """Nine blocks each; standard errors of the whole picture below 1.2 % of its mean, walk's the largest."""
    scene, found = loaded("textures"), {}
    for k, (integrator, spp) in enumerate({"walk": 2560, "direct": 512, "path": 512}.items()):
        settings = Settings(
            width=20, height=12, spp=spp, seed=suite_seed + k, integrator=integrator, max_depth=5
        )
        radiance = checks.samples(scene, settings)
        mean, error = mean_and_error(radiance)
        print(f"{integrator}: mean {mean}, relative standard error {error / mean}")
        assert (error < 0.012 * mean).all()
        found[integrator] = list(checks.blocks(radiance, settings, 3))
    for a, b in (("walk", "direct"), ("walk", "path"), ("direct", "path")):
        assert checks.agreement(found[a], found[b]) <= 1.0, (a, b)
