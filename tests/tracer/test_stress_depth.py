"""Stress cases S51, S52 and S55: very long paths, rooms that lose nothing, and what a depth counts.

In a closed room whose walls send Le and reflect the share rho, light reflected up to k - 1 times is
Le (1 - rho^k) / (1 - rho), and k Le where rho is 1. That is max_depth = k.
"""

import tracemalloc

import checks
import numpy as np
import pytest
from cases import loaded, slow_but
from truth import entry, keys

import tracer
from lessons import zoo
from tracer import Settings
from tracer.engine import waves

both = pytest.mark.parametrize("precision", [32, 64])
pytestmark = pytest.mark.filterwarnings("error")


def furnace(rho, Le=1.0, side=2):
    """A closed room that shines, of albedo rho."""
    view = {"origin": [0.3, 0.1, 0.5], "target": [0, 0, -1], "up": [0, 1, 0]}
    film = {"width": side, "height": side}
    room = {
        "type": "cube",
        "flip_normals": True,
        "bsdf": {"type": "diffuse", "reflectance": rho},
        "emitter": {"type": "area", "radiance": Le},
    }
    sensor = {"type": "perspective", "fov": 60, "to_world": [{"look_at": view}], "film": film}
    return tracer.load_dict({"sensor": sensor, "room": room})


def bounces_only(precision, depth, **options):
    return Settings(precision=precision, max_depth=depth, integrator="walk", roulette="off", **options)


@pytest.mark.slow
@both
def test_s51_ten_thousand_bounces(precision):
    """rho itself, as the precision has it, is what float32 is off by: 1e4 times a rounding."""
    picture = tracer.render(furnace(0.999), bounces_only(precision, 10_000, spp=1))
    truth = (1.0 - 0.999**10_000) / (1.0 - 0.999)
    assert truth == pytest.approx(999.9548, abs=1e-4)
    assert np.abs(picture.rgb / truth - 1.0).max() < {32: 1e-4, 64: 1e-7}[precision]
    assert picture.rays == 4 * 10_000 and picture.dropped == 0


def most_memory(depth):
    """Largest number of bytes that a wave of paths of this depth takes at once."""
    settings = bounces_only(32, depth, width=64, height=64, spp=1)
    scene = loaded("furnace").at(settings)
    (task,) = waves.tasks(settings)
    tracemalloc.start()
    try:
        waves.trace(scene, settings, zoo.RIGHT, task)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.slow
def test_s51_the_length_of_paths_takes_no_memory():
    most_memory(2)
    short, long = most_memory(4), most_memory(100)
    assert long < 1.1 * short  # Python keeps some freed tuples for later


@pytest.mark.slow
@both
def test_s52_a_room_that_loses_nothing_brightens_by_one_with_every_bounce(precision):
    """Whole numbers, exactly."""
    for depth in (1, 2, 10, 100, 1000):
        picture = tracer.render(furnace(1.0), bounces_only(precision, depth, spp=1, width=1, height=1))
        assert (picture.rgb == depth).all() and picture.dropped == 0


@pytest.mark.slow
@both
@pytest.mark.parametrize("integrator", ["direct", "path"])
def test_s52_white_walls_and_one_lamp_end_at_their_depth(precision, integrator):
    """A closed room with rho = 1 and one lamp: its paths go on to the last vertex and no further."""
    lamp = {
        "type": "cube",
        "to_world": [{"scale": 0.2}, {"translate": [-0.4, 0.5, -0.2]}],
        "bsdf": {"type": "diffuse", "reflectance": 1.0},
        "emitter": {"type": "area", "radiance": 1.0},
    }
    room = furnace(1.0, 0.0).definition.source[0] | {"lamp": lamp}
    scene = tracer.load_dict(room)
    settings = Settings(spp=1, precision=precision, max_depth=1000, integrator=integrator, roulette="off")
    picture = tracer.render(scene, settings)
    assert picture.dropped == 0 and np.isfinite(picture.rgb).all() and (picture.rgb > 0.0).all()
    assert 4 * 1000 <= picture.rays <= 4 * 2000  # every path has 1000 vertices, and no more light samples


WAYS = (
    {"integrator": "walk"},
    {"integrator": "direct"},
    {"integrator": "path"},
    {"integrator": "path", "strategy": "light"},
    {"integrator": "path", "strategy": "bsdf"},
)
PARTIAL = [key for key in keys("furnace.diffuse.") if "bounces=" in key]


@pytest.mark.statistical
@both
@pytest.mark.parametrize("key", slow_but(PARTIAL, *PARTIAL[::2]))
def test_s55_the_table_of_partial_sums(suite_seed, key, precision):
    """4 standard errors, with light samples and without (see test_furnace for what that means)."""
    p, value = entry(key)
    room, depth = furnace(p["rho"], p["Le"], side=8), p["max_scatter"] + 1
    assert (1.0 - p["rho"] ** depth) / (1.0 - p["rho"]) == pytest.approx(value)
    for way in WAYS:
        settings = Settings(spp=64, max_depth=depth, precision=precision, seed=suite_seed, **way)
        assert checks.furnace(settings, scene=room, Le=p["Le"], rho=p["rho"]) <= 1.0, way


@pytest.mark.statistical
@both
@pytest.mark.parametrize("depth", [0, 1, 2, 3, 8])
def test_s55_every_way_counts_depth_alike(suite_seed, depth, precision):
    for way in WAYS:
        settings = Settings(
            width=8, height=8, spp=64, max_depth=depth, precision=precision, seed=suite_seed, **way
        )
        assert checks.furnace(settings) <= 1.0, way
    if depth <= 1:  # nothing, and the lamp itself: the same to the last bit
        pictures = [
            tracer.render(
                loaded("cornell_unit"),
                Settings(width=8, height=8, spp=4, max_depth=depth, precision=precision, **way),
            )
            for way in WAYS
        ]
        assert len({p.rgb.tobytes() for p in pictures}) == 1


@pytest.mark.statistical
def test_s55_a_loop_that_counts_one_too_many_is_caught(suite_seed):
    """The broken twin, at the depth where one bounce adds least."""
    settings = Settings(width=8, height=8, spp=64, max_depth=8, seed=suite_seed)
    longer = Settings(**settings.as_dict() | {"max_depth": 9})
    room = furnace(0.8, 1.0, side=8)
    assert checks.furnace(settings, scene=room, rho=0.8) <= 1.0
    truth = (1.0 - 0.8**8) / (1.0 - 0.8)
    mean = checks.samples(room, longer).mean()
    assert abs(mean / truth - 1.0) > 0.02 and checks.furnace(longer, scene=room, rho=0.8) <= 1.0
