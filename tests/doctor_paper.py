"""DOCTOR.md: sections that commands measure, between marks, each with the commit that was measured."""

import json
import re
from pathlib import Path

from accuracy import commit

ROOT = Path(__file__).resolve().parent.parent
PAPER = ROOT / "DOCTOR.md"
KEPT = ROOT / ".doctor"
HEAD = """# The doctor, measured

`castray doctor SCENE` traces a picture, keeps every event, and holds the laws of light transport against
them; what breaks one is named, shown and can be replayed. Commands write this page, section by section.
"""
SECTIONS = {
    "table": ("Bugs of the zoo", "make doctor-table"),
    "pictures": ("From a picture alone", "make picture-table"),
    "alarms": ("False alarms", "make false-alarms"),
    "outside": ("Bugs outside the catalogue", "python tests/doctor_outside.py"),
    "third": ("A third batch outside the catalogue", ""),
    "fourth": ("A fourth batch outside the catalogue", "python tests/doctor_outside.py"),
    "tried": ("Tried as a new user", ""),
    "large": ("A million vertices", "python tests/large_logs.py"),
}
_SECTION = "<!-- {name} -->\n{text}<!-- /{name} -->\n"


def sections(text):
    """Name -> text of the sections of a page."""
    return dict(re.findall(r"<!-- (\w+) -->\n(.*?)<!-- /\1 -->\n", text, re.DOTALL))


def write(name, text, paper=PAPER):
    """Put a section into the page and keep the others."""
    there = sections(paper.read_text(encoding="utf-8")) if paper.exists() else {}
    there[name] = text
    parts = [HEAD]
    for key, (title, command) in SECTIONS.items():
        if key in there:
            by = f"By `{command}`.\n\n" if command else ""  # two are by hand
            parts.append(f"\n## {title}\n\n{by}{_SECTION.format(name=key, text=there[key])}")
    paper.write_text("".join(parts), encoding="utf-8")


def kept(name):
    """What a command found before at this commit, {key: row}; files that differ from it count."""
    file = KEPT / f"{name}-{commit()}.jsonl"
    if "+" in file.name or not file.exists():
        return {}
    rows = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines() if line.endswith("}")]
    return {row["key"]: row for row in rows}


def keep(name, row):
    """Remember a row {"key": ..., ...}."""
    KEPT.mkdir(exist_ok=True)
    with (KEPT / f"{name}-{commit()}.jsonl").open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")
