"""A thin lens: sharp in one plane, blurred elsewhere by what geometry gives, and free when unused."""

import copy

import numpy as np
import pytest
from stats import chi_square, sidak

import tracer
from tracer import Settings, TracerError, sampler
from tracer.camera import Camera

EYE = {"look_at": {"origin": [1, 2, 8], "target": [1, 2, 0], "up": [0, 1, 0]}}
LAMP = {"scale": 0.02}, {"translate": [1, 2, 0]}
FOV, RADIUS, FOCUS, SIZE = 30.0, 0.5, 4.0, 64
SCENE = {
    "sensor": {
        "type": "thinlens",
        "fov": FOV,
        "aperture_radius": RADIUS,
        "focus_distance": FOCUS,
        "to_world": [EYE],
        "film": {"width": SIZE, "height": SIZE},
    },
    "lamp": {"type": "rectangle", "to_world": list(LAMP), "emitter": {"type": "area", "radiance": 1}},
}


def changed(**sensor):
    scene = copy.deepcopy(SCENE)
    scene["sensor"].update(sensor)
    return scene


def picture(seed, spp=256, half=0.02, **sensor):
    """What is seen directly; half: half the side of the lamp."""
    settings, scene = Settings(spp=spp, max_depth=1, seed=seed), changed(**sensor)
    scene["lamp"]["to_world"][0] = {"scale": half}
    return tracer.render(tracer.load_dict(scene), settings).rgb[:, :, 0]


def pinhole():
    """The same view without a lens."""
    scene = changed(type="perspective")
    del scene["sensor"]["aperture_radius"], scene["sensor"]["focus_distance"]
    return scene


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_rays_of_one_film_position_meet_in_the_plane_of_focus_where_the_pinhole_looks(dtype):
    camera = tracer.load_dict(SCENE).camera
    film = np.tile(np.array([[10.3], [50.9]], dtype), 1000)
    lens = np.random.default_rng(1).random((2, 1000)).astype(dtype)
    o, d = camera.rays(film, SIZE, SIZE, dtype, lens)
    hole = Camera(camera.origin, camera.target, camera.up_hint, camera.fov_x)
    o0, d0 = hole.rays(film, SIZE, SIZE, dtype)
    there = o + d * ((8 - FOCUS - o[2]) / d[2])
    expected = o0 + d0 * ((8 - FOCUS - o0[2]) / d0[2])
    assert np.allclose(there, expected, rtol=8 * np.finfo(dtype).eps, atol=0)
    assert np.allclose((d * d).sum(axis=0), 1, rtol=8 * np.finfo(dtype).eps)


@pytest.mark.statistical
def test_rays_start_evenly_over_the_aperture(suite_seed):
    camera = tracer.load_dict(SCENE).camera
    n = 100_000
    lens = np.random.default_rng(suite_seed).random((2, n))
    o, _ = camera.rays(np.full((2, n), 20.0), SIZE, SIZE, np.float64, lens)
    assert np.ptp(o[2]) == 0.0
    x, y = (o[0] - 1) / RADIUS, (o[1] - 2) / RADIUS
    cells = np.histogram2d(x * x + y * y, np.arctan2(y, x), bins=(10, 20), range=[(0, 1), (-np.pi, np.pi)])[0]
    assert cells.sum() == n
    assert chi_square(cells, np.full(cells.shape, n / cells.size)) > sidak(1)
    inner = np.linspace(1.06, 0.94, 10)[:, None] * np.full(cells.shape, n / cells.size)
    assert chi_square(cells, inner) < sidak(1)  # the broken twin: 6 % more in the middle than at the rim


@pytest.mark.statistical
def test_a_lamp_out_of_focus_is_a_disk_of_the_size_that_geometry_gives(suite_seed):
    """Seen from distance z through a lens of radius A focused at f, a point covers, in the plane of focus, a
    disk of radius A |z - f| / z."""
    blurred = picture(suite_seed)
    z = 8.0
    pixels = SIZE / (2 * FOCUS * np.tan(np.radians(FOV / 2)))  # a metre in the plane of focus
    radius = (RADIUS * (z - FOCUS) / z + 0.03 * FOCUS / z) * pixels
    y, x = np.nonzero(blurred)
    reach = np.hypot(x + 0.5 - SIZE / 2, y + 0.5 - SIZE / 2).max()
    assert radius - 1.5 < reach < radius + 1
    assert not radius - 1.5 < 1.2 * reach < radius + 1  # the broken twin


@pytest.mark.statistical
def test_blur_moves_light_and_loses_none(suite_seed):
    """The share of the picture that the lamp fills is the same through a lens; 4 standard errors."""
    n = SIZE * SIZE * 64
    share = picture(suite_seed, 64, half=0.4).mean(dtype="float64")
    expected = (0.8 / (2 * 8 * np.tan(np.radians(FOV / 2)))) ** 2
    assert abs(share - expected) < 4 * np.sqrt(expected / n)
    assert 4 * np.sqrt(expected / n) < 0.05 * expected
    assert abs(0.9 * share - expected) > 4 * np.sqrt(expected / n)  # the broken twin


def test_in_focus_a_lens_shows_what_a_pinhole_shows():
    sharp = picture(0, 16, focus_distance=8.0)
    hole = tracer.render(tracer.load_dict(pinhole()), Settings(spp=16, max_depth=1)).rgb[:, :, 0]
    assert (sharp > 0).sum() == (hole > 0).sum() and np.abs(sharp - hole).max() < 0.2


def test_a_path_through_the_lens_alone_is_the_path_in_company():
    scene, settings = tracer.load_dict(SCENE), Settings(width=16, height=16, spp=3, seed=5)
    whole = tracer.render(scene, settings).rgb
    for x, y in ((8, 8), (9, 7), (3, 14)):
        assert (tracer.inspect(scene, settings, x, y).value == whole[y, x]).all()


def test_a_pinhole_draws_no_numbers_for_a_lens(monkeypatch):
    uses = []
    draw = sampler.Independent.__call__
    monkeypatch.setattr(
        sampler.Independent, "__call__", lambda self, *key: uses.append(key[-1]) or draw(self, *key)
    )
    tracer.render(tracer.load_dict(pinhole()), Settings(spp=1))
    assert "lens" not in uses and "film" in uses
    tracer.render(tracer.load_dict(SCENE), Settings(spp=1))
    assert "lens" in uses


@pytest.mark.parametrize("word", ["aperture_radius", "focus_distance"])
@pytest.mark.parametrize("value", [0, -1, float("nan"), float("inf"), "wide", None])
def test_a_lens_that_is_none_is_refused(word, value):
    with pytest.raises(TracerError, match=f"sensor.{word}"):
        tracer.load_dict(changed(**{word: value}))


def test_a_pinhole_has_no_aperture_to_set():
    with pytest.raises(TracerError, match="aperture_radius"):
        tracer.load_dict(changed(type="perspective"))


def test_a_lens_goes_to_mitsuba_and_back(tmp_path):
    scene = tracer.load_dict(SCENE)
    tracer.export(scene, tmp_path / "lens.xml")
    back = tracer.load(tmp_path / "lens.xml")
    assert (back.camera.aperture_radius, back.camera.focus_distance) == (RADIUS, FOCUS)
    assert np.array_equal(
        *(tracer.render(s, Settings(spp=4, max_depth=1, width=16, height=16)).rgb for s in (scene, back))
    )
