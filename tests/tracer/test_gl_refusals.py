"""What the gl engine cannot do is refused by name, and so is a machine that lacks what it needs."""

import re
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
import suite
from cases import loaded
from shaders import kinds_of_light, small
from suite import castray, missing

import tracer
from lessons import zoo
from tracer import TracerError
from tracer.engine.gl import device
from tracer.engine.gl.choice import faster
from tracer.integrator.steps import RIGHT
from tracer.light.envmap import Envmap
from tracer.scene import Scene


@pytest.fixture(scope="module")
def gl():
    """OpenGL, drawn by whomever."""
    return suite.gl()


def with_a_lamp_on_the_floor():
    standing = {"to_world": [{"scale": 0.4}, {"translate": [0, -0.6, -1]}], "bsdf": "grey"}
    return kinds_of_light(stand={"type": "rectangle", "emitter": {"type": "area", "radiance": 1}, **standing})


def under_a_picture():
    """A scene lit by a picture of the sky."""
    made = loaded("sky").definition
    return Scene(made._replace(emitters=(Envmap("heaven", np.ones((4, 8, 3)), np.eye(3)),), source=None))


@pytest.mark.parametrize(
    ("scene", "options", "what"),
    [
        (under_a_picture, {}, "heaven, a light of kind envmap"),
        (with_a_lamp_on_the_floor, {}, "stand, a lamp that touches another shape"),
        (lambda: loaded("cornell_unit"), {"precision": 64}, "precision 64"),
    ],
    ids=["environment", "touching", "precision"],
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
    with pytest.raises(TracerError, match="a driver with OpenGL 4.1: no display anywhere") as error:
        tracer.render(loaded("furnace"), small(), engine="gl")
    assert "\n" not in str(error.value)


def test_an_older_opengl_is_refused_with_its_version(gl, afresh, monkeypatch):
    monkeypatch.setattr(device, "LEAST", 990)
    with pytest.raises(TracerError, match=r"OpenGL 9.9: this one has OpenGL \d\.\d;.* choose engine numpy"):
        tracer.render(loaded("furnace"), small(), engine="gl")


def test_auto_takes_it_only_where_a_graphics_card_draws(gl, monkeypatch):
    scene, settings = loaded("cornell_unit"), small()
    monkeypatch.setattr("tracer.engine.gl.choice.renderer", lambda: "card")
    for hardware, taken in ((True, "gl"), (False, "numpy")):
        monkeypatch.setattr("tracer.engine.gl.choice.is_hardware", lambda here=hardware: here)
        assert faster(scene, settings, RIGHT)[0] == taken
    monkeypatch.setattr("tracer.engine.gl.choice.is_hardware", lambda: True)
    engine, why = faster(scene, replace(settings, precision=64), RIGHT)
    assert (engine, why) == ("numpy", "gl cannot do precision 64")


def test_more_triangles_than_the_driver_takes_are_refused(gl, monkeypatch):
    few = 1 << 10
    for module in ("tracing", "choice"):
        monkeypatch.setattr(f"tracer.engine.gl.{module}.largest", lambda: few)
    monkeypatch.setattr("tracer.engine.gl.choice.is_hardware", lambda: True)
    scene, why = loaded("cornell"), "gl cannot do 1 MB of triangles and tables where the driver takes 0 MB"
    with pytest.raises(TracerError, match=f"engine: {why}; choose engine numpy"):
        tracer.render(scene, small(), engine="gl")
    assert faster(scene, small(), RIGHT) == ("numpy", why)
