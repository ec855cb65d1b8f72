"""Stress cases S01 and S02: scenes of any size, and scenes far from the origin.

Pictures with the same seed take the same numbers, so they are far closer than their errors; where pictures of
different seeds are compared, tracer.testing's z-test decides at 1 % a test.
"""

import dataclasses

import numpy as np
import pytest
from cases import loaded, placed, slow_but
from stats import z_limit
from suite import castray

import tracer
from lessons import zoo
from tracer import Settings, TracerError
from tracer.testing import z_test

SCALES = (1e-6, 1e-3, 1.0, 1e3, 1e6, 1e8)
POWERS = (2.0**-20, 2.0**-10, 2.0**-1, 2.0**10, 2.0**20, 2.0**26)
FAR = [1e7, -1e7, 1e7]
SMALL = Settings(width=24, height=24, spp=16, max_depth=8)
scenes = pytest.mark.parametrize(
    "name", slow_but(("cornell_unit", "cornell_glass", "smooth_ball", "many_lights"), "cornell_unit")
)
both = pytest.mark.parametrize("precision", [32, 64])

pytestmark = pytest.mark.filterwarnings("error")


def scaled(name, scale, precision, seed, steps=zoo.RIGHT):
    settings = dataclasses.replace(SMALL, precision=precision, seed=seed)
    return tracer.render(placed(name, {"scale": scale}), settings, steps=steps)


def worst_z(a, b):
    """Largest difference of two pictures of one seed in standard errors, beyond what rounding explains."""
    difference = np.abs(a.rgb - b.rgb) - 1e-5 * b.rgb
    return float((difference / np.sqrt(a.variance + b.variance + 1e-30)).max())


@both
@scenes
def test_s01_a_scene_of_any_size_is_the_same_picture(suite_seed, name, precision):
    one = scaled(name, 1.0, precision, suite_seed)
    for scale in SCALES:
        picture = scaled(name, scale, precision, suite_seed)
        assert picture.dropped == 0 and np.isfinite(picture.rgb).all() and (picture.rgb >= 0).all()
        assert worst_z(picture, one) < z_limit(len(SCALES) * one.rgb.size), scale
        assert np.abs(picture.rgb - one.rgb).mean() < 1e-5 * one.rgb.mean(), scale


@both
@scenes
def test_s01_a_power_of_two_changes_no_bit(suite_seed, name, precision):
    """In both precisions: no length has a threshold. In float32 at a millionth, though, what a ray misses the
    middle of a sphere by can be so little that its square underflows."""
    one = scaled(name, 1.0, precision, suite_seed)
    for scale in POWERS if precision == 64 else POWERS[1:]:
        picture = scaled(name, scale, precision, suite_seed)
        assert picture.rgb.tobytes() == one.rgb.tobytes() and picture.rays == one.rays, scale


def a_hair_off(scene, hit, wi):
    """Where many tracers start their rays: a fixed 1e-4 off the surface."""
    return hit.p + np.copysign(hit.p.dtype.type(1e-4), (hit.ng * wi).sum(axis=0)) * hit.ng, wi


def test_s01_a_fixed_distance_from_the_surface_is_caught(suite_seed):
    """The broken twin: right for a room of two metres, and in one of two micrometres it leaves the room."""
    wrong = zoo.changed(next_ray=a_hair_off)
    one, tiny = (scaled("cornell_unit", scale, 32, suite_seed, wrong) for scale in (1.0, 1e-6))
    right = scaled("cornell_unit", 1.0, 32, suite_seed)
    assert worst_z(one, right) < z_limit(one.rgb.size) < worst_z(tiny, one)


@pytest.mark.slow
@pytest.mark.statistical
def test_s02_double_precision_shows_a_scene_ten_thousand_kilometres_away(suite_seed):
    far = placed("cornell_unit", {"translate": FAR})
    picture, same = (
        tracer.render(
            scene, Settings(width=48, height=48, spp=64, precision=64, max_depth=8, seed=suite_seed)
        )
        for scene in (far, loaded("cornell_unit"))
    )
    other = tracer.render(loaded("cornell_unit"), dataclasses.replace(same.settings, seed=suite_seed + 1))
    assert z_test(picture, other).same
    brighter = dataclasses.replace(picture, rgb=1.05 * picture.rgb)  # the broken twin
    assert not z_test(brighter, other).same
    assert picture.rays == same.rays and np.abs(picture.rgb - same.rgb).mean() < 1e-7 * same.rgb.mean()


