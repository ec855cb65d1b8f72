"""Which of the zoo's bugs a picture alone tells, into DOCTOR.md: `make picture-table`.

It may be stopped at any time and goes on where it was, as long as the commit is the same.
"""

import argparse
import sys
from pathlib import Path

from accuracy import commit
from doctor_paper import PAPER, keep, kept, write

import tracer
from lessons.zoo import ZOO, alike
from lessons.zoo.pictures import all_at_once, mixtures, stored
from tracer.doctor.picture import LEAST, judged, misfit
from tracer.picture import to_srgb

SIDE, SPP, SEED = 64, 16, 77
SINGLE = [bug.id for bug in ZOO.values() if bug.scene == "cornell" and not bug.only_cost]
TOGETHER = ("E01+D06", "D01+D06", "E01+D01", "D06+R01", "E02+D06", "D10+R01", "B12+D01", "E01+D01+D06")
MADE_OF = {("castray",): ("E01", "D01", "D06")}  # an entry of the zoo that is a mixture
KINDS = ("8 bits", "linear")


def measured(key):
    """One row: which place the bug has among the hypotheses from its picture, in 8 bits and linear."""
    scene, album = tracer.load("cornell"), stored()
    bug = all_at_once([ZOO[name] for name in key.split("+")])
    rgb = tracer.render(scene, bug.asked(width=SIDE, height=SIDE, spp=SPP, seed=SEED), steps=bug.steps).rgb
    row = {"key": key, "shows": key not in album.bugs or shows(album, key)}
    given = (to_srgb(rgb) / 255.0, True, ("srgb", 0.6, 1.0)), (rgb.astype(float), False, (None,))
    for kind, (values, eight_bits, curves) in zip(KINDS, given, strict=True):
        found = judged(values, eight_bits, curves, scene, album, mixtures(scene, ZOO))
        row[kind] = {"rank": rank(found.hypotheses, key), "first": first(found)}
    return row


def shows(album, key):
    """Whether the bug changes a picture of 16 samples per pixel at all."""
    off, _ = misfit(album.rights[0].near(SPP), album.bugs[key].near(SPP))
    return bool(off > LEAST)


def rank(hypotheses, key):
    """Place of the hypothesis that names all of the bugs, or their look-alikes; None where none does."""
    true = MADE_OF.get((key,), key.split("+"))
    for place, h in enumerate(hypotheses, 1):
        told = [MADE_OF.get(h.bugs, h.bugs), *(other.split(" + ") for other in h.alike)]
        if any(_same(bugs, true) for bugs in told):
            return place
    return None


def _same(told, true):
    return len(told) == len(true) and all(alike(bug) & {*told} for bug in true)


def first(found):
    """The first hypothesis in short."""
    if not found.hypotheses:
        return "fits the right picture" if found.is_right else "nothing fits"
    h = found.hypotheses[0]
    others = f" (or {', '.join(h.alike)})" if h.alike else ""
    return f"{h.factor:.3g} times the right one" if h.factor else " + ".join(h.bugs) + others


def line(row):
    """A row of the table."""
    cells = [f"{row[kind]['first']} | {row[kind]['rank'] or '-'}" for kind in KINDS]
    return f"| {row['key'].replace('+', ' + ')} | {'' if row['shows'] else 'no'} | {' | '.join(cells)} |"


def share(rows, most, kind):
    """How many of these rows have the truth among the first few, in words."""
    good = sum((row[kind]["rank"] or 99) <= most for row in rows)
    return f"{good} ({good / max(len(rows), 1):.0%})"


def text(rows):
    """The section."""
    seen = [row for row in rows.values() if row["shows"] and "+" not in row["key"]]
    pairs = [row for row in rows.values() if "+" in row["key"]]
    quiet = [row["key"] for row in rows.values() if not row["shows"]]
    told = "; ".join(
        f"in {kind} {share(seen, 1, kind)} are the first hypothesis and {share(seen, 3, kind)} among the "
        f"first three, of {len(pairs)} mixtures {share(pairs, 1, kind)} and {share(pairs, 3, kind)}"
        for kind in KINDS
    )
    return (
        f"Pictures of the homework's scene, {SIDE} x {SIDE}, {SPP} spp, at commit {commit()}, the number of "
        f"samples unknown to the doctor. {len(seen)} bugs change such a picture: {told}. "
        f"What changes it by no more than noise: {', '.join(quiet) or 'none'}.\n\n"
        "| bug | shows | first hypothesis, 8 bits | place | linear | place |\n"
        "|---|---|---|---|---|---|\n" + "\n".join(line(row) for row in rows.values()) + "\n"
    )


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--only", nargs="*", default=[*SINGLE, *TOGETHER], help="ids, or several with +")
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    done = kept("pictures")
    for key in asked.only:
        if key not in done:
            done[key] = measured(key)
            keep("pictures", done[key])
            print(line(done[key]), flush=True)
    write("pictures", text({key: done[key] for key in (*SINGLE, *TOGETHER) if key in done}), asked.out)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is kept")
