"""Bad input gets one line that says what, where and what would do, exit code 2, and nothing half-written."""

import errno
import os
import socket
import struct

import numpy as np
import pytest
from suite import castray

import tracer
from viewer.cli import main

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


def run(words, cwd, monkeypatch, capsys):
    """Exit code, standard output and standard error of `castray WORDS` in this very process."""
    monkeypatch.chdir(cwd)
    with pytest.raises(SystemExit) as ended:
        main([str(word) for word in words])
    return ended.value.code, *capsys.readouterr()


@pytest.fixture
def refused(tmp_path, monkeypatch, capsys):
    """A check that `castray WORDS` refuses in one line in which every one of `names` stands."""

    def check(words, *names, separately=False):
        before = sorted(path.name for path in tmp_path.iterdir())
        if separately:
            done = castray(*words, cwd=tmp_path, timeout=60)
            code, out, err = done.returncode, done.stdout, done.stderr
        else:
            code, out, err = run(words, tmp_path, monkeypatch, capsys)
        assert (code, out) == (2, ""), err
        (line,) = err.splitlines()
        assert not [name for name in names if name not in line], line
        assert sorted(path.name for path in tmp_path.iterdir()) == before, "something was left behind"

    return check


def scene(folder, name="room.toml", radiance="[1, 1, 1]", thing="cube", more=""):
    """A scene file to spoil, written into `folder`; its name."""
    (folder / name).write_text(ROOM.format(radiance=radiance, thing=thing, more=more), encoding="utf-8")
    return name


@pytest.mark.slow
@pytest.mark.parametrize("command", ["render", "inspect", "view"])
def test_a_scene_that_is_not_there(refused, command):
    words = {"inspect": ("--pixel", "0", "0"), "view": ("--no-browser",), "render": ()}[command]
    refused((command, "nowhere", *words), "nowhere", "cornell_unit", separately=command == "view")
    refused((command, "nowhere.toml", *words), "nowhere.toml", separately=command == "view")


def test_a_scene_file_that_is_not_toml(refused, tmp_path):
    (tmp_path / "broken.toml").write_text("[camera\ntype = 'perspective'\n", encoding="utf-8")
    refused(("render", "broken.toml"), "broken.toml", "line 1")


def test_a_scene_file_that_is_not_text(refused, tmp_path):
    (tmp_path / "picture.toml").write_bytes(b"\x89PNG\r\n\xff\xfe")
    refused(("render", "picture.toml"), "picture.toml")


def test_a_folder_for_a_scene(refused, tmp_path):
    (tmp_path / "folder.toml").mkdir()
    refused(("render", "folder.toml"), "folder.toml")


def test_an_empty_scene_file(refused, tmp_path):
    (tmp_path / "empty.toml").write_text("", encoding="utf-8")
    refused(("render", "empty.toml"), "empty.toml", "perspective")


def test_a_scene_file_with_the_mark_that_some_editors_put_first(tmp_path, monkeypatch, capsys):
    (tmp_path / "marked.toml").write_text(
        ROOM.format(radiance=1, thing="cube", more=""), encoding="utf-8-sig"
    )
    code, _, err = run(("render", "marked.toml", *SMALL, "-o", "out.npy"), tmp_path, monkeypatch, capsys)
    assert code == 0, err


def test_an_unknown_word_names_the_words_that_would_do(refused, tmp_path):
    refused(("render", scene(tmp_path, thing="teapot")), "room.toml", "thing", "teapot", "sphere")


def test_an_unknown_option_of_a_shape(refused, tmp_path):
    refused(("render", scene(tmp_path, more="colour = 1")), "room.toml", "thing", "colour")


@pytest.mark.parametrize("radiance", ["[1, nan, 1]", "[1, inf, 1]", "[1, -1, 1]", "'bright'", "[1, 1]"])
def test_a_radiance_that_is_none(refused, tmp_path, radiance):
    refused(("render", scene(tmp_path, radiance=radiance)), "room.toml", "radiance")


