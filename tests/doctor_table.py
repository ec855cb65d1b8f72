"""Which of the zoo's bugs the doctor names, and writes them into DOCTOR.md: `make doctor-table`.

It may be stopped at any time and goes on where it was, as long as the commit is the same.
"""

import argparse
import sys
import time
from pathlib import Path

from accuracy import commit
from doctor_paper import PAPER, keep, kept, write

import tracer
from lessons import zoo
from tracer.doctor import examine
from tracer.trace import gather

SIDE, SPP = 64, 16
# What no trace tells from another; the abandoned castRay is the mistakes that it is made of.
ALIKE = {"E04": "E01", "D02": "D01"}
WHOLE = {"castray": {"E01", "D01", "D06"}}
BESIDE = {"castray": {"D08", "D15", "B14", "B15"}}  # smaller mistakes that it has as well


def measured(bug, side=SIDE, spp=SPP):
    """One row: what the doctor says of a bug's trace in its own scene, with its own settings."""
    began = time.perf_counter()
    scene = tracer.load(bug.scene)
    shrink = side / max(scene.width, scene.height)
    width, height = (max(1, round(v * shrink)) for v in (scene.width, scene.height))
    trace = gather(scene, bug.asked(width=width, height=height, spp=spp), bug.steps)
    traced = time.perf_counter()
    diagnosis = examine(trace)
    done = time.perf_counter()
    causes = diagnosis.causes
    right = WHOLE.get(bug.id, {ALIKE.get(bug.id, bug.id)})
    may = right | BESIDE.get(bug.id, set())
    ranks = [k + 1 for k, finding in enumerate(causes) if finding.bug in may]
    found = causes[ranks[0] - 1] if ranks else (causes[0] if causes else None)
    return {
        "key": bug.id,
        "named": list(diagnosis.bugs),
        "all": right <= set(diagnosis.bugs),
        "rank": ranks[0] if ranks else None,
        "rule": found and found.rule,
        "count": found and found.count,
        "checked": found and found.checked,
        "p": found and found.p,
        "vertices": trace.vertices,
        "tracing": traced - began,
        "judging": done - traced,
    }


def line(bug, row):
    """A row of the table."""
    if row is None:
        return f"| {bug.id} | {bug.title} | only time is lost: no trace shows it | | | | |"
    if row["rule"] is None:
        return f"| {bug.id} | {bug.title} | **nothing found** | | | | {row['judging']:.1f} |"
    how = f"p = {row['p']:.1g}" if row["p"] is not None else f"{row['count']} of {row['checked']}"
    named = ", ".join(row["named"]) or "no name"
    rank = row["rank"] if row["all"] and row["rank"] else "**none**"
    return f"| {bug.id} | {bug.title} | {row['rule']} | {how} | {named} | {rank} | {row['judging']:.1f} |"


def text(rows):
    """The section."""
    shown = [row for row in rows.values() if row]
    first = sum(row["rank"] == 1 and row["all"] for row in shown)
    some = sum(row["rule"] is not None for row in shown)
    classes = "; ".join(f"{a} is told as {b}" for a, b in ALIKE.items())
    slow = max((row["judging"] for row in shown), default=0.0)
    head = (
        f"Each bug in its own scene and settings, the longer side {SIDE} pixels, {SPP} spp, at commit "
        f"{commit()}. Of {len(shown)} bugs {some} are found and {first} named first "
        f"({first / max(len(shown), 1):.0%}), up to what no trace tells apart ({classes}). The abandoned "
        f"castRay is right if E01, D01 and D06 are named; D08, D15, B14 and B15, which it has, may be. "
        f"Judging took up to {slow:.0f} s.\n\n"
        "| bug | | law that fires first | events, or chance | named | rank | s |\n"
        "|---|---|---|---|---|---|---|\n"
    )
    return head + "\n".join(line(zoo.ZOO[key], row) for key, row in rows.items()) + "\n"


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--only", nargs="*", default=list(zoo.ZOO), help="ids of bugs")
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    done = kept("table")
    for key in asked.only:
        bug = zoo.ZOO[key]
        if bug.only_cost or key in done:
            continue
        done[key] = measured(bug)
        keep("table", done[key])
        print(line(bug, done[key]), flush=True)
    rows = {key: done.get(key) for key, bug in zoo.ZOO.items() if key in done or bug.only_cost}
    write("table", text(rows), asked.out)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is kept")
