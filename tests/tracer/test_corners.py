"""A path never leaves a closed room through an edge or a corner, nor meets a wall it starts on."""

import numpy as np
import pytest
import trimesh
from continuation import careless
from suite import suite_seed

import tracer
from tracer.engine import waves
from tracer.integrator.wave import Wave

WHITE = {"type": "diffuse", "reflectance": 1.0}
FAR = [{"rotate": [1, 2, 3], "angle": 33.0}, {"translate": [1483.0, 12.0, -2234.0]}]
NEAR = FAR[:1]
SETTINGS = tracer.Settings(
    width=64, height=64, spp=4, max_depth=30, roulette="off", integrator="walk", seed=suite_seed()
)
TURNS = (
    ([1, 0, 0], -90, [0, -1, 0]),
    ([1, 0, 0], 90, [0, 1, 0]),
    ([0, 1, 0], 0, [0, 0, -1]),
    ([0, 1, 0], 90, [-1, 0, 0]),
    ([0, 1, 0], 180, [0, 0, 1]),
    ([0, 1, 0], 270, [1, 0, 0]),
)


def room(kind, place, folder):
    """A closed white room of one kind of shape, and a camera in it."""
    middle = np.array(place[-1].get("translate", [0.0, 0.0, 0.0]))
    view = {"origin": list(middle + 0.1), "target": list(middle + [0.2, 0.3, -1.0]), "up": [0, 1, 0]}
    scene = {"camera": {"type": "perspective", "fov": 90, "to_world": [{"look_at": view}]}}
    if kind == "rectangles":
        for k, (axis, angle, at) in enumerate(TURNS):
            steps = [{"rotate": axis, "angle": angle}, {"translate": at}, *place]
            scene[f"wall{k}"] = {"type": "rectangle", "to_world": steps, "bsdf": WHITE}
    elif kind == "cube":
        scene["room"] = {"type": "cube", "flip_normals": True, "to_world": place, "bsdf": WHITE}
    else:
        box = trimesh.creation.box((2, 2, 2))
        box.invert()
        box.export(folder / "box.ply")
        scene["room"] = {"type": "ply", "filename": "box.ply", "to_world": place, "bsdf": WHITE}
    return tracer.load_dict(scene, folder=folder)


def ends(scene, settings):
    """How many paths ended for each reason."""
    counts = {}
    for task in waves.tasks(settings):
        pixel = np.repeat(task.numbers, task.samples)
        sample = np.tile(np.arange(task.samples), task.numbers.size)
        wave = Wave(pixel % settings.width, pixel // settings.width, sample, settings)
        for event in waves.events(scene, settings, wave):
            if event.kind.name == "end":
                for reason in event.columns["reason"].tolist():
                    name = event.kind.field("reason").choices[reason]
                    counts[name] = counts.get(name, 0) + 1
    return counts


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["rectangles", "cube", "mesh"])
@pytest.mark.parametrize("place", [NEAR, FAR], ids=["near", "far"])
@pytest.mark.parametrize("precision", [32, 64])
def test_half_a_million_segments_stay_in_a_closed_room_s08(kind, place, precision, tmp_path):
    settings = tracer.Settings(**SETTINGS.as_dict() | {"precision": precision})
    assert ends(room(kind, place, tmp_path), settings) == {"max_depth": 64 * 64 * 4}


@pytest.mark.parametrize("kind", ["rectangles", "mesh"])
def test_without_knowing_where_a_ray_starts_it_would_leave(kind, tmp_path, monkeypatch):
    """The broken twin: no start is moved, and kernels do not know the other faces."""
    scene = room(kind, FAR, tmp_path).at(SETTINGS)
    careless(scene, monkeypatch)
    assert ends(scene, SETTINGS) != {"max_depth": 64 * 64 * 4}


def test_a_room_that_shines_inwards_is_dark_from_outside():
    """A light sample on the inner side of its far wall is hidden by the near one."""
    view = {"origin": [0, 3, 6], "target": [0, 0, 0], "up": [0, 1, 0]}
    scene = {
        "camera": {"type": "perspective", "fov": 60, "to_world": [{"look_at": view}]},
        "floor": {
            "type": "rectangle",
            "to_world": [{"scale": 9.0}, {"rotate": [1, 0, 0], "angle": -90}, {"translate": [0, -2, 0]}],
            "bsdf": WHITE,
        },
        "room": {
            "type": "cube",
            "flip_normals": True,
            "bsdf": WHITE,
            "emitter": {"type": "area", "radiance": 1.0},
        },
    }
    picture = tracer.render(tracer.load_dict(scene), tracer.Settings(width=48, height=48, spp=16))
    assert (picture.rgb == 0.0).all()


def box_on_the_floor():
    """A white cube and a mirror cube that stand on a lit floor, seen from above."""
    view = {"origin": [0, 2, 3], "target": [0, 0.2, 0], "up": [0, 1, 0]}
    return tracer.load_dict(
        {
            "camera": {"type": "perspective", "fov": 40, "to_world": [{"look_at": view}]},
            "floor": {"type": "rectangle", "to_world": [{"rotate": [1, 0, 0], "angle": -90}], "bsdf": WHITE},
            "box": {
                "type": "cube",
                "to_world": [{"scale": 0.3}, {"rotate": [0, 1, 0], "angle": 20}, {"translate": [0, 0.3, 0]}],
                "bsdf": WHITE,
            },
        }
    ).at(SETTINGS)


def test_a_ray_from_the_foot_of_a_box_stands_outside_it():
    scene = box_on_the_floor()
    rng = np.random.default_rng(suite_seed())
    n = 20_000
    turn = np.radians(20.0)
    side = np.array([np.cos(turn), 0.0, -np.sin(turn)])  # outward normal of one face
    along = np.array([np.sin(turn), 0.0, np.cos(turn)])
    p = (0.3 * side[:, None] + along[:, None] * rng.uniform(-0.25, 0.25, n)).astype(np.float32)
    p = np.nextafter(p, rng.choice([-np.inf, np.inf], p.shape)).astype(np.float32)
    p[1] = 0.0
    d = rng.normal(size=(3, n))
    d[1] = np.abs(d[1])
    d = (d / np.linalg.norm(d, axis=0)).astype(np.float32)
    floor = np.zeros(n, np.int32)
    with np.errstate(all="ignore"):
        hit = scene.hit(p + d, -d, np.ones(n, np.float32), floor)
        t, primitive = scene.intersect(scene.spawn(hit, d), d, floor)
    away = side @ d
    clear = np.abs(away) > 1e-3
    assert (primitive[clear & (away > 0)] == -1).all()
    assert (scene.shape_of[primitive[clear & (away < 0)]] == 1).all()
    assert (np.abs(t * away)[clear & (away < 0)] < 1e-5).all()
