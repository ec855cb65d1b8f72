"""`castray doctor` on the command line."""

import json

import pytest
from suite import castray

SMALL = ("--size", 16, 16, "--spp", 4, "--integrator", "direct")
NARROW = {"COLUMNS": "80"}


@pytest.mark.slow
def test_a_right_tracer_is_found_right():
    ran = castray("doctor", "cornell_unit", *SMALL, env=NARROW)
    assert ran.returncode == 0, ran.stderr
    assert "No law is broken." in ran.stdout


@pytest.mark.slow
def test_a_wrong_one_is_told_by_its_name_with_both_numbers_in_80_columns():
    ran = castray("doctor", "cornell", *SMALL, "--bug", "D10", env=NARROW)
    assert ran.returncode == 1, ran.stderr
    for words in (
        "D10",
        "recorded",
        "right",
        "castray inspect cornell --pixel",
        "--bug D10",
        "light-term",
        "fired",
    ):
        assert words in ran.stdout
    assert max(map(len, ran.stdout.splitlines())) <= 80


@pytest.mark.slow
def test_json_is_one_document_that_says_all_of_it():
    ran = castray("doctor", "cornell", *SMALL, "--bug", "E01", "--json")
    said = json.loads(ran.stdout)
    assert ran.returncode == 1 and said.keys() == {"findings", "rules"}
    first = said["findings"][0]
    assert {"rule", "title", "bug", "count", "checked", "first", "explanation", "lesson"} <= first.keys()
    assert first["bug"] == "E01" and first["first"].keys() >= {"x", "y", "sample", "depth"}
    assert {rule["state"] for rule in said["rules"]} == {"fired", "clean", "not_testable"}
    assert all(rule["missing"] for rule in said["rules"] if rule["state"] == "not_testable")


@pytest.mark.parametrize(
    "words", [("no_such_scene",), ("cornell", "--bug", "X99"), ("cornell", "--spp", "0")]
)
def test_bad_input_is_one_line_and_code_2(words):
    ran = castray("doctor", *words)
    assert ran.returncode == 2 and len(ran.stderr.splitlines()) == 1 and not ran.stdout


def test_what_it_lacks_is_told_in_chinese_as_well():
    ran = castray(
        "--lang",
        "zh",
        "doctor",
        "furnace",
        "--size",
        4,
        4,
        "--spp",
        1,
        "--integrator",
        "direct",
        "--no-jitter",
    )
    assert (
        "无法检验（没有逃逸事件）" in ran.stdout
        and "too few" not in ran.stdout
        and "no escape" not in ran.stdout
    )
