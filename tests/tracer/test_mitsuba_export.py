"""What goes out as Mitsuba's XML comes back the same."""

import errno
import os
import re

import numpy as np
import pytest
from cases import slow_but
from mitsuba_room import DICT, same
from suite import castray

import tracer
from tracer import Settings, TracerError


@pytest.mark.parametrize("name", slow_but(tracer.built_in_scenes(), "coloured_glass", "sky", "textures"))
def test_every_scene_goes_out_and_comes_back_the_same(tmp_path, name):
    scene = tracer.load(name)
    tracer.export(scene, tmp_path / f"{name}.xml")
    back = tracer.load(tmp_path / f"{name}.xml")
    assert (back.name, back.width, back.height) == (scene.name, scene.width, scene.height)
    assert back.light_names == scene.light_names
    assert same(scene, back, Settings(width=16, height=16, spp=4, seed=3))


EVERY_SPELLING = {
    "type": "scene",
    "eye": {**DICT["sensor"], "fov_axis": "y", "film": {}},
    "lamp": {
        "type": "rectangle",
        "to_world": {"scale": [1.0, 2, 0.1 + 0.2]},
        "emitter": {"type": "area", "radiance": 1 / 3},
    },
    "room": {
        "type": "cube",
        "flip_normals": True,
        "to_world": np.diag([4.0, 5.0, 6.0, 1.0]),
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.1, 0.2, 0.3]}},
    },
    "glass": {"type": "dielectric", "int_ior": "water", "ext_ior": 1.0},
    "ball": {
        "type": "sphere",
        "bsdf": {"type": "ref", "id": "glass"},
        "to_world": [{"translate": [0, 0, 2]}],
    },
    "card": {"type": "twosided", "inside": {"type": "roughplastic", "alpha": 0.2, "nonlinear": True}},
    "gold": {"type": "conductor", "eta": [0.2, 0.4, 1.5], "k": (3, 2, 2)},
    "sheet": {"type": "rectangle", "bsdf": "card", "to_world": {"translate": [-1, 0, 1]}},
    "picture": {
        "type": "bitmap",
        "filename": "in/a.npy",
        "filter_type": "nearest",
        "wrap_mode": "mirror",
        "raw": True,
        "to_uv": [{"scale": [3, -2, 1]}, {"rotate": [0, 0, 1], "angle": 30}],
    },
    "painted": {
        "type": "twosided",
        "bsdf": {"type": "plastic", "diffuse_reflectance": {"type": "ref", "id": "picture"}},
    },
    "poster": {"type": "rectangle", "bsdf": "painted", "to_world": {"translate": [0.5, 0.5, 1.5]}},
    "board": {
        "type": "rectangle",
        "bsdf": {"type": "diffuse", "reflectance": {"type": "checkerboard", "color1": [0.1, 0.2, 0.3]}},
        "to_world": {"translate": [0.5, -0.5, 1.5]},
    },
    "mesh": {
        "type": "obj",
        "flip_tex_coords": False,
        "filename": "in/m.obj",
        "bsdf": "gold",
        "to_world": [{"rotate": [1, 2, 3], "angle": 4}],
    },
}


@pytest.mark.slow
def test_every_spelling_of_a_dict_goes_out_and_comes_back_the_same(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    np.save(tmp_path / "in" / "a.npy", np.random.default_rng(0).random((3, 4, 3)))
    scene = tracer.load_dict(EVERY_SPELLING, "every", tmp_path)
    tracer.export(scene, tmp_path / "every.xml")
    back = tracer.load(tmp_path / "every.xml")
    assert (back.width, back.height) == (256, 256), "Mitsuba's film is of another size by default"
    assert 'value="in/m.obj"' in (tmp_path / "every.xml").read_text(encoding="utf-8")
    for precision in (32, 64):
        assert same(scene, back, Settings(width=16, height=12, spp=4, precision=precision))


def test_an_axis_that_is_not_of_length_1_shears_in_mitsuba_so_it_goes_out_as_a_matrix(tmp_path):
    def steps(axis):
        return {**DICT, "box": {"type": "cube", "to_world": [{"rotate": axis, "angle": 30}]}}

    for axis, tag in (((0, 0, -1), "rotate"), ((1, 2, 3), "matrix"), ((0, 0, 2), "matrix")):
        scene = tracer.load_dict(steps(axis))
        tracer.export(scene, tmp_path / "turned.xml")
        text = (tmp_path / "turned.xml").read_text(encoding="utf-8")
        (box,) = re.findall(r'<shape type="cube".*?</shape>', text, re.DOTALL)
        assert f"<{tag} " in box
        assert np.array_equal(
            tracer.load(tmp_path / "turned.xml").shapes[-1].to_world, scene.shapes[-1].to_world
        )


@pytest.mark.parametrize("name", ["a\x01b", "a$b", "a\ud800b"])
def test_a_name_that_xml_cannot_carry_is_refused(tmp_path, name):
    scene = tracer.load_dict({**DICT, name: DICT["ball"]})
    with pytest.raises(TracerError, match="rename"):
        tracer.export(scene, tmp_path / "out.xml")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ['a"b<c>&d', "光线", "a b\tc"])
def test_an_odd_name_comes_back_the_same(tmp_path, name):
    tracer.export(tracer.load_dict({**DICT, name: DICT["ball"]}), tmp_path / "out.xml")
    assert tracer.load(tmp_path / "out.xml").shapes[-1].name == name


def test_a_disk_that_fills_up_leaves_the_old_scene_whole(tmp_path, monkeypatch):
    out = tmp_path / "out.xml"
    out.write_bytes(b"the scene of yesterday")

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(TracerError, match="No space left"):
        tracer.export(tracer.load_dict(DICT), out)
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"the scene of yesterday"]


@pytest.mark.slow
def test_the_command_writes_what_the_command_reads(tmp_path):
    done = castray("export", "cornell", "-o", "box.xml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    for scene in ("box.xml", "cornell"):
        words = ("--size", "8", "8", "--spp", "2", "--max-depth", "3", "-o", f"{scene}.npy")
        done = castray("render", scene, *words, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
    assert np.array_equal(np.load(tmp_path / "box.xml.npy"), np.load(tmp_path / "cornell.npy"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "said"), [(("-o", "out.obj"), ".xml"), (("-o", "no/out.xml"), "no folder"), ((), "nowhere")]
)
def test_the_command_refuses_in_one_line(tmp_path, words, said):
    scene = "cornell" if words else "nowhere"
    done = castray("export", scene, *words, cwd=tmp_path)
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert said in done.stderr and not list(tmp_path.iterdir())
