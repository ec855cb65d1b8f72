"""Meshes of many triangles in the gl engine: the same tree, the same hits."""

import copy

import numpy as np
import pytest
import same_paths
import shaders
import suite
from benchmarks.scenes import ball, box
from meshes import icosphere
from shaders import blob, small, under_the_sky

import tracer
from tracer import Settings
from tracer.scene import Scene
from tracer.shape import Mesh


@pytest.fixture(scope="module", autouse=True)
def gl():
    """OpenGL, drawn by whomever."""
    return suite.gl()


def box_with_balls():
    """The unit box with two meshes of 5120 triangles: a lamp, and a painted ball with smooth normals."""
    paint = {"type": "checkerboard", "color0": 0.4, "color1": [0.9, 0.7, 0.5], "to_uv": [{"scale": 5}]}
    room = copy.deepcopy(box().definition.source[0])
    room["painted"] = {"type": "diffuse", "reflectance": paint}
    room["small_box"]["bsdf"] = "painted"
    room["tall_box"]["emitter"] = {"type": "area", "radiance": [0.5, 0.4, 0.3]}
    vertices, faces = icosphere(4)
    meshes = {
        "tall_box": ball(4),
        "small_box": Mesh("smooth", 0.3 * vertices + [0.335, -0.6, 0.38], faces, normals=vertices),
    }
    made = tracer.load_dict(room).definition
    surfaces = [s._replace(shape=meshes.get(s.shape.name, s.shape)) for s in made.surfaces]
    return Scene(made._replace(surfaces=tuple(surfaces), source=None), np.float32)


@pytest.mark.slow
def test_nearly_all_paths_among_large_meshes_are_the_same_paths():
    assert same_paths.share(box_with_balls(), Settings(width=32, height=32, spp=4)) >= 0.999


@pytest.mark.slow
@pytest.mark.statistical
def test_both_engines_give_the_same_picture_of_a_large_mesh(suite_seed):
    """Two right pictures fail once in 10,000 times."""
    found = shaders.compared(blob(), suite_seed)
    assert found.same, found.p_value


@pytest.mark.slow
def test_a_walk_that_leaves_out_children_gives_another_picture(monkeypatch, suite_seed):
    shaders.plant(monkeypatch, "waiting[step] >>= 4", "waiting[step] >>= 12")
    assert not shaders.compared(blob(), suite_seed).same


def sheet(side):
    """A square of so many squares a side, each two triangles, seen so that rays of pixels' centres pass their
    corners."""
    y, x = (v.ravel() for v in np.indices((side + 1, side + 1)))
    vertices = np.column_stack((2.0 * x / side - 1.0, 2.0 * y / side - 1.0, np.ones(x.size)))
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    far = corner + side + 2
    faces = [np.column_stack((corner, corner + 1, far)), np.column_stack((corner, far, far - 1))]
    return under_the_sky(vertices, np.concatenate(faces))


def met_alike(scene):
    """Share of the rays through pixels' centres that meet the same triangle first by NumPy and by gl."""
    settings = Settings(width=15, height=15, spp=1, jitter=False, max_depth=1)
    met = [of(scene, settings)[0][:, 0, 0] for of in (same_paths.of_numpy, same_paths.of_gl)]
    assert all((numbers >= 0).all() for numbers in met)
    return (met[0] == met[1]).mean()


@pytest.mark.slow
def test_of_triangles_at_the_same_distance_the_one_of_the_lowest_number_is_met():
    """Not all: the rays are the same but for rounding, so that some pass beside a corner."""
    assert met_alike(sheet(30)) > 0.9


@pytest.mark.slow
def test_another_order_of_equals_is_noticed(monkeypatch):
    shaders.plant(monkeypatch, "primitive < best.primitive", "primitive > best.primitive")
    assert met_alike(sheet(30)) < 0.7


def hall():
    """A closed room of 1280 triangles under a sky that must not be seen."""
    return under_the_sky(*icosphere(3), flip_normals=True)


CLOSED = {"spp": 64, "max_depth": 20, "roulette": "off", "strategy": "bsdf"}


@pytest.mark.slow
def test_no_path_leaves_a_closed_room_of_many_triangles():
    picture = tracer.render(hall(), small(**CLOSED), engine="gl")
    assert picture.rays == 20 * picture.paths and not picture.rgb.any()


@pytest.mark.slow
def test_boxes_that_are_too_small_let_light_in(monkeypatch):
    shaders.plant(monkeypatch, "#define SLACK (8.0 * EPS)", "#define SLACK (-1e-3)")
    assert tracer.render(hall(), small(**CLOSED), engine="gl").rgb.any()
