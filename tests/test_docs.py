"""The papers tell the truth: examples run, links lead somewhere, the floors are those that are tested."""

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from suite import ROOT, castray
from test_layers import FLOORS

PAPERS = (
    "README.md",
    "README.zh-CN.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "REFERENCES.md",
    "BENCHMARKS.md",
    "COMPARISON.md",
)
FEATURES = 42  # of the comparison with other programs
SHELLS = ("sh", "bash", "console")


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(name, *languages):
    """The fenced code blocks of a paper in any of the languages."""
    found = re.findall(r"^```(\w+)\n(.*?)^```", text(name), re.DOTALL | re.MULTILINE)
    return [body for language, body in found if language in languages]


def examples():
    """Every `castray ...` line of a shell block; `view` would not end and is left to the browser tests."""
    lines = [
        line.removeprefix("$ ")
        for name in PAPERS
        for body in blocks(name, *SHELLS)
        for line in body.splitlines()
    ]
    said = {bare(line): line for line in reversed(lines)}  # what two papers say runs once
    return [line for line in reversed(said.values()) if line.startswith("castray ") and " view " not in line]


def bare(code):
    """Code without its comments."""
    return re.sub(r"[ \t]*(?:#(?!include)|//)[ \t].*$", "", code, flags=re.MULTILINE)


def dear(line):
    """Whether an example takes more than a second."""
    return not line.startswith(("castray bugs", "castray export", "castray lesson"))


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """The folder in which the README's recording was made."""
    folder = tmp_path_factory.mktemp("recorded")
    (line,) = [line for line in examples() if " --record " in line]
    done = castray(*shlex.split(line, comments=True)[1:], cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.parametrize(
    "line", [pytest.param(line, marks=pytest.mark.slow if dear(line) else ()) for line in examples()]
)
def test_an_example_runs_as_it_is_printed(line, tmp_path, request):
    words = shlex.split(line, comments=True)[1:]
    folder = request.getfixturevalue("recorded") if words[:2] == ["query", "box"] else tmp_path
    done = castray(*words, cwd=folder)
    assert done.returncode == 0, done.stderr
    for option in {"-o", "--mask"} & set(words):
        assert (folder / words[words.index(option) + 1]).stat().st_size > 0


@pytest.mark.slow
def test_the_scene_of_the_readme_renders(tmp_path):
    (body,) = blocks("README.md", "toml")
    (tmp_path / "mine.toml").write_text(body, encoding="utf-8")
    done = castray(
        "render", "mine.toml", "--size", "16", "16", "--spp", "4", "-o", "m.npy", "--json", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert min(json.loads(done.stdout)["mean"]) > 0


@pytest.mark.slow
def test_the_python_of_the_readme_runs(tmp_path):
    for number, body in enumerate(blocks("README.md", "python")):
        file = tmp_path / f"test_{number}.py"
        file.write_text(body, encoding="utf-8")
        suite = ["-m", "pytest", "-q", "-p", "no:cacheprovider"] if "def test_" in body else []
        done = subprocess.run(
            [sys.executable, *suite, str(file)],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_the_pixel_of_the_first_five_minutes_is_in_the_shadow_of_the_small_box():
    x, y = re.search(
        r"Take \((\d+), (\d+)\): the floor, in the shadow of the small box", text("README.md")
    ).groups()
    done = castray("inspect", "cornell_unit", "--pixel", x, y, "--spp", "16", "--json")
    assert done.returncode == 0, done.stderr
    events = [event for path in json.loads(done.stdout)["samples"] for event in path["events"]]
    first = [event for event in events if event["kind"] == "light" and event["depth"] == 0]
    assert {event["shape"] for event in events if event["kind"] == "hit" and event["depth"] == 0} == {"floor"}
    assert first
    assert all(not event["visible"] and event["blocker"] == "small_box" for event in first)


def test_the_code_of_the_chinese_readme_is_that_of_the_english_one_but_for_comments():
    for language in ("sh", "powershell", "console", "text", "cpp", "toml", "python"):
        english = [bare(body) for body in blocks("README.md", language)]
        chinese = [bare(body) for body in blocks("README.zh-CN.md", language)]
        assert english and chinese == english, f"only in one of them: {set(chinese) ^ set(english)}"


def test_the_chinese_readme_goes_block_by_block_with_the_english_one():
    def shape(name):
        return [len(re.split(r"\n{2,}", part.strip())) for part in re.split(r"(?m)^## ", text(name))]

    assert shape("README.zh-CN.md") == shape("README.md")


def test_every_link_leads_to_a_file():
    for name in PAPERS:
        for target in re.findall(r"\]\(([^)#]+)\)", text(name)):
            assert (ROOT / target).is_file(), f"{name} points to {target}"


def test_every_file_a_paper_names_is_there():
    for name in PAPERS:
        for target in re.findall(r"`((?:tracer|viewer|tests|scenes|lessons)/[\w./]*)`", text(name)):
            assert (ROOT / target).exists(), f"{name} names {target}"


def test_the_make_targets_named_are_there():
    targets = re.findall(r"^([\w-]+):", text("Makefile"), re.MULTILINE)
    named = {word for name in PAPERS for word in re.findall(r"[`\n]make ([\w-]+)", text(name))}
    assert named <= set(targets)


def test_the_table_of_floors_is_the_one_that_is_tested():
    rows = re.findall(r"^\| (\d+) \| (.+) \|$", text("ARCHITECTURE.md"), re.MULTILINE)
    said = {word.rstrip("/"): int(floor) for floor, row in rows for word in re.findall(r"`([\w/]+)`", row)}
    for name, floor in FLOORS.items():
        word = name.removeprefix("tracer.")
        if (ROOT / name.replace(".", "/")).with_suffix(".py").exists() or (
            ROOT / name.replace(".", "/")
        ).is_dir():
            assert word == "scenes" or said.get(word) == int(floor), f"ARCHITECTURE.md puts {word} elsewhere"


def test_the_scenes_named_in_the_papers_are_those_that_come_with_it():
    words = set(re.findall(r"`(\w+)`", text("CHANGELOG.md")))
    scenes = {path.stem for path in Path(ROOT / "scenes").glob("*.toml")}
    assert not scenes - words
    assert not {word for word in words if word.startswith(("cornell", "furnace"))} - scenes


def test_the_comparison_proves_each_yes_and_gives_a_reason_for_each_other():
    row = r"^\| (\d+) \| ([^|]+) \| (yes|partly|no) \| ([^|]+) \|(?: [YPN?–] \|){7}$"
    rows = re.findall(row, text("COMPARISON.md"), re.MULTILINE)
    assert [int(number) for number, *_ in rows] == list(range(1, FEATURES + 1))
    for number, _, answer, said in rows:
        proof = re.search(r"`tests/[^`]+::test_|\.md", said)
        assert proof if answer == "yes" else len(said) > 40, number


def test_every_test_that_a_paper_names_is_there():
    named = {
        found for name in PAPERS for found in re.findall(r"`(tests/[\w/]+\.py)::(test_\w+)`", text(name))
    }
    assert len(named) > 40
    missing = [f"{file}::{test}" for file, test in named if f"def {test}(" not in text(file)]
    assert not missing
