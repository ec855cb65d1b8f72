"""What fills a shape: the words for it, what is refused, which medium lies where, and Mitsuba's XML."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from glass import SIGMA_T, eye, filled, lamp_behind, slab
from meshes import icosphere

import tracer
from tracer import SceneWarning, Settings, TracerError
from tracer.shape import Cube, Mesh, Sphere, inside

CLEAR = {"type": "dielectric", "int_ior": 1.0, "ext_ior": 1.0}
EXACT = Settings(spp=1, max_depth=12, roulette="off", precision=64, jitter=False, width=1, height=1)


def ball(radius=1.0, center=(0, 0, 0), sigma_t=None, **more):
    """A ball of coloured or clear air, which bends nothing."""
    interior = {} if sigma_t is None else {"interior": filled(sigma_t)}
    return {"type": "sphere", "radius": radius, "center": list(center), "bsdf": CLEAR, **interior, **more}


def red(scene, settings=EXACT):
    """-log of the red light that reaches the camera from the lamp behind: the sum of sigma_t t."""
    return -np.log(float(tracer.render(scene, settings).rgb[0, 0, 0]))


# Shapes on the axis between the camera at z = 4 and the lamp at z = -3, and the sum of sigma_t t along it.
NESTED = {
    "a ball": ({"a": ball(1.0, sigma_t=0.3)}, 0.6),
    "two apart": ({"a": ball(1.0, (0, 0, 2), 0.3), "b": ball(0.5, (0, 0, -2), 0.7)}, 0.6 + 0.7),
    "one in another": ({"a": ball(1.5, sigma_t=0.3), "b": ball(1.0, sigma_t=0.7)}, 0.3 * 1 + 0.7 * 2),
    "said the other way round": ({"b": ball(1.0, sigma_t=0.7), "a": ball(1.5, sigma_t=0.3)}, 0.3 + 1.4),
    "a bubble": ({"a": ball(1.5, sigma_t=0.3), "b": ball(1.0)}, 0.3),
    "a bubble turned inside out": ({"a": ball(1.5, sigma_t=0.3), "b": ball(1.0, flip_normals=True)}, 0.3),
    "a ball in a bubble": (
        {"a": ball(1.5, sigma_t=0.3), "b": ball(1.0), "c": ball(0.5, sigma_t=0.7)},
        0.3 + 0.7,
    ),
    "three": ({"c": ball(0.5, sigma_t=2.0), "a": ball(1.5, sigma_t=0.3), "b": ball(1, sigma_t=0.7)}, 3.0),
    "in clear air": ({"a": ball(1.5), "b": ball(1.0, sigma_t=0.7)}, 1.4),
    "touching": ({"a": ball(1.5, sigma_t=0.3), "b": ball(1.0, (0, 0.5, 0))}, 0.3 * (3 - 2 * 0.75**0.5)),
    "around the camera": ({"a": ball(6.0, sigma_t=0.1)}, 0.7),
    "a bubble around the camera": ({"a": ball(9.0, sigma_t=0.1), "b": ball(1.0, (0, 0, 4))}, 0.6),
    "a cube": ({"a": slab(1.0, interior=filled(0.3), thick=1.0)}, 0.3),
    "a cube in a cube": (
        {
            "a": slab(1.0, interior=filled(0.3), thick=2),
            "b": slab(1.0, interior=filled(0.7), thick=1, wide=40),
        },
        0.3 + 0.7,
    ),
    "a pane in a ball": (
        {
            "a": ball(1.5, sigma_t=0.3),
            "b": {
                "type": "rectangle",
                "to_world": {"scale": 0.3},
                "bsdf": {**CLEAR, "type": "thindielectric"},
            },
        },
        0.9,
    ),
    "a thin shell, filled": (
        {"a": {**ball(1.5, sigma_t=0.3), "bsdf": {**CLEAR, "type": "thindielectric"}}},
        0.9,
    ),
}


@pytest.mark.parametrize("shapes", NESTED.values(), ids=NESTED)
def test_each_way_is_in_the_medium_that_lies_there(shapes):
    there, depth = shapes
    assert abs(red(lamp_behind(**there)) - depth) < 2e-6


def test_what_stands_in_coloured_glass_is_seen_through_half_of_it():
    """A white ball in a red one, and a lamp that shines on it there."""
    shapes = {"a": ball(1.5, sigma_t=0.3), "b": {"type": "sphere", "radius": 0.5}}
    scene = tracer.load_dict(
        {
            "sensor": eye(),
            **shapes,
            "bulb": {"type": "point", "position": [0, 0, 1.25], "intensity": 2.0},
        }
    )
    got = tracer.render(scene, Settings(spp=1, max_depth=4, precision=64, jitter=False)).rgb[0, 0, 0]
    assert np.isclose(got, 0.5 / np.pi * 2.0 / 0.75**2 * np.exp(-0.3 * (1.0 + 0.75)), rtol=1e-5)


def test_a_clear_shape_of_index_1_in_nothing_is_dropped_and_in_something_is_not():
    alone = lamp_behind(a=ball(0.5), b=ball(0.5, (0, 0, 2), 0.3))
    inside_it = lamp_behind(a=ball(0.5), b=ball(1.5, sigma_t=0.3))
    assert [shape.name for shape in alone.shapes] == ["lamp", "b"]
    assert [shape.name for shape in inside_it.shapes] == ["lamp", "a", "b"]


REFUSED = [
    ({"interior": filled(albedo=0.2)}, ("ball.interior.albedo", "0.2", "albedo = 0")),
    ({"interior": {"type": "homogeneous", "sigma_t": 1}}, ("ball.interior.albedo", "0.75", "albedo = 0")),
    ({"interior": filled(albedo=float("nan"))}, ("ball.interior.albedo", "nan")),
    ({"interior": filled(-1.0)}, ("ball.interior.sigma_t", "-1")),
    ({"interior": filled([1, 2])}, ("ball.interior.sigma_t", "three")),
    ({"interior": filled([1, 2, float("inf")])}, ("ball.interior.sigma_t", "inf")),
    ({"interior": filled(scale=-2)}, ("ball.interior.scale", "-2")),
    ({"interior": filled(1e10, scale=1e10)}, ("ball.interior.scale", "1e+20")),
    ({"interior": filled(colour=1)}, ("ball.interior.colour", "sigma_t")),
    ({"interior": {"type": "heterogeneous"}}, ("ball.interior.type", "heterogeneous", "homogeneous")),
    ({"interior": "amber"}, ("ball.interior", "amber", "table")),
    ({"exterior": filled()}, ("ball.exterior", "not supported")),
    ({"interior": filled(), "bsdf": {"type": "diffuse"}}, ("ball.interior", "dielectric")),
    ({"interior": filled(), "bsdf": {"type": "plastic"}}, ("ball.interior", "dielectric")),
    ({"interior": filled(), "flip_normals": True}, ("ball.interior", "flip_normals")),
    ({"interior": filled(), "type": "rectangle"}, ("ball.interior", "closed", "cube")),
]


@pytest.mark.parametrize(("words", "said"), REFUSED, ids=lambda value: str(value)[:60])
def test_what_cannot_fill_a_shape_is_refused_in_one_line(words, said):
    with pytest.raises(TracerError) as refused:
        lamp_behind(ball={"type": "sphere", "bsdf": CLEAR, **words})
    message = str(refused.value)
    assert "\n" not in message and not [word for word in said if word not in message], message


# --- meshes

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
BOX = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)


def obj(vertices, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    return "\n".join(lines + [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]) + "\n"


def mesh_scene(folder, vertices, faces, **words):
    """A mesh filled with red glass, before the lamp."""
    (folder / "box.obj").write_text(obj(vertices, faces), encoding="utf-8")
    box = {"type": "obj", "filename": "box.obj", "bsdf": CLEAR, "interior": filled(0.3), **words}
    description = lamp_behind(a=ball(sigma_t=0.3)).definition.source[0]
    return tracer.load_dict({**{k: description[k] for k in ("sensor", "lamp")}, "box": box}, folder=folder)


def test_a_mesh_is_filled_as_a_cube_is(tmp_path):
    turned = [{"rotate": [1, 2, 3], "angle": 40}]
    cube = lamp_behind(box={"type": "cube", "bsdf": CLEAR, "interior": filled(0.3), "to_world": turned})
    assert abs(red(mesh_scene(tmp_path, CORNERS, BOX, to_world=turned)) - red(cube)) < 1e-6


def test_a_mesh_whose_triangles_share_no_vertices_is_closed(tmp_path):
    """As files with flat normals and STL have it; moved, so that the copies are rounded apart."""
    steps = [{"scale": [0.7, 0.9, 1 / 3]}, {"rotate": [1, 2, 3], "angle": 40}, {"translate": [0.1, 0.1, 0.1]}]
    apart = CORNERS[BOX].reshape(-1, 3), np.arange(36).reshape(-1, 3)
    whole = red(mesh_scene(tmp_path, CORNERS, BOX, to_world=steps))
    assert abs(red(mesh_scene(tmp_path, *apart, to_world=steps)) - whole) < 1e-6


def test_an_open_mesh_and_one_wound_inwards_are_refused(tmp_path):
    with pytest.raises(TracerError, match=r"box\.interior.*closed"):
        mesh_scene(tmp_path, CORNERS, BOX[:-1])
    with pytest.raises(TracerError, match=r"box\.interior.*flip_normals"):
        mesh_scene(tmp_path, CORNERS, BOX[:, ::-1])
    assert abs(red(mesh_scene(tmp_path, CORNERS, BOX[:, ::-1], flip_normals=True)) - 0.6) < 1e-6


@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_shapes_know_which_points_they_hold(suite_seed, shift):
    """Ball, box, and meshes of both, against plain formulas."""
    p = np.random.default_rng(suite_seed).uniform(-1.5, 1.5, (3, 400))
    matrix = np.eye(4)
    matrix[:3, 3] = shift
    center = np.full(3, shift)
    in_box, in_ball = (np.abs(p) < 1).all(axis=0), np.linalg.norm(p, axis=0) < 1.2
    moved = p + shift
    assert np.array_equal(Cube("c", matrix).holds(moved), in_box)
    assert np.array_equal(Sphere("s", center, 1.2).holds(moved), in_ball)
    assert np.array_equal(Mesh("m", CORNERS + shift, BOX).holds(moved), in_box)
    vertices, faces = icosphere(2)
    held, size = Mesh("b", vertices + shift, faces).holds(moved), np.linalg.norm(p, axis=0)
    assert held[size < 0.95].all() and not held[size > 1.0].any()


def test_open_edges_are_counted():
    assert inside.open_edges(CORNERS, BOX) == 0
    assert inside.open_edges(CORNERS, BOX[:-1]) == 3
    assert inside.open_edges(CORNERS, np.concatenate((BOX, BOX[:1, ::-1]))) == 3
    assert np.isclose(inside.volume(CORNERS + 1e6, BOX), 8.0)
    assert np.isclose(inside.volume(CORNERS, BOX[:, ::-1]), -8.0)


# --- Mitsuba's XML


def test_coloured_glass_goes_out_for_the_integrator_that_sees_it(tmp_path):
    scene = lamp_behind(slab=slab(interior=filled(scale=2)), clear=ball(0.5, (0, 0, 2), 0.0))
    tracer.export(scene, tmp_path / "out.xml")
    root = ElementTree.parse(tmp_path / "out.xml").getroot()
    assert root.find("integrator").get("type") == "volpath"
    medium = root.find("shape[@id='slab']/medium")
    assert (medium.get("type"), medium.get("name")) == ("homogeneous", "interior")
    sigma_t = np.array(medium.find("rgb[@name='sigma_t']").get("value").split(), float)
    assert sigma_t.max() <= 1, "Mitsuba refuses colours above 1"
    scale = float(medium.find("float[@name='scale']").get("value"))
    assert (sigma_t * scale == 2 * np.array(SIGMA_T)).all()
    back = tracer.load(tmp_path / "out.xml")
    assert tracer.render(scene, EXACT).rgb.tobytes() == tracer.render(back, EXACT).rgb.tobytes()
    tracer.export(lamp_behind(ball=ball()), tmp_path / "clear.xml")
    assert ElementTree.parse(tmp_path / "clear.xml").find("integrator").get("type") == "path"


def test_a_medium_of_mitsuba_may_be_shared_and_say_how_it_scatters_nothing(tmp_path):
    tracer.export(lamp_behind(slab=slab(interior=filled())), tmp_path / "out.xml")
    text = (tmp_path / "out.xml").read_text(encoding="utf-8")
    (medium,) = re.findall(r"<medium.*?</medium>", text, re.DOTALL)
    shared = medium.replace('name="interior"', 'id="amber"').replace(
        "</medium>", '<phase type="hg"/><boolean name="sample_emitters" value="false"/></medium>'
    )
    text = text.replace(medium, '<ref id="amber" name="interior"/>').replace("</scene>", shared + "</scene>")
    (tmp_path / "shared.xml").write_text(text, encoding="utf-8")
    pictures = [tracer.render(tracer.load(tmp_path / f"{n}.xml"), EXACT).rgb for n in ("out", "shared")]
    assert pictures[0].tobytes() == pictures[1].tobytes()
    (tmp_path / "wrong.xml").write_text(text.replace('name="interior"', 'name="exterior"'), encoding="utf-8")
    with pytest.raises(TracerError, match=r"wrong\.xml: line \d+: slab\.exterior"):
        tracer.load(tmp_path / "wrong.xml")


@pytest.mark.parametrize("name", ["one in another", "a bubble", "around the camera"])
def test_what_mitsuba_has_to_be_told_is_said(tmp_path, name):
    scene = lamp_behind(**NESTED[name][0])
    with pytest.warns(SceneWarning, match="sensor" if "camera" in name else "^b .*exterior"):
        tracer.export(scene, tmp_path / "out.xml")
    back = tracer.load(tmp_path / "out.xml")
    assert tracer.render(scene, EXACT).rgb.tobytes() == tracer.render(back, EXACT).rgb.tobytes()
