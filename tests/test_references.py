"""Every (Author Year) in the code has its full entry in REFERENCES.md, and no entry is idle."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
NAME = r"[A-Z][\w'\u2019-]+"
CITATION = re.compile(rf"({NAME})((?:, {NAME})*,? and {NAME}| et al\.)?,? \(?((?:18|19|20)\d\d)\b(?!-\d\d)")
WRAP = re.compile(r"\s*\n\s*(?:#|//|\*)?\s*")  # a citation may run over the end of a comment's line


def citations(text):
    """Every work cited in a text, as `Author Year`, `Author and Author Year` or `Author et al. Year`."""
    for first, others, year in CITATION.findall(WRAP.sub(" ", text)):
        if others.startswith(","):
            others = " et al."
        yield f"{first}{others} {year}"


def cited():
    """{work: a file that cites it} over the whole code."""
    suffixes = (".py", ".toml", ".js", ".html", ".css")
    paths = [
        p
        for folder in ("tracer", "viewer", "lessons", "scenes", "tests")
        for p in (ROOT / folder).rglob("*.*")
    ]
    return {
        work: path.relative_to(ROOT).as_posix()
        for path in paths
        if path.suffix in suffixes and path != Path(__file__)
        for work in citations(path.read_text(encoding="utf-8"))
    }


def entries():
    """The works that have an entry."""
    return set(
        re.findall(r"^- \*\*(.+?)\*\*", (ROOT / "REFERENCES.md").read_text(encoding="utf-8"), re.MULTILINE)
    )


def test_every_citation_has_an_entry():
    missing = {work: where for work, where in cited().items() if work not in entries()}
    assert not missing


def test_every_entry_is_cited():
    assert not entries() - cited().keys()


@pytest.mark.parametrize(
    ("text", "works"),
    [
        ("the cone (Veach 1997, 9.2).", ["Veach 1997"]),
        ("(Duff et al.\n# 2017)", ["Duff et al. 2017"]),
        ("(Ize 2013; Shirley and Chiu 1997)", ["Ize 2013", "Shirley and Chiu 1997"]),
        ("watertight (Woop, Benthin and Wald 2013)", ["Woop et al. 2013"]),
        ("rows 1997 to 2013, NumPy 2.4", []),
    ],
)
def test_citations_are_found(text, works):
    assert list(citations(text)) == works
