"""BENCHMARKS.md: sections between marks, each with what it was measured on."""

import re

from accuracy import commit

from benchmarks.section import SEED
from tracer.testing.machine import KERNEL, machine

HEAD = f"""# Benchmarks

What castray takes in time and memory, written by `make bench` and, for the race with Mitsuba 3, by
`make race`. Each section says what it was measured on, and can be measured again alone, by its name:

```text
python tests/bench.py --again --only NAME
```

Times are medians. *kernel ms* beside a time is what a fixed computation took just before: a time divided
by it can be held against that of another hour or machine. It is
{KERNEL}.
*asked* is what castray asks of itself. No test holds a time.
"""
NOT_YET = "Not measured yet."


def stamp(seed=SEED, size="", **versions):
    """What a section is measured on, in one line; size: said where it is not the full one."""
    about = machine()
    said = [
        f"commit {commit()}",
        f"{about['processor']}, {about['cores']} cores",
        about["system"],
        f"Python {about['python']}",
        f"NumPy {about['numpy']}",
        *(f"{name} {version}" for name, version in versions.items()),
        f"seed {seed}",
        *([size] if size else []),
    ]
    return f"*{'; '.join(said)}*"


def sections_of(path):
    """{key: text between its marks} of a paper; empty where there is none."""
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    return dict(
        re.findall(r"^<!-- (\w+) begins -->\n(.*?)^<!-- \1 ends -->$", text, re.DOTALL | re.MULTILINE)
    )


def section_text(section, stamp, found):
    """What stands between the marks of a section."""
    return f"{_opening(section)}\n\n{stamp}\n\n{found.strip()}\n"


def _opening(section):
    return f"## {section.title}\n\n*`{section.key}`.* {section.about}"


def page(sections, texts):
    """The whole paper: all sections in order, those without a text as not measured."""
    parts = [HEAD]
    for section in sections:
        text = texts.get(section.key) or f"{_opening(section)}\n\n{NOT_YET}\n"
        parts.append(f"<!-- {section.key} begins -->\n{text}<!-- {section.key} ends -->\n")
    return "\n".join(parts)
