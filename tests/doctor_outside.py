"""What the doctor says of mistakes that are in no catalogue (tests/outside), and writes it into DOCTOR.md.

It may be stopped at any time and goes on where it was, as long as the commit is the same.
"""

import argparse
import sys
import time
from pathlib import Path

from accuracy import commit
from doctor_paper import PAPER, keep, kept, write
from outside import MISTAKES

BEFORE = (
    "When they were first tried (commit c75d45b), 7 had a wrong name, in 4 another law fired first. "
    "What was mended since was mended with these at hand, so that new ones would say more."
)


def measured(mistake):
    """One row: what fires first, at how many events, and what it is called."""
    began = time.perf_counter()
    causes = mistake.diagnosed().causes
    first = causes[0] if causes else None
    return {
        "key": mistake.id,
        "rule": first and first.rule,
        "count": first and first.count,
        "checked": first and first.checked,
        "p": first and first.p,
        "explanation": first and first.explanation,
        "right": bool(first and first.rule in mistake.laws),
        "named": [f.bug for f in causes if f.bug],
        "wrong": [f.bug for f in causes if f.bug and f.bug not in mistake.fair],
        "causes": [f.rule for f in causes],
        "seconds": time.perf_counter() - began,
    }


def line(mistake, row):
    """A row of the table."""
    words = f"| {mistake.id} | {mistake.words} "
    if row["rule"] is None:
        return words + "| **nothing found** | | | |"
    how = f"p = {row['p']:.1g}" if row["p"] is not None else f"{row['count']} of {row['checked']}"
    law = row["rule"] if row["right"] else f"**{row['rule']}**"
    named = ", ".join(f"**{bug}**" if bug in row["wrong"] else bug for bug in row["named"])
    return f"{words}| {law} | {how} | {named or 'no name'} | {row['explanation']} |"


def text(rows):
    """The section."""
    pairs = [(MISTAKES[key], row) for key, row in rows.items()]
    found = sum(row["rule"] is not None for _, row in pairs)
    right = sum(row["right"] for _, row in pairs)
    wrong = sum(bool(row["wrong"]) for _, row in pairs)
    fair = sum(bool(row["named"]) and not row["wrong"] for _, row in pairs)
    head = (
        f"Mistakes that the laws were not written for: replaced steps of castray's loop, changed lines of a "
        f"C++ program that logs and of a Python one that is watched, at commit {commit()}. Of {len(pairs)} "
        f"mistakes {found} are found; in {right} the law that fires first is one that a reader would "
        f"call broken. {fair} get a fair name of the catalogue, {wrong} a wrong one. {BEFORE}\n\n"
        "| mistake | | law that fires first | events, or chance | named | what is said |\n"
        "|---|---|---|---|---|---|\n"
    )
    return head + "\n".join(line(mistake, row) for mistake, row in pairs) + "\n"


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--only", nargs="*", default=list(MISTAKES), help="ids of mistakes")
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    done = kept("outside")
    for key in asked.only:
        if key not in done:
            done[key] = measured(MISTAKES[key])
            keep("outside", done[key])
            print(line(MISTAKES[key], done[key]), done[key]["causes"], flush=True)
    write("outside", text({key: done[key] for key in MISTAKES if key in done}), asked.out)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is kept")
