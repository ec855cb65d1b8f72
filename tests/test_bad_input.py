"""Bad input gets one line that says what, where and what would do, exit code 2, and nothing half-written."""

import errno
import os
import socket
import struct

import numpy as np
import pytest
from suite import castray

import tracer

SMALL = ("--size", "8", "6", "--spp", "1", "--max-depth", "2")

ROOM = """
[sensor]
type = "perspective"
fov = 40.0
to_world = [{{ look_at = {{ origin = [0, 0, 4], target = [0, 0, 0], up = [0, 1, 0] }} }}]

[lamp]
type = "rectangle"
emitter = {{ type = "area", radiance = {radiance} }}

[thing]
type = "{thing}"
{more}
"""


def refused(words, *names, cwd):
    """The one line that `castray WORDS` refuses with; every one of `names` must stand in it."""
    before = sorted(path.name for path in cwd.iterdir())
    done = castray(*words, cwd=cwd)
    assert done.returncode == 2, f"exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, done.stderr
    assert not done.stdout.strip()
    for name in names:
        assert name in lines[0], lines[0]
    assert sorted(path.name for path in cwd.iterdir()) == before, "something was left behind"


def scene(folder, name="room.toml", radiance="[1, 1, 1]", thing="cube", more=""):
    """A scene file to spoil, written into `folder`; its name."""
    (folder / name).write_text(ROOM.format(radiance=radiance, thing=thing, more=more), encoding="utf-8")
    return name


@pytest.mark.parametrize("command", ["render", "inspect", "view"])
def test_a_scene_that_is_not_there(tmp_path, command):
    words = {"inspect": ("--pixel", "0", "0"), "view": ("--no-browser",), "render": ()}[command]
    refused((command, "nowhere", *words), "nowhere", "cornell_unit", cwd=tmp_path)
    refused((command, "nowhere.toml", *words), "nowhere.toml", cwd=tmp_path)


def test_a_scene_file_that_is_not_toml(tmp_path):
    (tmp_path / "broken.toml").write_text("[camera\ntype = 'perspective'\n", encoding="utf-8")
    refused(("render", "broken.toml"), "broken.toml", "line 1", cwd=tmp_path)


def test_a_scene_file_that_is_not_text(tmp_path):
    (tmp_path / "picture.toml").write_bytes(b"\x89PNG\r\n\xff\xfe")
    refused(("render", "picture.toml"), "picture.toml", cwd=tmp_path)


def test_a_folder_for_a_scene(tmp_path):
    (tmp_path / "folder.toml").mkdir()
    refused(("render", "folder.toml"), "folder.toml", cwd=tmp_path)


def test_an_empty_scene_file(tmp_path):
    (tmp_path / "empty.toml").write_text("", encoding="utf-8")
    refused(("render", "empty.toml"), "empty.toml", "perspective", cwd=tmp_path)


def test_a_scene_file_with_the_mark_that_some_editors_put_first(tmp_path):
    (tmp_path / "marked.toml").write_text(
        ROOM.format(radiance=1, thing="cube", more=""), encoding="utf-8-sig"
    )
    done = castray("render", "marked.toml", *SMALL, "-o", "out.npy", cwd=tmp_path)
    assert done.returncode == 0, done.stderr


def test_an_unknown_word_names_the_words_that_would_do(tmp_path):
    refused(
        ("render", scene(tmp_path, thing="teapot")), "room.toml", "thing", "teapot", "sphere", cwd=tmp_path
    )


def test_an_unknown_option_of_a_shape(tmp_path):
    refused(("render", scene(tmp_path, more="colour = 1")), "room.toml", "thing", "colour", cwd=tmp_path)


@pytest.mark.parametrize("radiance", ["[1, nan, 1]", "[1, inf, 1]", "[1, -1, 1]", "'bright'", "[1, 1]"])
def test_a_radiance_that_is_none(tmp_path, radiance):
    refused(("render", scene(tmp_path, radiance=radiance)), "room.toml", "radiance", cwd=tmp_path)


def test_a_mesh_with_a_nan(tmp_path):
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    head += "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    corners = struct.pack("<9f", 0, 0, 0, 1, float("nan"), 0, 0, 1, 0)
    (tmp_path / "holed.ply").write_bytes(head.encode("ascii") + corners + struct.pack("<B3i", 3, 0, 1, 2))
    name = scene(tmp_path, thing="ply", more='filename = "holed.ply"')
    refused(("render", name), "holed.ply", "finite", cwd=tmp_path)


