"""The wheel holds what a user needs and no more, and what it installs works in any folder and terminal."""

import json
import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import numpy as np
import pytest
from suite import ROOT

pytestmark = pytest.mark.slow

SMALL = ("--size", "8", "6", "--spp", "2", "--max-depth", "4")
STRANGER = 'raise SystemExit("a file of the user\'s folder was imported")\n'


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel as `pip` would build it."""
    out = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", out, ROOT]
    subprocess.run(command, check=True, capture_output=True)
    (built,) = out.glob("castray-*.whl")
    return built


@pytest.fixture(scope="module")
def scripts(wheel, tmp_path_factory):
    """The folder of scripts of a new environment that has the wheel and nothing else of ours."""
    folder = tmp_path_factory.mktemp("clean")
    venv.create(folder, with_pip=True)
    scripts = folder / ("Scripts" if os.name == "nt" else "bin")
    command = [
        scripts / "python",
        "-m",
        "pip",
        "install",
        "-q",
        "--no-compile",
        "-c",
        ROOT / "constraints.txt",
        wheel,
    ]
    subprocess.run(command, check=True, env=_environment())
    return scripts


def _environment(**changes):
    """This process's environment without the checkout in it."""
    without = ("PYTHONPATH", "VIRTUAL_ENV", "PYTHONDONTWRITEBYTECODE")  # what is imported is compiled once
    kept = {name: value for name, value in os.environ.items() if name not in without}
    return {**kept, **changes}


@pytest.fixture(scope="module")
def desk(scripts, tmp_path_factory):
    """A learner's folder: Chinese characters and spaces in its path, a tracer.py and a scenes/ of its own."""
    folder = tmp_path_factory.mktemp("desk") / "光线 追踪 homework"
    (folder / "scenes").mkdir(parents=True)
    for name in ("tracer.py", "viewer.py", "scenes/__init__.py"):
        (folder / name).write_text(STRANGER, encoding="utf-8")
    (folder / "scenes" / "cornell_unit.toml").write_text("not a scene", encoding="utf-8")
    own = (_installed(scripts) / "scenes" / "furnace.toml").read_text(encoding="utf-8")
    (folder / "scenes" / "我的 炉子.toml").write_text(f"# 我的场景\n{own}", encoding="utf-8")
    return folder


def _installed(scripts):
    code = "import sysconfig; print(sysconfig.get_path('purelib'))"
    done = subprocess.run([scripts / "python", "-c", code], capture_output=True, encoding="utf-8", check=True)
    return Path(done.stdout.strip())


def castray(scripts, cwd, *words, encoding="utf-8", **environment):
    """Standard output of the installed `castray WORDS`, decoded as the terminal would."""
    environment = _environment(PYTHONIOENCODING=encoding, **environment)
    done = subprocess.run(
        [scripts / "castray", *words], cwd=cwd, env=environment, capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr.decode(encoding, "replace")
    assert b"Traceback" not in done.stderr
    return done.stdout.decode(encoding)


def test_the_wheel_holds_packages_scenes_and_static_files_but_no_tests(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    tops = {name.partition("/")[0] for name in names if ".dist-info/" not in name}
    assert tops <= {"tracer", "viewer", "lessons", "scenes"} and {"tracer", "viewer", "scenes"} <= tops
    assert not [name for name in names if "test_" in name or "conftest" in name or "__pycache__" in name]
    for folder in ("tracer", "viewer", "lessons", "scenes"):
        kept = {
            p
            for p in (ROOT / folder).rglob("*")
            if p.suffix
            in (".py", ".h", ".toml", ".js", ".css", ".md", ".ply", ".obj", ".png", ".npz", ".glsl")
        }
        assert {path.relative_to(ROOT).as_posix() for path in kept} <= set(names)


def test_the_command_works_in_a_folder_that_has_a_tracer_and_scenes_of_its_own(scripts, desk, tmp_path):
    said = json.loads(castray(scripts, desk, "render", "cornell_unit", *SMALL, "-o", "图 1.npy", "--json"))
    castray(scripts, tmp_path, "render", "cornell_unit", *SMALL, "-o", "elsewhere.npy", "--json")
    picture = np.load(desk / "图 1.npy")
    assert (said["width"], said["height"], picture.shape) == (8, 6, (6, 8, 3))
    assert np.array_equal(picture, np.load(tmp_path / "elsewhere.npy"))


def test_the_command_says_its_version(wheel, scripts, desk):
    assert castray(scripts, desk, "--version").strip() == wheel.name.split("-")[1]


def test_several_processes_find_the_installed_tracer_too(scripts, desk):
    for workers in ("1", "2"):
        castray(scripts, desk, "render", "cornell_unit", *SMALL, "--workers", workers, "-o", f"{workers}.npy")
    assert np.array_equal(np.load(desk / "1.npy"), np.load(desk / "2.npy"))


def test_a_scene_of_ones_own_with_a_chinese_name_is_rendered(scripts, desk):
    own = "scenes/我的 炉子.toml"
    castray(scripts, desk, "render", own, *SMALL, "-o", "炉子.npy", "--json")
    castray(scripts, desk, "render", "furnace", *SMALL, "-o", "furnace.npy", "--json")
    assert np.array_equal(np.load(desk / "炉子.npy"), np.load(desk / "furnace.npy"))


@pytest.mark.parametrize("suffix", ["exr", "png", "npy"])
def test_every_kind_of_picture_is_written_under_a_chinese_path(scripts, desk, suffix):
    castray(scripts, desk, "render", "cornell_unit", *SMALL, "-o", f"画.{suffix}")
    assert (desk / f"画.{suffix}").stat().st_size > 0
    assert not list(desk.glob("*.partial*"))


@pytest.mark.parametrize("encoding", ["gbk", "ascii", "utf-8"])
@pytest.mark.parametrize(
    "words",
    [
        ("--help",),
        ("inspect", "--help"),
        ("inspect", "cornell_unit", "--pixel", "4", "5", *SMALL),
        ("inspect", "cornell_unit", "--pixel", "4", "5", *SMALL, "--json"),
        ("render", "cornell_unit", *SMALL, "-o", "出.npy"),
        ("render", "scenes/我的 炉子.toml", *SMALL, "-o", "出.npy", "--json"),
    ],
    ids=["help", "inspect-help", "inspect", "inspect-json", "render", "render-json"],
)
def test_the_terminal_may_speak_another_encoding(scripts, desk, encoding, words):
    said = castray(scripts, desk, *words, encoding=encoding, PYTHONUTF8="0")
    assert said.strip()
    if "--json" in words:
        json.loads(said)


def test_files_are_read_as_utf8_where_the_system_says_ascii(scripts, desk, tmp_path):
    own = (desk / "scenes" / "我的 炉子.toml").read_text(encoding="utf-8")
    (tmp_path / "own.toml").write_text(own, encoding="utf-8")
    plain = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    castray(scripts, tmp_path, "render", "own.toml", *SMALL, "-o", "own.npy", encoding="ascii", **plain)


def test_the_installed_viewer_has_its_page(scripts):
    assert list((_installed(scripts) / "viewer" / "static").glob("*.js"))
