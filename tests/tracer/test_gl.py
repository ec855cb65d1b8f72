"""The gl engine traces the paths that NumPy traces, and refuses by name what it cannot do."""

import re
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
import same_paths
import suite
from benchmarks.scenes import box_with
from cases import loaded
from meshes import icosphere
from suite import ROOT, castray, missing

import tracer
from lessons import zoo
from tracer import Settings, TracerError
from tracer.engine.gl import device, material_tables, source, tracing
from tracer.engine.gl.choice import faster
from tracer.integrator.steps import RIGHT
from tracer.light.envmap import Envmap
from tracer.scene import Scene
from tracer.scene_file.change import changed
from tracer.shape import Mesh
from tracer.testing import z_test

FLAT = ("cornell_unit", "furnace")  # nothing but flat diffuse surfaces
OTHERS = (  # all that come with castray but many_lights, whose shader takes seconds to be ready
    "cornell", "cornell_glass", "mirror_corridor", "glass_slab", "sky", "plates", "materials",
    "coloured_glass", "pool", "textures", "smooth_ball", "white_furnace",
)  # fmt: skip
ALPHA = 1e-4  # chance that one of the comparisons below fails though all is right


@pytest.fixture(scope="module")
def gl():
    """OpenGL, drawn by whomever."""
    return suite.gl()


def small(**options):
    return Settings(**{"width": 16, "height": 16, "spp": 32, "max_depth": 8, **options})


@pytest.fixture
def wrong(monkeypatch):
    """Makes a mistake in the shader: another text in place of one that must be there."""

    def plant(right, other):
        whole = source.text

        def text(name):
            return whole(name).replace(right, other)

        assert any(right in path.read_text(encoding="utf-8") for path in SHADERS)
        monkeypatch.setattr(source, "text", text)

    return plant


SHADERS = sorted((ROOT / "tracer" / "engine" / "gl" / "glsl").rglob("*.glsl"))


def compared(scene, seed):
    """The z-test of pictures by both engines, of different random numbers."""
    pictures = [
        tracer.render(loaded(scene), small(seed=seed + k), engine=engine)
        for k, engine in enumerate(("numpy", "gl"))
    ]
    return z_test(*pictures, alpha=ALPHA)


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("scene", FLAT + OTHERS)
def test_both_engines_give_the_same_picture(gl, suite_seed, scene):
    """Two right pictures fail once in 10,000 times, of each scene."""
    found = compared(scene, suite_seed)
    assert found.same, found.p_value


@pytest.mark.slow
@pytest.mark.parametrize(
    ("right", "other"),
    [
        ("#define INV_PI 0.318309886", "#define INV_PI 0.35"),
        ("visible = !occluded(hit, light)", "visible = true"),
    ],
    ids=["diffuse", "shadows"],
)
def test_a_wrong_shader_gives_another_picture(gl, suite_seed, wrong, right, other):
    wrong(right, other)
    assert not compared("cornell_unit", suite_seed).same


@pytest.mark.slow
@pytest.mark.parametrize("scene", (*FLAT, "cornell_glass", "textures", "smooth_ball"))
def test_nearly_all_paths_are_the_same_paths(gl, scene):
    found = same_paths.share(loaded(scene), Settings(width=32, height=32, spp=4))
    assert found >= 0.999


@pytest.mark.slow
def test_paths_that_go_elsewhere_are_not_the_same(gl, wrong):
    wrong("p = p - (dot(n, p) - s.plane.w) * n", "p = p - (dot(n, p) - s.plane.w + 0.001) * n")
    assert same_paths.share(loaded("cornell_unit"), Settings(width=16, height=16, spp=4)) < 0.5


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    [
        {"sampler": "lattice", "replicates": 2},
        {"integrator": "direct", "light_sampling": "area", "hemisphere": "uniform"},
        {"integrator": "walk", "roulette": "0.8"},
        # 15: with 16 pixel centres lie on edges of the room.
        {"heuristic": "balance", "roulette": "off", "max_depth": 4, "jitter": False, "width": 15},
        {"strategy": "light", "max_depth": 0},
    ],
    ids=lambda options: "-".join(map(str, options.values())),
)
def test_every_option_means_the_same(gl, options):
    settings = small(spp=4, **options)
    ours, theirs = (tracer.render(loaded("cornell_unit"), settings, engine=e) for e in ("gl", "numpy"))
    assert np.isclose(ours.rgb, theirs.rgb, rtol=1e-3, atol=1e-5).all(axis=2).mean() > 0.99
    assert np.array_equal(np.isnan(ours.variance), np.isnan(theirs.variance))
    assert abs(ours.rays - theirs.rays) <= 0.001 * theirs.rays
    assert (ours.engine, ours.dropped, ours.complete) == ("gl", 0, True)