@pytest.mark.parametrize("content", [None, b"", b"no mesh at all"], ids=["missing", "empty", "nonsense"])
def test_a_mesh_that_cannot_be_read(tmp_path, content):
    if content is not None:
        (tmp_path / "lost.ply").write_bytes(content)
    name = scene(tmp_path, thing="ply", more='filename = "lost.ply"')
    refused(("render", name), "lost.ply", cwd=tmp_path)


@pytest.mark.parametrize("pixel", [("8", "0"), ("0", "6"), ("-1", "0")])
def test_a_pixel_outside_the_picture(tmp_path, pixel):
    refused(("inspect", "cornell_unit", "--pixel", *pixel, *SMALL), "pixel", "7", "5", cwd=tmp_path)


def test_a_sample_that_the_pixel_does_not_have(tmp_path):
    words = ("inspect", "cornell_unit", "--pixel", "0", "0", "--sample", "1", *SMALL)
    refused(words, "sample", cwd=tmp_path)


@pytest.mark.parametrize(
    ("option", "values"),
    [
        ("size", ("0", "5")),
        ("size", ("5", "-1")),
        ("size", ("5", "tall")),
        ("spp", ("0",)),
        ("spp", ("1.5",)),
        ("seed", ("-1",)),
        ("max-depth", ("-2",)),
        ("integrator", ("photon",)),
        ("precision", ("16",)),
        ("roulette", ("2",)),
        ("sampler", ("sobel",)),
        ("spp", ("1e30",)),
        ("engine", ("quantum",)),
        ("workers", ("0",)),
        ("bug", ("no-such-bug",)),
    ],
)
def test_an_option_out_of_its_range(tmp_path, option, values):
    name = option if option != "size" else ("width" if values[0] == "0" else "")
    refused(("render", "cornell_unit", f"--{option}", *values), name.replace("-", "_")[:4], cwd=tmp_path)


def test_an_option_that_does_not_exist(tmp_path):
    refused(("render", "cornell_unit", "--bounces", "3"), "--bounces", cwd=tmp_path)


def test_a_command_that_does_not_exist(tmp_path):
    refused(("rendr", "cornell_unit"), "rendr", cwd=tmp_path)


@pytest.mark.parametrize("out", ["no/such/folder/out.npy", "taken/out.npy", "folder.npy", "out.jpeg"])
def test_an_output_that_cannot_be_written(tmp_path, out):
    (tmp_path / "taken").write_text("a file where a folder should be", encoding="utf-8")
    (tmp_path / "folder.npy").mkdir()
    refused(("render", "cornell_unit", *SMALL, "-o", out), out.rpartition("/")[2], cwd=tmp_path)


@pytest.mark.parametrize("suffix", ["exr", "png", "npy"])
def test_a_disk_that_fills_up_leaves_the_old_picture_whole(tmp_path, monkeypatch, suffix):
    out = tmp_path / f"out.{suffix}"
    out.write_bytes(b"the picture of yesterday")

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(tracer.TracerError, match="No space left"):
        tracer.write(np.zeros((4, 4, 3), np.float32), out)
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"the picture of yesterday"]


@pytest.mark.parametrize("port", ["0x50", "-1", "70000"])
def test_a_port_that_is_none(tmp_path, port):
    refused(("view", "cornell_unit", "--no-browser", "--port", port), "port", cwd=tmp_path)


def test_a_port_that_is_taken(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        refused(("view", "cornell_unit", "--no-browser", "--port", port), port, cwd=tmp_path)


@pytest.mark.parametrize(
    "link", ["http://127.0.0.1:1/#scene=../../etc/passwd", "http://127.0.0.1:1/?pixel=a"]
)
def test_a_link_that_names_nothing_of_ours(tmp_path, link):
    refused(("view", link, "--no-browser"), "link", cwd=tmp_path)


def test_the_room_these_tests_spoil_is_good_itself(tmp_path):
    done = castray("render", scene(tmp_path), *SMALL, "-o", "out.npy", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.npy", "room.toml"]
