"""The gl engine traces the paths that NumPy traces, and refuses by name what it cannot do."""

import re
from functools import partial

import numpy as np
import pytest
import same_paths
import shaders
import suite
from cases import loaded
from meshes import icosphere
from shaders import compared, kinds_of_light, small
from suite import ROOT

import tracer
from tracer import Settings
from tracer.engine.gl import material_tables, source, tracing
from tracer.scene import Scene
from tracer.scene_file.change import changed
from tracer.shape import Mesh

FLAT = ("cornell_unit", "furnace")  # nothing but flat diffuse surfaces
OTHERS = (  # all that come with castray but many_lights, whose shader takes seconds to be ready
    "cornell", "cornell_glass", "mirror_corridor", "glass_slab", "sky", "plates", "materials",
    "coloured_glass", "pool", "textures", "smooth_ball", "white_furnace",
)  # fmt: skip


@pytest.fixture(scope="module")
def gl():
    """OpenGL, drawn by whomever."""
    return suite.gl()


@pytest.fixture
def wrong(monkeypatch):
    """Makes a mistake in the shader."""
    return partial(shaders.plant, monkeypatch)


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("scene", FLAT + OTHERS)
def test_both_engines_give_the_same_picture(gl, suite_seed, scene):
    """Two right pictures fail once in 10,000 times, of each scene."""
    found = compared(loaded(scene), suite_seed)
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
    assert not compared(loaded("cornell_unit"), suite_seed).same


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


@pytest.mark.slow
@pytest.mark.parametrize("light_sampling", ["solid_angle", "area"])
def test_every_kind_of_light_is_sampled_alike(gl, light_sampling):
    scene, settings = kinds_of_light(), small(spp=4, light_sampling=light_sampling)
    assert same_paths.share(scene, settings) >= 0.999
    ours, theirs = (tracer.render(scene, settings, engine=e) for e in ("gl", "numpy"))
    assert np.isclose(ours.rgb, theirs.rgb, rtol=1e-3, atol=1e-5).all(axis=2).mean() > 0.99


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "changes"),
    [
        ("sky", [{}, {"day.radiance": [0.1, 0.2, 0.3]}, {"sun.irradiance": [1, 2, 3]}]),
        ("cornell_unit", [{"lamp.scale": 0.5}, {"lamp.scale": 1.5}]),
        ("mirror_corridor", [{"lamp.radius": 0.1}, {"lamp.radius": 0.2}]),
    ],
)
def test_a_scene_that_differs_by_numbers_is_not_compiled_again(gl, scene, changes):
    made, compiled = {}, tracing._compiled
    for said in changes:
        for more in ({}, {"seed": 1}, {"max_depth": 3}, {"roulette": "0.5"}, {"roulette": "0.9"}):
            settings, turned = small(**{"spp": 1, "roulette": "0.7", **more}), changed(loaded(scene), said)
            picture = tracer.render(turned, settings, engine="gl")
            made[str((said, more))] = picture.rgb, turned, settings
            if len(made) == 1:
                before = compiled.cache_info().misses
    assert compiled.cache_info().misses == before
    assert len({rgb.tobytes() for rgb, *_ in made.values()}) == len(made)
    compiled.cache_clear()
    assert np.array_equal(tracer.render(turned, settings, engine="gl").rgb, picture.rgb)
    for rgb, *asked in made.values():
        assert np.isclose(rgb, tracer.render(*asked).rgb, rtol=1e-3, atol=1e-5).all(axis=2).mean() > 0.95


def test_what_pictures_took_of_the_card_does_not_pile_up(gl):
    left = []
    for seed in range(4):
        tracer.render(loaded("cornell_unit"), small(spp=1, seed=seed), engine="gl")
        left.append(len(gl.objects))  # of the last one, which the next one frees
    assert left[1] == left[3] > 0


def test_each_material_stands_beside_its_twin_in_the_same_order():
    """A twin leaves out what it has from others, as the smooth ones their Dirac lobe's eval and pdf."""
    for kind in material_tables.KINDS:
        twin = (ROOT / "tracer" / "bsdf" / f"{kind.lower()}.py").read_text(encoding="utf-8")
        shader = source.text(f"bsdf/{kind.lower()}")
        own = list(dict.fromkeys(re.findall(r"def (eval|pdf|sample)\(", twin)))
        order = list(dict.fromkeys(re.findall(rf" {kind.lower()}_(eval|pdf|sample)\(Material", shader)))
        assert order == ["eval", "pdf", "sample"]
        assert "sample" in own and own == [name for name in order if name in own]