def room(mesh):
    """A closed room, of rectangles or of triangles, under a bright sky that must not be seen."""
    description = {
        "type": "scene",
        "sensor": {"type": "perspective", "fov": 90, "to_world": [{"translate": [0.1, 0.05, 0.2]}]},
        "sky": {"type": "constant", "radiance": 1000.0},
        "grey": {"type": "diffuse", "reflectance": 0.9},
        "room": {
            "type": "cube",
            "flip_normals": True,
            "bsdf": "grey",
            "to_world": [{"scale": [1, 0.7, 1.3]}, {"rotate": [1, 2, 3], "angle": 40}],
        },
    }
    made = tracer.load_dict(description).definition
    if mesh:
        vertices, faces = icosphere(0)
        walls = made.surfaces[0]._replace(shape=Mesh("room", vertices, faces, flip_normals=True))
        made = made._replace(surfaces=(walls,), source=None)
    return Scene(made, np.float32)


@pytest.mark.slow
@pytest.mark.parametrize("mesh", [False, True], ids=["faces", "triangles"])
def test_no_path_leaves_a_closed_room(gl, mesh):
    settings = small(spp=64, max_depth=20, roulette="off", strategy="bsdf")
    picture = tracer.render(room(mesh), settings, engine="gl")
    assert picture.rays == 20 * picture.paths and not picture.rgb.any()


@pytest.mark.slow
def test_a_gap_between_faces_is_seen(gl, wrong):
    wrong("abs(x) <= quad.limits.x", "abs(x) <= 0.999 * quad.limits.x")
    assert tracer.render(room(False), small(spp=4, strategy="bsdf"), engine="gl").rgb.any()


def kinds_of_light(**more):
    """A floor, a ball and a leaf seen through a lens, with every kind of light that a shader knows."""
    placed = [{"rotate": [1, 0, 0], "angle": 90}, {"translate": [0, 1.2, 0]}]
    look = {"origin": [0.3, 0.4, 3.2], "target": [0, 0, 0], "up": [0, 1, 0]}
    area = {"type": "area", "radiance": [5, 4, 3]}
    return tracer.load_dict(
        {
            "type": "scene",
            "sensor": {
                "type": "thinlens",
                "fov": 60,
                "aperture_radius": 0.1,
                "focus_distance": 3.0,
                "to_world": [{"look_at": look}],
            },
            "sky": {"type": "constant", "radiance": [0.2, 0.2, 0.3]},
            "sun": {"type": "directional", "direction": [-0.3, -1, -0.2], "irradiance": [1, 1, 0.8]},
            "bulb": {"type": "point", "position": [0, 0.9, 0.5], "intensity": [3, 2, 1]},
            "grey": {"type": "diffuse", "reflectance": [0.6, 0.5, 0.4]},
            "leafy": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": [0.3, 0.6, 0.3]}},
            "floor": {
                "type": "rectangle",
                "to_world": [{"scale": 2}, {"rotate": [1, 0, 0], "angle": -90}, {"translate": [0, -1, 0]}],
                "bsdf": "grey",
            },
            "leaf": {
                "type": "rectangle",
                "to_world": [{"scale": 0.5}, {"translate": [-1, 0, 0]}],
                "bsdf": "leafy",
            },
            "ball": {"type": "sphere", "center": [0.6, -0.4, 0.2], "radius": 0.6, "bsdf": "grey"},
            "ceiling": {"type": "rectangle", "to_world": [{"scale": 2}, *placed], "bsdf": "grey"},
            "lamp": {
                "type": "rectangle",
                "to_world": [{"scale": 0.4}, *placed],
                "bsdf": "grey",
                "emitter": area,
            },
            "moon": {
                "type": "sphere",
                "center": [-1, 0.8, 0.5],
                "radius": 0.2,
                "bsdf": "grey",
                "emitter": area,
            },
            "die": {
                "type": "cube",
                "to_world": [
                    {"scale": 0.1},
                    {"rotate": [1, 1, 0], "angle": 33},
                    {"translate": [0.9, 0.8, 0.4]},
                ],
                "bsdf": "grey",
                "emitter": area,
            },
            **more,
        }
    )


@pytest.mark.slow
@pytest.mark.parametrize("light_sampling", ["solid_angle", "area"])
def test_every_kind_of_light_is_sampled_alike(gl, light_sampling):
    scene, settings = kinds_of_light(), small(spp=4, light_sampling=light_sampling)
    assert same_paths.share(scene, settings) >= 0.999
    ours, theirs = (tracer.render(scene, settings, engine=e) for e in ("gl", "numpy"))
    assert np.isclose(ours.rgb, theirs.rgb, rtol=1e-3, atol=1e-5).all(axis=2).mean() > 0.99


def with_a_lamp_on_the_floor():
    standing = {"to_world": [{"scale": 0.4}, {"translate": [0, -0.6, -1]}], "bsdf": "grey"}
    return kinds_of_light(stand={"type": "rectangle", "emitter": {"type": "area", "radiance": 1}, **standing})


def under_a_picture():
    """A scene lit by a picture of the sky."""
    made = loaded("sky").definition
    return Scene(made._replace(emitters=(Envmap("heaven", np.ones((4, 8, 3)), np.eye(3)),), source=None))


