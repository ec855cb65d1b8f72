"""The commands of the project: what they say where a part of the system is missing, and what CI runs."""

import os
import shutil
import subprocess

import pytest
from suite import ROOT

posix = pytest.mark.skipif(os.name == "nt", reason="make and sh are not for Windows")


def bare_path(folder, *programs):
    """A PATH on which only the named programs are found."""
    for program in ("sh", "id", *programs):
        (folder / program).symlink_to(shutil.which(program))
    return {"PATH": str(folder)}


def system(parts, env):
    """`.ci/system PARTS` as it runs under `env`."""
    command = [ROOT / ".ci" / "system", *parts]
    return subprocess.run(command, env=env, capture_output=True, encoding="utf-8", check=False)


@posix
def test_a_missing_part_is_one_line_to_run(tmp_path):
    done = system(["g++", "chromium", "fonts"], bare_path(tmp_path))
    assert done.returncode == 1
    assert done.stderr == (
        "missing on this system; run: sudo apt-get install g++ chromium fontconfig fonts-noto-cjk\n"
    )


@posix
def test_what_is_there_is_not_asked_for(tmp_path):
    (tmp_path / "g++").symlink_to(shutil.which("sh"))
    done = system(["g++"], bare_path(tmp_path))
    assert (done.returncode, done.stderr) == (0, "")


@posix
def test_a_python_without_ensurepip_is_noticed(tmp_path):
    (tmp_path / "python3").symlink_to(shutil.which("false"))
    assert "python3-venv" in system(["venv"], bare_path(tmp_path)).stderr


@posix
def test_under_ci_a_missing_part_stops_the_tests(tmp_path):
    env = bare_path(tmp_path, "make")
    command = [shutil.which("make"), "-C", ROOT, "system"]
    plain = subprocess.run(command, env=env, capture_output=True, check=False)
    ci = subprocess.run(command, env={**env, "CI": "true"}, capture_output=True, check=False)
    assert (plain.returncode, ci.returncode) == (0, 2)


@posix
def test_ci_runs_the_checks_and_then_every_test():
    lines = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    assert "set -euo pipefail" in lines
    assert lines[-2:] == ["make check", "make test"]