def test_a_mesh_with_a_nan(refused, tmp_path):
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    head += "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    corners = struct.pack("<9f", 0, 0, 0, 1, float("nan"), 0, 0, 1, 0)
    (tmp_path / "holed.ply").write_bytes(head.encode("ascii") + corners + struct.pack("<B3i", 3, 0, 1, 2))
    name = scene(tmp_path, thing="ply", more='filename = "holed.ply"')
    refused(("render", name), "holed.ply", "finite")


@pytest.mark.parametrize("content", [None, b"", b"no mesh at all"], ids=["missing", "empty", "nonsense"])
def test_a_mesh_that_cannot_be_read(refused, tmp_path, content):
    if content is not None:
        (tmp_path / "lost.ply").write_bytes(content)
    name = scene(tmp_path, thing="ply", more='filename = "lost.ply"')
    refused(("render", name), "lost.ply")


@pytest.mark.parametrize("pixel", [("8", "0"), ("0", "6"), ("-1", "0")])
def test_a_pixel_outside_the_picture(refused, pixel):
    refused(("inspect", "cornell_unit", "--pixel", *pixel, *SMALL), "pixel", "7", "5")


def test_a_sample_that_the_pixel_does_not_have(refused):
    words = ("inspect", "cornell_unit", "--pixel", "0", "0", "--sample", "1", *SMALL)
    refused(words, "sample")


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ("--size 0 5", "width"),
        ("--size 5 -1", "height"),
        ("--size 5 tall", "size"),
        ("--spp 0", "spp"),
        ("--spp 1.5", "spp"),
        ("--spp 1e30", "spp"),
        ("--seed -1", "seed"),
        ("--max-depth -2", "max_depth"),
        ("--integrator photon", "integrator"),
        ("--precision 16", "precision"),
        ("--roulette 2", "roulette"),
        ("--sampler sobel", "sampler"),
        ("--engine quantum", "engine"),
        ("--workers 0", "workers"),
        ("--bug no-such-bug", "no-such-bug"),
    ],
)
def test_an_option_out_of_its_range(refused, words, name):
    refused(("render", "cornell_unit", *words.split()), name)


def test_an_option_that_does_not_exist(refused):
    refused(("render", "cornell_unit", "--bounces", "3"), "--bounces")


def test_a_command_that_does_not_exist(refused):
    refused(("rendr", "cornell_unit"), "rendr")


@pytest.mark.parametrize("out", ["no/such/folder/out.npy", "taken/out.npy", "folder.npy", "out.jpeg"])
def test_an_output_that_cannot_be_written(refused, tmp_path, out):
    (tmp_path / "taken").write_text("a file where a folder should be", encoding="utf-8")
    (tmp_path / "folder.npy").mkdir()
    refused(("render", "cornell_unit", *SMALL, "-o", out), out.rpartition("/")[2])


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


@pytest.mark.slow
@pytest.mark.parametrize("port", ["0x50", "-1", "70000"])
def test_a_port_that_is_none(refused, port):
    refused(("view", "cornell_unit", "--no-browser", "--port", port), "port", separately=True)


@pytest.mark.slow
def test_a_port_that_is_taken(refused):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        refused(("view", "cornell_unit", "--no-browser", "--port", port), port, separately=True)


@pytest.mark.slow
@pytest.mark.parametrize(
    "link", ["http://127.0.0.1:1/#scene=../../etc/passwd", "http://127.0.0.1:1/?pixel=a"]
)
def test_a_link_that_names_nothing_of_ours(refused, link):
    refused(("view", link, "--no-browser"), "link", separately=True)


@pytest.mark.slow
def test_the_room_these_tests_spoil_is_good_itself(tmp_path):
    done = castray("render", scene(tmp_path), *SMALL, "-o", "out.npy", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.npy", "room.toml"]