def with_many_triangles():
    return box_with(Mesh("ball", *icosphere(3)))


@pytest.mark.parametrize(
    ("scene", "options", "what"),
    [
        (under_a_picture, {}, "heaven, a light of kind envmap"),
        (with_many_triangles, {}, "1292 triangles, faces and spheres (up to 512)"),
        (with_a_lamp_on_the_floor, {}, "stand, a lamp that touches another shape"),
        (lambda: loaded("cornell_unit"), {"precision": 64}, "precision 64"),
    ],
    ids=["environment", "triangles", "touching", "precision"],
)
def test_what_it_cannot_do_is_refused_by_name(scene, options, what):
    with pytest.raises(TracerError, match=re.escape(what)) as error:
        tracer.render(scene(), small(**options), engine="gl")
    assert str(error.value).startswith("engine: gl cannot do ")


def test_a_replaced_step_is_refused_with_its_bug():
    with pytest.raises(TracerError, match="bug E01, which replaces emission_weight"):
        tracer.render(loaded("furnace"), small(bug="E01"), steps=zoo.steps("E01"), engine="gl")


def test_the_command_refuses_in_one_line_and_writes_nothing(tmp_path):
    done = castray("render", "cornell_unit", "--engine", "gl", "--bug", "E01", "-o", tmp_path / "a.png")
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    done = castray(
        "render", "furnace", "--engine", "gl", "--record", tmp_path / "r", "-o", tmp_path / "a.png"
    )
    assert done.returncode == 2 and "gl keeps no paths" in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.fixture
def afresh():
    """The context is asked for anew, here and afterwards."""
    device.device.cache_clear()
    yield
    device.device.cache_clear()


def test_without_moderngl_it_says_what_to_install(afresh, monkeypatch):
    monkeypatch.setattr(device, "find_spec", lambda name: None)
    with pytest.raises(TracerError, match="pip install moderngl"):
        tracer.render(loaded("furnace"), small(), engine="gl")


def test_without_a_driver_it_says_what_the_driver_lacks(afresh, monkeypatch):
    if find_spec("moderngl") is None:
        missing("moderngl")
    import moderngl

    def none(**_):
        raise RuntimeError("no display\nanywhere")

    monkeypatch.setattr(moderngl, "create_standalone_context", none)
    with pytest.raises(TracerError, match="a driver with OpenGL 4.3 .*: no display anywhere") as error:
        tracer.render(loaded("furnace"), small(), engine="gl")
    assert "\n" not in str(error.value)


def test_auto_takes_it_only_where_a_graphics_card_draws(gl, monkeypatch):
    scene, settings = loaded("cornell_unit"), small()
    monkeypatch.setattr("tracer.engine.gl.choice.renderer", lambda: "card")
    for hardware, taken in ((True, "gl"), (False, "numpy")):
        monkeypatch.setattr("tracer.engine.gl.choice.is_hardware", lambda here=hardware: here)
        assert faster(scene, settings, RIGHT)[0] == taken
    monkeypatch.setattr("tracer.engine.gl.choice.is_hardware", lambda: True)
    engine, why = faster(scene, replace(settings, precision=64), RIGHT)
    assert (engine, why) == ("numpy", "gl cannot do precision 64")


@pytest.mark.slow
def test_a_scene_that_differs_by_numbers_of_its_tables_is_not_compiled_again(gl):
    first, again, compiled = loaded("sky"), {}, tracing._compiled
    tracer.render(first, small(spp=1), engine="gl")
    before = compiled.cache_info().misses
    for changes in ({"day.radiance": [0.1, 0.2, 0.3]}, {"sun.irradiance": [1, 2, 3]}, {}):
        scene = changed(first, changes)
        for seed in (1, 2):
            again[str(changes), seed] = tracer.render(scene, small(spp=1, seed=seed), engine="gl").rgb
    assert compiled.cache_info().misses == before
    assert len({rgb.tobytes() for rgb in again.values()}) == len(again)
    compiled.cache_clear()
    assert np.array_equal(tracer.render(scene, small(spp=1, seed=2), engine="gl").rgb, again["{}", 2])


def test_what_pictures_took_of_the_card_does_not_pile_up(gl):
    left = []
    for seed in range(4):
        tracer.render(loaded("cornell_unit"), small(spp=1, seed=seed), engine="gl")
        left.append(len(gl.objects))  # of the last one, which the next one frees
    assert left[1] == left[3] > 0


def test_each_material_stands_beside_its_twin_in_the_same_order():
    for kind in material_tables.KINDS:
        twin = (ROOT / "tracer" / "bsdf" / f"{kind.lower()}.py").read_text(encoding="utf-8")
        shader = source.text(f"bsdf/{kind.lower()}")
        for text, pattern in (
            (twin, r"def (eval|pdf|sample)\("),
            (shader, rf" {kind.lower()}_(eval|pdf|sample)\(Material"),
        ):
            assert list(dict.fromkeys(re.findall(pattern, text))) == ["eval", "pdf", "sample"]
