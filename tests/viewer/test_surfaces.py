"""What the 3D view draws of a scene: whole things, but for what lies flat on a wall."""

import numpy as np

import tracer
from viewer.surfaces import bounds, sight, surfaces, viewpoint


def lacking(name):
    """Shape -> how many of its triangles are not drawn."""
    scene = tracer.load(name)
    whole = {shape.name: len(shape.triangles()[1]) for shape in scene.shapes}
    return {s.name: whole[s.name] - len(s.faces) for s in surfaces(scene)}


def test_balls_in_the_open_are_drawn_whole():
    assert set(lacking("white_furnace").values()) == {0}


def test_balls_on_a_wide_floor_lose_no_more_than_where_they_stand():
    whole = len(tracer.load("sky").shapes[1].triangles()[1])
    assert all(0 < many < 0.05 * whole for name, many in lacking("sky").items() if name != "floor")


def test_boxes_on_the_floor_are_drawn_without_their_bottoms():
    missing = lacking("cornell_unit")
    assert missing["small_box"] == 2 and missing["floor"] == 0


def test_a_room_whose_walls_shine_is_as_dim_as_any_other_and_a_lamp_is_not():
    (room,) = surfaces(tracer.load("furnace"))
    assert not room.lamp and max(room.colour) < 0.7
    lamps = [s for s in surfaces(tracer.load("cornell_unit")) if s.lamp]
    assert [(s.name, max(s.colour)) for s in lamps] == [("lamp", 1.0)]


def test_one_looks_at_what_stands_on_wide_ground_and_at_a_whole_room():
    far = {}
    for name in ("sky", "cornell"):
        scene = tracer.load(name)
        view = viewpoint(scene, *sight(scene))
        away = np.linalg.norm(np.subtract(view["position"], view["focalPoint"]))
        far[name] = away / np.linalg.norm(np.subtract(*bounds(scene)))
    assert far["sky"] < 0.2 and far["cornell"] > 1.0
