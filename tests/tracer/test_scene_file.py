"""Scenes in Mitsuba's words: what they mean, and mistakes explained with place, word and what would do."""

import copy

import numpy as np
import pytest

import tracer
from tracer import Settings, TracerError, built_in_scenes

SENSOR = {
    "type": "perspective",
    "fov": 40.0,
    "to_world": [{"look_at": {"origin": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}],
    "film": {"width": 8, "height": 6},
}
ROOM = {
    "type": "scene",
    "sensor": SENSOR,
    "white": {"type": "diffuse", "reflectance": [0.8, 0.7, 0.6]},
    "lamp": {
        "type": "rectangle",
        "bsdf": "white",
        "emitter": {"type": "area", "radiance": [1, 2, 3]},
    },
    "ball": {"type": "sphere", "center": [0, 0, 1], "radius": 0.5, "bsdf": "white"},
}


def changed(path, value):
    """ROOM with one value put in, or taken out if it is None; path: names joined by dots."""
    room = copy.deepcopy(ROOM)
    *above, last = path.split(".")
    table = room
    for name in above:
        table = table[name] if isinstance(table, dict) else table[int(name)]
    if value is None:
        del table[last]
    else:
        table[last] = value
    return room


BAD = [
    ("lamp.type", "rectangel", ("lamp", "rectangel", "rectangle")),
    ("lamp.type", None, ("lamp", "type")),
    ("lamp.bsdf", "wite", ("lamp", "wite", "white")),
    ("lamp.colour", 1, ("lamp.colour", "unknown")),
    ("lamp.flip_normals", "yes", ("lamp.flip_normals", "yes")),
    ("lamp.emitter.type", "spot", ("lamp.emitter", "spot", "area")),
    ("lamp.emitter.radiance", [1, -1, 1], ("lamp.emitter.radiance", "-1")),
    ("lamp.emitter.radiance", [1, float("nan"), 1], ("lamp.emitter.radiance", "nan")),
    ("lamp.emitter.radiance", [1, float("inf"), 1], ("lamp.emitter.radiance", "inf")),
    ("lamp.emitter.radiance", [1, 1], ("lamp.emitter.radiance", "three")),
    ("lamp.emitter.radiance", "bright", ("lamp.emitter.radiance", "bright")),
    ("lamp.emitter.radiance", None, ("lamp.emitter.radiance", "missing")),
    ("white.reflectance", 1.5, ("white.reflectance", "1.5")),
    ("white.reflectance", True, ("white.reflectance", "True")),
    ("white.reflectence", 0.5, ("white.reflectence", "reflectance")),
    ("white.type", "glossy", ("white", "glossy", "diffuse")),
    ("ball.radius", 0, ("ball", "radius")),
    ("ball.radius", -1, ("ball.radius", "-1")),
    ("ball.center", [0, 0], ("ball.center", "three")),
    ("ball.to_world", [{"scale": [1, 2, 1]}], ("ball.to_world", "stretch")),
    ("lamp.to_world", [{"scale": 0}], ("lamp.to_world", "0")),
    ("lamp.to_world", [{"scale": float("nan")}], ("lamp.to_world", "nan")),
    ("lamp.to_world", [{"shear": 1}], ("lamp.to_world", "rotate")),
    ("lamp.to_world", [{"rotate": [0, 0, 0], "angle": 3}], ("lamp.to_world", "axis")),
    ("lamp.to_world", [{"rotate": [0, 0, 1]}], ("lamp.to_world", "angle")),
    ("sensor.fov", 0, ("sensor.fov", "180")),
    ("sensor.fov", 180, ("sensor.fov", "180")),
    ("sensor.fov", None, ("sensor.fov", "missing")),
    ("sensor.film.width", 0, ("sensor.film.width", "0")),
    ("sensor.film.width", 2.5, ("sensor.film.width", "2.5")),
    ("sensor.to_world.0.look_at.target", [0, 0, 4], ("sensor.to_world", "look_at")),
    ("sensor.to_world.0.look_at.up", [0, 0, 1], ("sensor.to_world", "up")),
    ("sensor", None, ("sensor",)),
    ("other", {"type": "perspective", "fov": 40}, ("one sensor",)),
    ("type", "room", ("type", "scene")),
    ("thing", 3, ("thing", "3")),
]


@pytest.mark.parametrize(("path", "value", "said"), BAD)
def test_a_mistake_is_named_with_its_place(path, value, said):
    with pytest.raises(TracerError) as refused:
        tracer.load_dict(changed(path, value))
    message = str(refused.value)
    assert "\n" not in message
    assert not [word for word in said if word not in message], message


def test_a_room_without_shapes_is_refused():
    with pytest.raises(TracerError, match="shapes"):
        tracer.load_dict({"sensor": SENSOR})


def test_the_room_that_these_mistakes_spoil_is_good_itself():
    scene = tracer.load_dict(ROOM, "room")
    assert (scene.name, scene.width, scene.height, scene.light_names) == ("room", 8, 6, ("lamp",))
    assert np.isfinite(tracer.render(scene, Settings(spp=2)).rgb).all()


@pytest.mark.parametrize("name", built_in_scenes())
def test_every_scene_that_comes_along_can_be_read_and_shows_light(name):
    assert name in built_in_scenes()
    picture = tracer.render(tracer.load(name), Settings(width=16, height=16, spp=4))
    assert np.isfinite(picture.rgb).all() and picture.rgb.mean() > 0.1 and picture.dropped == 0


def test_transforms_are_applied_in_the_order_of_the_list():
    """A point at (1, 0, 0), doubled, turned a quarter to +y, then moved: each step after the one before."""
    steps = [{"scale": 2}, {"rotate": [0, 0, 1], "angle": 90}, {"translate": [0, 0, 5]}]
    room = changed("lamp.to_world", steps)
    matrix = tracer.load_dict(room).shapes[0].to_world
    assert np.array_equal(matrix @ [1, 0, 0, 1], [0, 2, 5, 1])


def test_a_matrix_and_its_steps_mean_the_same():
    steps = [{"scale": [1, 2, 3]}, {"rotate": [1, 1, 0], "angle": 25}, {"translate": [4, 5, 6]}]
    matrix = tracer.load_dict(changed("lamp.to_world", steps)).shapes[0].to_world
    for spelled in (matrix.tolist(), [{"matrix": matrix.tolist()}]):
        assert np.array_equal(tracer.load_dict(changed("lamp.to_world", spelled)).shapes[0].to_world, matrix)


@pytest.mark.parametrize("spelled", [0.5, [0.5, 0.5, 0.5], {"type": "rgb", "value": 0.5}])
def test_a_colour_may_be_spelled_in_three_ways(spelled):
    scene = tracer.load_dict(changed("white.reflectance", spelled))
    assert np.array_equal(scene.display_colour(0), [0.5] * 3)


def test_the_picture_shows_x_to_the_right_and_y_downwards():
    """A lamp to the right of the axis and above it lights the upper right pixels only."""
    room = changed("lamp.to_world", [{"scale": 0.2}, {"translate": [0.9, 0.6, 0]}])
    del room["ball"]
    rgb = tracer.render(tracer.load_dict(room), Settings(width=32, height=24, spp=4, max_depth=1)).rgb
    y, x = np.nonzero(rgb[:, :, 0])
    assert x.min() > 16 and y.max() < 12 and x.size


def test_the_field_of_view_is_the_horizontal_one():
    """A square of half width w at distance 4 spans w / (4 tan(fov / 2)) of half the picture."""
    room = changed("lamp.to_world", [{"scale": 0.5}])
    del room["ball"]
    settings = Settings(width=200, height=150, spp=1, max_depth=1, jitter=False)
    lit = np.count_nonzero(tracer.render(tracer.load_dict(room), settings).rgb[75, :, 0])
    assert abs(lit - 200 * 0.5 / (4 * np.tan(np.radians(20)))) <= 1


def test_a_lamp_shines_on_one_side_and_flip_normals_turns_it():
    def brightness(**more):
        room = copy.deepcopy(ROOM)
        del room["ball"]
        room["lamp"].update(more)
        return tracer.render(
            tracer.load_dict(room), Settings(width=8, height=6, spp=1, max_depth=1)
        ).rgb.max()

    assert brightness() == 3.0
    assert brightness(flip_normals=True) == 0.0
    assert brightness(to_world=[{"rotate": [0, 1, 0], "angle": 180}]) == 0.0
    assert brightness(to_world=[{"rotate": [0, 1, 0], "angle": 180}], flip_normals=True) == 3.0


@pytest.mark.parametrize("scale", [[2, 3, 4], [-2, 3, 4], [2, -3, -4]])
@pytest.mark.parametrize("shape", ["cube", "ball"])
def test_normals_point_outwards_after_any_transform(tmp_path, scale, shape):
    """Each face has the middle of the shape behind it: a reflection does not turn it inside out."""
    turn = {"rotate": [1, 2, 3], "angle": 40}
    if shape == "ball":
        from meshes import icosphere

        vertices, faces = icosphere(1)
        lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in faces + 1]
        (tmp_path / "ball.obj").write_text("\n".join(lines), encoding="utf-8")
        thing = {"type": "obj", "filename": "ball.obj", "to_world": [{"scale": scale}, turn]}
    else:
        thing = {"type": "cube", "to_world": [{"scale": scale}, turn]}
    scene = tracer.load_dict({"sensor": SENSOR, "thing": thing}, folder=tmp_path)
    n, c = scene.shapes[0].planes()
    assert np.allclose((n * n).sum(axis=0), 1)
    assert (c > 0).all(), "n . 0 < c: the origin is behind every face"
