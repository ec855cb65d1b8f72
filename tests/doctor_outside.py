"""What the doctor says of mistakes that are in no catalogue (tests/outside), and writes it into DOCTOR.md.

It may be stopped at any time and goes on where it was, as long as the commit is the same.
"""

import argparse
import json
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
AT_FIRST = {  # before any mending of the doctor (second batch), of the programs (fourth)
    "fresh": Path(__file__).parent / "outside" / "at_first.json",
    "fourth": Path(__file__).parent / "outside" / "fourth_at_first.json",
}
AS_COMMITTED = (
    "At first (doctor of commit 5187594) each of the right programs had a finding, so little could be "
    "said of mistakes: {counted}. {rights} Two of the three were called broken wrongly, by roulette "
    "that is not played at the first vertices (roulette-played: one probability that is read off is "
    "demanded everywhere) and by a direct light of 0 that is logged at mirrors (light-due). The third "
    "one's log was no right one: bounce.u had two numbers and not three, as `castray log` said, and "
    "the lamp's radiance stood there for points behind it (E06); with a lobe's number that is always "
    "0 it was called P02. In the second one, rays left the room by its corners, which was found with "
    "doubles (on-surface). Then the programs were changed so that the right ones get through, and "
    "what the doctor took amiss was kept as rows of its own: besides these two, roulette that is "
    "logged before the bounce (roulette-played), weights of 0 where nothing can arrive "
    "(light-weight), and light samples that are logged at matt surfaces only, in a log of terms "
    "(roulette-share: paths that end at mirrors were not counted). Measured at commit 00de0f1, of 36 "
    "mistakes 35 were found, in 32 by a law foretold and first, 1 had a fair name, none a wrong one; 7 of "
    "15 right programs had a finding. Those seven were mended with these programs at hand."
)
SECTIONS = {"outside": ("first", "fresh"), "fourth": ("fourth",)}
PUT_RIGHT = (
    "One of the four was R01 for the right program. Before that count the laws that a reader would accept "
    "were put right for six of them (bounce-cos, directions-beside, absorbed; D03 where all that blocks is "
    "let through), and two that crashed the program itself were made to end. What was mended since was "
    "mended with these at hand."
)
HEADS = {
    "first": (
        "Mistakes that the laws were not written for: replaced steps of castray's loop, changed lines of a "
        "C++ program that logs and of a Python one that is watched, at commit {commit}."
    ),
    "fresh": (
        "A second batch, written when all of the first had been mended and before the laws were read again: "
        "more steps, another C++ program (MIS, doubles, glass and mirror, one record of what the caller "
        "knows), more lines of Python; one of them is a right program. At commit {commit}."
    ),
    "fourth": (
        "A Python program with two light samples a vertex (two-rays), a C++ one of closures, mirrors "
        "and a ball for a lamp (corridor; the last five mistakes with points, rays and terms logged "
        "only) and a flat loop in NumPy that writes events, with MIS and two lamps (shed): 36 "
        "mistakes and the right programs, written from README.md, the starter and the log's page "
        "alone, by somebody who had read neither the laws nor the tables above, and committed before "
        "they were measured."
    ),
}


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
        "named": [f.bug for f in causes if f.bug],
        "causes": [f.rule for f in causes],
        "seconds": time.perf_counter() - began,
    }


def is_right(mistake, row):
    """Whether what fires first is a law that a reader would call broken; nothing, where nothing is."""
    return row["rule"] in mistake.laws if mistake.laws else row["rule"] is None


def wrong_names(mistake, row):
    """Ids that are no fair name for it."""
    return [bug for bug in row["named"] if bug not in mistake.fair]


def counted(pairs):
    """How many mistakes are found, in how many a right law fires first, and what they are called."""
    found = sum(row["rule"] is not None for mistake, row in pairs if mistake.laws)
    right = sum(is_right(mistake, row) for mistake, row in pairs if mistake.laws)
    fair = sum(bool(row["named"]) and not wrong_names(mistake, row) for mistake, row in pairs)
    wrong = sum(bool(wrong_names(mistake, row)) for mistake, row in pairs)
    return (
        f"of {sum(bool(mistake.laws) for mistake, _ in pairs)} mistakes {found} are found; in {right} the "
        f"law that fires first is one that a reader would call broken. {fair} get a fair name of the "
        f"catalogue, {wrong} a wrong one"
    )


def right_programs(pairs):
    """How many programs without a mistake are called broken."""
    rows = [row for mistake, row in pairs if not mistake.laws]
    return f"Of {len(rows)} right programs {sum(row['rule'] is not None for row in rows)} have a finding."


def line(mistake, row, at_first=None):
    """A row of the table; at_first: None for no such column, empty where it was not there then."""
    words = f"| {mistake.id} | {mistake.words} "
    before = "" if at_first is None else f"| {_said(mistake, at_first) if at_first else ''} "
    if row["rule"] is None:
        return f"{words}| {_said(mistake, row)} | {before}| |"
    how = f"p = {row['p']:.1g}" if row["p"] is not None else f"{row['count']} of {row['checked']}"
    return f"{words}| {_said(mistake, row)} | {how} {before}| {row['explanation']} |"


def _said(mistake, row):
    """The law that fires first and the names, what is wrong in bold."""
    law = row["rule"] or "nothing found"
    law = law if is_right(mistake, row) else f"**{law}**"
    bad = wrong_names(mistake, row)
    return ", ".join((law, *(f"**{bug}**" if bug in bad else bug for bug in row["named"])))


def text(rows, batches=("first", "fresh")):
    """A section: its batches, those first that were written first."""
    parts = []
    for batch in batches:
        pairs = [(MISTAKES[key], row) for key, row in rows.items() if MISTAKES[key].batch == batch]
        if not pairs:
            continue
        at_first = json.loads(AT_FIRST[batch].read_text(encoding="utf-8")) if batch in AT_FIRST else {}
        column = " at first |" if at_first else ""
        parts.append(
            f"{_said_of_all(batch, pairs, at_first)}\n\n"
            f"| mistake | | law that fires first, names | events, or chance |{column} what is said |\n"
            f"|---|---|---|---|{'---|' if at_first else ''}---|\n"
            + "\n".join(line(m, row, at_first.get(m.id, {}) if at_first else None) for m, row in pairs)
            + "\n"
        )
    return "\n".join(parts)


def _said_of_all(batch, pairs, at_first):
    """What stands before a batch's table."""
    head, now = HEADS[batch].format(commit=commit()), counted(pairs)
    then = [(MISTAKES[key], row) for key, row in at_first.items() if MISTAKES[key].batch == batch]
    if batch == "fourth":
        as_committed = AS_COMMITTED.format(counted=counted(then), rights=right_programs(then))
        return f"{head}\n\n{as_committed}\n\nAt commit {commit()}, {now}. {right_programs(pairs)}"
    if batch == "fresh":
        when = f"When they were first tried (commit 173aed9), {counted(then)}. {PUT_RIGHT}"
        return f"{head} Now {now}. {when}"
    return f"{head} Now {now}. {BEFORE}"


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
    rows = {key: done[key] for key in MISTAKES if key in done}
    for section, batches in SECTIONS.items():
        if said := text(rows, batches):
            write(section, said, asked.out)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is kept")
