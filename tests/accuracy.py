"""Measures how accurate castray is and writes ACCURACY.md: `make accuracy`.

It takes long and may be stopped at any time: each finished chunk is kept in .accuracy/ and not done again.
`--only KEY` does some of the figures; the lines of the others stay as they are.
"""

import argparse
import contextlib
import json
import math
import multiprocessing
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from figures import FAMILIES, figures
from figures.figure import together

ROOT = Path(__file__).resolve().parent.parent
KEPT = ROOT / ".accuracy"
PAPERS = ("ACCURACY.md", "BENCHMARKS.md", "DOCTOR.md")
SEED = 20_231  # chunk k of a figure has the seed SEED + 1000 k
HEAD = f"""# Accuracy

What castray measures of itself, written by `make accuracy`. Beside each figure stands what castray asks of
itself, and what other renderers ask of themselves. Every line can be measured again, by its name:

```text
python tests/accuracy.py --only NAME
```

A figure is the sum of independent chunks; chunk k has the seed {SEED} + 1000 k. N counts rays, paths, samples
or intervals, all chunks together. 0 of N seen means below 3 / N with 95 % confidence. The last column is the
commit that was measured, with a + where files differed from it.
"""
PART = "<!-- {name} -->\n{text}<!-- /{name} -->\n"  # what another command writes into the same page
PARTS = re.compile(r"<!-- (\w+) -->\n.*?<!-- /\1 -->\n", re.DOTALL)
TABLE = """
| name | figure | precision | N | found | asked | others | at |
|---|---|---|---|---|---|---|---|
"""


def commit():
    """The commit that is checked out, with a + if files differ from it; figures in papers do not count."""
    with contextlib.suppress(OSError, subprocess.CalledProcessError):
        git = ["git", "-C", str(ROOT)]
        head = subprocess.run([*git, "rev-parse", "--short=7", "HEAD"], check=True, capture_output=True)
        changed = [*git, "status", "--porcelain", "-uno", "--", ".", *(f":!{paper}" for paper in PAPERS)]
        changed = subprocess.run(changed, check=True, capture_output=True)
        return head.stdout.decode().strip() + "+" * bool(changed.stdout.strip())
    return "?"


def kept(folder, figure):
    """Chunks of a figure that are done: {chunk: its row}."""
    path = folder / f"{figure.key}.jsonl"
    if not path.exists():
        return {}
    done = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        with contextlib.suppress(json.JSONDecodeError):  # a line that was cut short
            row = json.loads(line)
            if row["n"] == figure.n:
                done[row["chunk"]] = row
    return done


def timed(figure, chunk):
    """What a chunk of a figure finds, and the seconds it took."""
    began = time.perf_counter()
    return figure.measure(SEED + 1000 * chunk), time.perf_counter() - began


def elsewhere(key, chunk):
    """timed, in another process: a figure does not travel, its name does."""
    return timed(next(figure for figure in figures() if figure.key == key), chunk)


def results(figure, chunks, pool):
    """(chunk, what it found, seconds) of each chunk, as they are done."""
    if pool is None:
        yield from ((chunk, *timed(figure, chunk)) for chunk in chunks)
        return
    waiting = {pool.submit(elsewhere, figure.key, chunk): chunk for chunk in chunks}
    try:
        yield from ((waiting[done], *done.result()) for done in as_completed(waiting))
    finally:  # stopped: what has not begun is left for the next time
        for chunk in waiting:
            chunk.cancel()


def measure(figure, folder, share=1.0, say=lambda text: None, pool=None):
    """Do the chunks that are missing, `share` of them all: (sums, how many chunks they are of, commits)."""
    folder.mkdir(exist_ok=True)
    chunks = max(1, math.ceil(share * figure.chunks))
    done, at = kept(folder, figure), commit()
    missing = [chunk for chunk in range(chunks) if chunk not in done]
    for chunk, found, seconds in results(figure, missing, pool):
        done[chunk] = {"chunk": chunk, "n": figure.n, "at": at, "seconds": round(seconds, 2), "found": found}
        with (folder / f"{figure.key}.jsonl").open("a", encoding="utf-8") as file:
            file.write("\n" + json.dumps(done[chunk]) + "\n")
        say(f"{figure.key}: {chunk + 1} of {chunks} ({seconds:.1f} s)")
    rows = [done[chunk] for chunk in range(chunks)]
    return together([row["found"] for row in rows]), chunks, sorted({row["at"] for row in rows})


def line(figure, sums, chunks, at=("?",)):
    """A figure's line of the table."""
    text, good = figure.judge(sums, chunks)
    found = text if good else f"**missed**: {text}"
    n = f"{figure.n * chunks:.3g}"
    cells = (f"`{figure.key}`", figure.what, figure.precision, n, found, figure.bar, figure.anchors)
    return "| " + " | ".join((*cells, " ".join(at))) + " |"


def text_of(path):
    """What a file says; nothing if it is not there."""
    return path.read_text(encoding="utf-8") if path.exists() else ""


def lines_of(path):
    """The lines of tables that a file has, by the figures' names."""
    return {found[1]: found[0] for found in re.finditer(r"^\| `([^`]+)` \|.*$", text_of(path), re.MULTILINE)}


def page(lines, old=""):
    """ACCURACY.md from the lines by name; figures without one are left out, families without any too.

    old: the page as it was, whose parts of other commands stay.
    """
    text = HEAD
    for family in FAMILIES:
        rows = [lines[figure.key] for figure in family.figures() if figure.key in lines]
        if rows:
            notes = family.notes() if hasattr(family, "notes") else ""
            text += f"\n## {family.TITLE}\n{TABLE}" + "\n".join(rows) + "\n" + notes
    return text + "".join("\n" + part[0] for part in PARTS.finditer(old))


def put(old, name, text):
    """A page with this text in place of the part of that name, or at its end."""
    new, parts = PART.format(name=name, text=text), [part for part in PARTS.finditer(old) if part[1] == name]
    return old.replace(parts[0][0], new) if parts else f"{old}\n{new}"


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--share", type=float, default=1.0, help="of the chunks of each figure (default: all)")
    words.add_argument("--only", default="", help="figures whose name contains this")
    words.add_argument("--workers", type=int, default=min(2, os.cpu_count() or 1), help="processes")
    words.add_argument("--out", type=Path, default=ROOT / "ACCURACY.md")
    asked = words.parse_args()
    lines = lines_of(asked.out)
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(asked.workers, spawn) if asked.workers > 1 else contextlib.nullcontext() as pool:
        for figure in figures():
            if asked.only in figure.key:
                found = measure(figure, KEPT, asked.share, lambda text: print(text, flush=True), pool)
                lines[figure.key] = line(figure, *found)
                print(lines[figure.key], flush=True)
                asked.out.write_text(page(lines, text_of(asked.out)), encoding="utf-8")
    sys.exit(any("**missed**" in row for row in lines.values()))


if __name__ == "__main__":
    main()