def test_s02_no_path_leaves_a_closed_room_there(suite_seed):
    """Every bounce brings the same in the furnace: a path that escaped would lack what is left."""
    far, settings = (
        placed("furnace", {"translate": FAR}),
        Settings(
            width=32,
            height=32,
            spp=4,
            precision=64,
            integrator="walk",
            roulette="off",
            max_depth=12,
            seed=suite_seed,
        ),
    )
    truth = 2.0 * (1.0 - 0.5**12)
    assert np.abs(tracer.render(far, settings).rgb / truth - 1.0).max() < 1e-6


def refused(far, settings):
    for use in (lambda: tracer.render(far, settings), lambda: tracer.inspect(far, settings, 0, 0)):
        with pytest.raises(
            TracerError, match="across.*from the origin.*single precision.*precision 64"
        ) as error:
            use()
        assert "\n" not in str(error.value)


@pytest.mark.slow
def test_s02_single_precision_refuses_it_in_one_line(tmp_path):
    far = placed("cornell_unit", {"translate": FAR})
    refused(far, SMALL)
    tracer.export(far, tmp_path / "far.xml")
    refused(tracer.load(tmp_path / "far.xml"), SMALL)
    words = (tmp_path / "far.xml", "--spp", "1", "--size", "8", "6")
    for command in (("render",), ("inspect", "--pixel", "3", "3"), ("view", "--no-browser")):
        done = castray(command[0], *words, *command[1:], cwd=tmp_path)
        assert (done.returncode, done.stdout) == (2, "") and done.stderr.count("\n") == 1
        assert "precision 64" in done.stderr
    done = castray("render", *words, "-o", "far.npy", "--precision", "64", cwd=tmp_path)
    assert done.returncode == 0 and np.load(tmp_path / "far.npy").mean() > 0.1


@both
@pytest.mark.parametrize(
    ("far", "held"),
    [
        ([{"translate": [1000, 0, 0]}], {32, 64}),
        ([{"translate": [1100, 0, 0]}], {64}),
        ([{"scale": 1e-4}, {"translate": [0.1, 0, 0]}], {32, 64}),
        ([{"scale": 1e-4}, {"translate": [1, 0, 0]}], {64}),
        ([{"scale": 1e5}, {"translate": [0, 0, 1e8]}], {32, 64}),
        ([{"translate": [0, 0, 1e8]}], {64}),
        ([{"scale": 1e-8}, {"translate": [0, 0, 1e8]}], set()),
    ],
    ids=str,
)
def test_s02_what_counts_is_how_far_a_scene_is_for_its_size(far, held, precision):
    scene = placed("cornell_unit", *far)
    settings = dataclasses.replace(SMALL, spp=1, precision=precision)
    if precision in held:
        assert tracer.render(scene, settings).dropped == 0
        return
    named = {32: "single precision.*precision 64", 64: "double precision"}[precision]
    with pytest.raises(TracerError, match=f"lamp: is .* across.*{named}"):
        tracer.render(scene, settings)


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize(("away", "right"), [(1000.0, True), (4000.0, False)])
def test_s02_what_single_precision_takes_is_right_and_what_it_refuses_would_not_be(suite_seed, away, right):
    """A quarter of a million paths on either side of the limit, against double precision at the origin."""
    scene, settings = (
        placed("cornell_unit", {"translate": [away, -away, away]}),
        Settings(64, 64, 64, suite_seed),
    )
    if not right:
        refused(scene, settings)
        scene._refusal = None  # what would come of it
    home = dataclasses.replace(settings, precision=64, seed=suite_seed + 1)
    assert z_test(tracer.render(scene, settings), tracer.render(loaded("cornell_unit"), home)).same == right
