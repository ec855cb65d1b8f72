"""What the doctor says a broken law looks like is said in Chinese, too."""

import ast
import re

import pytest
from suite import ROOT

from tracer.doctor import LAWS, statistics
from viewer.words import Speaker

FOLDER = ROOT / "tracer" / "doctor" / "naming"
ENGLISH = r"\b(?!beta)[a-z]{4,} [a-z]{2,}"
OF_FACTORS = ("factors.py",)  # its words are put together: below, as they are said


def said():
    """Every explanation in the modules that name mistakes, with 7 for what is filled in."""
    for file in sorted(FOLDER.glob("*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        inner = {id(part) for node in ast.walk(tree) for part in _parts(node)}
        for node in ast.walk(tree):
            text = _text(node) if id(node) not in inner else None
            if text and " " in text.strip() and file.name not in OF_FACTORS and text[0] != " ":
                yield text


def _parts(node):
    """What is no text of its own: pieces of another, and docstrings."""
    if isinstance(node, ast.JoinedStr):
        return [part for part in ast.walk(node) if part is not node]
    documented = isinstance(node, (ast.Module, ast.FunctionDef, ast.ClassDef))
    return [node.body[0].value] if documented and ast.get_docstring(node) else []


def _text(node):
    if isinstance(node, ast.JoinedStr):
        return "".join(v.value if isinstance(v, ast.Constant) else "7" for v in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


@pytest.mark.parametrize("text", sorted(set(said())))
def test_an_explanation_leaves_no_english_in_chinese(text):
    told = Speaker("zh").clue(text)
    assert not re.search(ENGLISH, told), told
    assert Speaker("en").clue(text) == text


def test_english_that_has_no_chinese_is_seen():
    """The test above can fail."""
    assert re.search(ENGLISH, Speaker("zh").clue("nobody has said this yet"))


def test_an_equation_keeps_its_numbers():
    assert Speaker("zh").clue("recorded = right x cos^2 / r") == "记录值 = 正确值 x cos^2 / r"


COUNTED = (
    "light samples at depth 2 bring 1.207 times what they should",
    "the environment at depth 5 and more bring 0.5 times what they should",
    "the picture is 1.3 times as bright as it should be; how often each lamp is chosen",
    "paths have 1.2 times as many vertices as they should",
    "first coordinate of points on triangle lamps", "points on sphere lamps",
    "places on the film lie -0.25 pixels beside the middle of theirs in x",
    "how often directions from gold lead on", "the picture is stretched by 1.03 in y",
    "second coordinate of points on each of the quad lamps",
    "how often each face of a lamp is chosen", "number 1 for light and number 2 for bsdf",
    "number 2 for bsdf at neighbouring rows of pixels", "numbers 2 and 3 for roulette",
    "the numbers for light: 3 different ones at 100 vertices", "the half vectors of directions from gold",
    "the variance of samples is 3.1 times the right tracer's", "red and green are right, the rest not",
    "recorded = right x pi / cos of the light sample", "red and blue are exchanged; only on gold",
    "as if cos cos_light / r^2 were never more than 8e-06",
)  # fmt: skip


@pytest.mark.parametrize("text", COUNTED)
def test_what_many_events_show_leaves_no_english_in_chinese(text):
    told = Speaker("zh").clue(text)
    assert not re.search(r"\b(?!cos|gold|bsdf)[a-z]{3,}", told), told


def test_every_formula_with_words_and_every_quantity_has_its_chinese():
    say = Speaker("zh")
    for rule in (*LAWS, *statistics.RULES):
        told = say.formula(rule.id, rule.formula)
        assert not re.search(r"[a-z]{2,} [a-z]{2,} [a-z]{2,}", told), (rule.id, told)
        assert set(re.findall(r"[a-z]+_[a-z]+", told)) <= set(re.findall(r"[a-z]+_[a-z]+", rule.formula))
    for file in sorted((ROOT / "tracer" / "doctor" / "laws").glob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            called = isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Outcome"
            for part in (*node.args, *(k.value for k in node.keywords)) if called else ():
                if isinstance(part, ast.Constant) and re.search("[a-z]{2,} [a-z]", str(part.value)):
                    assert say.quantity(part.value) != part.value
