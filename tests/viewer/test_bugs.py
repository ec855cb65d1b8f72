"""`castray bugs`: the zoo as a list that fits a narrow terminal, one bug in full, and pictures."""

import io
import json

import numpy as np
import pytest
from rich.console import Console
from suite import castray

import tracer
from lessons.course import about
from lessons.zoo import FAMILIES, ZOO
from viewer.words import LANGUAGES, use
from viewer.zoo import print_bug

NARROW = {"COLUMNS": "80"}


def test_the_list_has_every_bug_under_its_family_in_80_columns():
    done = castray("bugs", env=NARROW)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    heads = [line.strip() for line in lines if line and not line.startswith(" ")]
    assert heads[: len(FAMILIES)] == [head for head in FAMILIES if head in heads]
    assert [line.split()[0] for line in lines if line.startswith(" ") and line[1] != " "] == list(ZOO)


def test_one_bug_is_told_in_full():
    done = castray("bugs", "E01", env=NARROW)
    assert done.returncode == 0, done.stderr
    assert max(map(len, done.stdout.splitlines())) <= 80
    said = " ".join(done.stdout.split())
    bug = ZOO["E01"]
    lesson = f"castray lesson {about('E01')}"
    for text in (bug.title, bug.symptom, bug.wrong, bug.law, bug.command, "cannot be told from E04", lesson):
        assert text in said


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("bug", ZOO)
def test_every_bug_is_told_in_every_language(bug, language):
    use(language)
    try:
        said = io.StringIO()
        print_bug(ZOO[bug], Console(file=said, width=200))
        assert bug in said.getvalue()
        assert about(bug) is None or f"castray lesson {about(bug)}" in said.getvalue()
    finally:
        use("en")


def test_json_has_what_the_list_has_and_more():
    document = json.loads(castray("bugs", "--json").stdout)
    assert [bug["id"] for bug in document] == list(ZOO)
    (one,) = json.loads(castray("bugs", "D01", "--json").stdout)
    assert one["alike"] == ["D01", "D02"] and one["steps"] == ["visibility"]
    assert one["family"] == "Light samples" and one["settings"]["jitter"] is False


@pytest.mark.slow
def test_a_thumbnail_has_the_wrong_picture_beside_the_right_one(tmp_path):
    done = castray("bugs", "D04", "--thumbnails", tmp_path)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["D04.png"]
    rgb = tracer.read(tmp_path / "D04.png").rgb
    height, width, _ = rgb.shape
    wrong, right = rgb[:, : (width - 2) // 2], rgb[:, (width + 2) // 2 :]
    assert wrong.shape == right.shape == (96, 96, 3)
    assert np.median(wrong) == 0.0 < np.median(right)


@pytest.mark.parametrize("words", [("E99",), ("E01", "--thumbnails", "nowhere")])
def test_what_is_not_there_is_one_line_and_exit_code_2(words):
    done = castray("bugs", *words)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.count("\n") == 1 and done.stderr.startswith("castray: ")
