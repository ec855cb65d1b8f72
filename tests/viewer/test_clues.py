"""What the doctor says a broken law looks like is said in Chinese, too."""

import ast
import re

import pytest
from suite import ROOT

from viewer.words import Speaker

FOLDER = ROOT / "tracer" / "doctor" / "naming"
ENGLISH = r"\b(?!beta)[a-z]{4,} [a-z]{2,}"
OF_FACTORS = ("factors.py",)  # its words are quantities: the f, cos, pdf of the event


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
