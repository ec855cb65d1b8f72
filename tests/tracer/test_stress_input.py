"""The stress cases of input, by their ids: a mistake is one clear refusal, a broken number no picture."""

import copy
import dataclasses
import json

import numpy as np
import pytest

import tracer
from tracer import Settings, TracerError
from tracer.integrator.steps import RIGHT
from viewer.cli import main

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
ROOM = {
    "sensor": {
        "type": "perspective",
        "fov": 40,
        "to_world": [{"look_at": {"origin": [3, 2, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}],
        "film": {"width": 16, "height": 12},
    },
    "lamp": {
        "type": "sphere",
        "center": [0, 5, 0],
        "bsdf": {"type": "diffuse", "reflectance": 0.5},
        "emitter": {"type": "area", "radiance": 3},
    },
    "mesh": {"type": "ply", "filename": "mesh.ply"},
}
PRECISIONS = [32, 64]


def room(folder, corners=CORNERS, faces=FACES, kind="ply"):
    """ROOM with this mesh, as a file of this kind."""
    lines = [" ".join(map(str, c)) for c in corners]
    if kind == "ply":
        head = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\n"
        head += "property double x\nproperty double y\nproperty double z\n"
        head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        text = head + "\n".join(lines + ["3 " + " ".join(map(str, f)) for f in faces]) + "\n"
    else:
        text = "\n".join(
            [f"v {line}" for line in lines] + ["f " + " ".join(str(k + 1) for k in f) for f in faces]
        )
    (folder / f"mesh.{kind}").write_text(text, encoding="utf-8")
    scene = copy.deepcopy(ROOM)
    scene["mesh"] = {"type": kind, "filename": f"mesh.{kind}"}
    return tracer.load_dict(scene, folder=folder)


def changed(path, value):
    """ROOM without its mesh, and one value put in; path: names joined by dots."""
    scene = {**copy.deepcopy(ROOM), "mesh": {"type": "cube", "bsdf": {"type": "diffuse", "reflectance": 0.5}}}
    *above, last = path.split(".")
    table = scene
    for name in above:
        table = table[int(name) if isinstance(table, list) else name]
    table[last] = value
    return scene


def render(scene, precision, **more):
    return tracer.render(scene, Settings(spp=4, max_depth=4, precision=precision, **more))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("length", [1e-3, 0.5, 3.0, 1e3])
def test_s46_rays_of_any_length_meet_the_same_point(tmp_path, precision, length):
    scene = room(tmp_path).at(Settings(precision=precision))
    o = np.tile(np.array([[3.0], [2.0], [4.0]]), 64).astype(scene.dtype)
    d = np.random.default_rng(1).normal(size=(3, 64)) * 0.15 - o / np.linalg.norm(o, axis=0)
    d, nowhere = (d / np.linalg.norm(d, axis=0)).astype(scene.dtype), np.full(64, -1, np.int32)
    t, primitive = scene.intersect(o, d, nowhere)
    t_long, primitive_long = scene.intersect(o, d * scene.dtype(length), nowhere)
    assert (primitive >= 0).sum() > 10 and (primitive == primitive_long).all()
    met = primitive >= 0
    assert np.allclose(t[met], t_long[met] * length, rtol=64 * np.finfo(scene.dtype).eps)


@pytest.mark.parametrize("kind", ["ply", "obj"])
@pytest.mark.parametrize("wrong", ["nan", "inf", "-inf"])
@pytest.mark.parametrize("vertex", range(4))
def test_s47_a_vertex_that_is_no_point_is_named(tmp_path, kind, wrong, vertex):
    corners = [list(c) for c in CORNERS]
    corners[vertex][1] = wrong
    with pytest.raises(TracerError, match=rf"mesh.*mesh\.{kind}.*vertex \d+ .*finite"):
        room(tmp_path, corners, kind=kind)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("number", [4, 2**31 - 1, -1, "nan"])
def test_s47_a_face_of_a_vertex_that_is_not_there_is_named(tmp_path, number):
    with pytest.raises(TracerError, match=r"mesh.*mesh\.ply.*face 2.*there are 4"):
        room(tmp_path, faces=[*FACES[:2], [0, number, 2], FACES[3]])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("precision", PRECISIONS)
def test_s47_a_face_without_area_is_left_out_and_the_others_stay(tmp_path, precision):
    good = render(room(tmp_path), precision).rgb
    assert np.array_equal(render(room(tmp_path, faces=[*FACES, [1, 1, 2], [3, 3, 3]]), precision).rgb, good)


EYE = "sensor.to_world.0.look_at"
CAMERAS = [
    *(
        ("sensor.fov", fov, "sensor.fov")
        for fov in (0, 180, -40, 360, float("nan"), float("inf"), "wide", [40])
    ),
    (f"{EYE}.up", [3, 2, 4], "look_at"),
    (f"{EYE}.up", [0, 0, 0], "look_at"),
    (f"{EYE}.target", [3, 2, 4], "look_at"),
    (f"{EYE}.origin", [float("nan"), 0, 0], r"look_at.origin\[0\]"),
    (f"{EYE}.origin", [0, float("inf"), 0], r"look_at.origin\[1\]"),
    (f"{EYE}.origin", [1e300, 0, 0], r"look_at.origin\[0\]"),
    (f"{EYE}.origin", [1e12, 0, 0], "sensor.to_world"),
    ("sensor.to_world", [{"scale": 0}], "sensor.to_world"),
    ("sensor.to_world", [{"scale": [-1, 1, 1]}], "sensor.to_world"),
    ("sensor.to_world", [[1, 0, 0], [0, 1], [0, 0, 1]], "sensor.to_world"),
    ("sensor.film", {"width": 0}, "sensor.film.width"),
    ("sensor.film", {"height": 1e3}, "sensor.film.height"),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("path", "value", "said"), CAMERAS)
def test_s48_a_camera_that_sees_nothing_is_refused_by_name(path, value, said):
    with pytest.raises(TracerError, match=said):
        tracer.load_dict(changed(path, value))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("fov", [1e-3, 179.9])
def test_s48_a_field_of_view_just_within_its_limits_is_a_picture(precision, fov):
    assert np.isfinite(render(tracer.load_dict(changed("sensor.fov", fov)), precision).rgb).all()


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_s49_a_broken_sample_is_dropped_and_counted_and_reported(
    precision, wrong, capsys, monkeypatch, tmp_path
):
    """A throughput that is no number for some of the paths: the picture is that of the others."""

    def broken(beta, sample, cos):
        right = RIGHT.throughput(beta, sample, cos)
        right[:, sample.wi[2] > 0.9] = wrong
        return right

    scene = tracer.load_dict(changed("sensor.film", {"width": 16, "height": 12}))
    settings = Settings(spp=4, max_depth=4, precision=precision)
    steps = dataclasses.replace(RIGHT, throughput=broken)
    picture = tracer.render(scene, settings, steps=steps)
    good = tracer.render(scene, settings)
    assert np.isfinite(picture.rgb).all() and (picture.rgb >= 0).all()
    assert picture.dropped > 0 and good.dropped == 0
    assert (picture.rgb <= good.rgb).all(), "a dropped sample counts as 0"
    assert not (picture.rgb == good.rgb).all()
    y, x = np.argwhere((picture.rgb < good.rgb).all(axis=2))[0]
    ends = [p.end for p in tracer.inspect(scene, settings, x, y, steps=steps).paths]
    assert "invalid" in ends
    monkeypatch.setattr(tracer, "render", lambda *_, **__: picture)
    for words in ((), ("--json",)):
        with pytest.raises(SystemExit):
            main(["render", "cornell_unit", "-o", str(tmp_path / "out.exr"), *words])
        said = capsys.readouterr().out
        if words:
            assert json.loads(said)["dropped"] == picture.dropped
        else:
            assert f"{picture.dropped} samples were not finite and count as 0" in said


WRONG = [
    *(
        ("mesh.bsdf.reflectance", value)
        for value in (1.01, -0.1, [0.5, 0.5], ["a", "b", "c"], "red", True, None)
    ),
    *(("mesh.bsdf.reflectance", value) for value in ([0.5, 0.5, float("nan")], {"type": "rgb"}, 10**400)),
    *(("lamp.emitter.radiance", value) for value in (-1, [1, 2], [1, 2, 3, 4], "bright", float("inf"), 1e31)),
    *(("lamp.radius", value) for value in (0, -1, float("nan"), "big", [1], 1e12)),
    ("lamp.center", [0, 0]),
    ("lamp.center", [0, 0, 1e10]),
    ("lamp.flip_normals", 1),
    ("mesh.to_world", "left"),
    ("mesh.to_world", [{"scale": 1e-10}]),
    ("mesh.to_world", [{"scale": [1, 1, 0]}]),
    ("mesh.to_world", [{"scale": 1e10}, {"scale": 1e10}]),
    ("mesh.bsdf", ["white"]),
    ("mesh.bsdf", {"type": ["diffuse"]}),
    ("mesh.type", 7),
    ("mesh", "cube"),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("path", "value"), WRONG)
def test_s50_a_value_of_the_wrong_type_or_size_is_refused_by_name(path, value):
    with pytest.raises(TracerError) as refused:
        tracer.load_dict(changed(path, value))
    assert str(refused.value).startswith(path.split(".")[0]) and "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("max_depth", -2),
        ("max_depth", "deep"),
        ("spp", 0),
        ("spp", 1.5),
        ("width", -1),
        ("precision", 16),
        ("seed", None),
    ],
)
def test_s50_a_setting_of_the_wrong_type_or_size_is_refused_by_name(option, value):
    with pytest.raises(TracerError, match=f"^{option}"):
        Settings(**{option: value})
