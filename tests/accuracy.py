"""Measures how accurate castray is and writes ACCURACY.md: `make accuracy`.

It takes hours and may be stopped at any time: each finished chunk is kept in .accuracy/ and not done again.
"""

import argparse
import contextlib
import json
import math
import sys
import time
from pathlib import Path

from figures import figures

ROOT = Path(__file__).resolve().parent.parent
SEED = 20_231  # chunk k of a figure has the seed SEED + 1000 k
HEAD = """# Accuracy

What castray measures of itself, written by `make accuracy`; every line can be measured again by the command
under the table. Beside each figure stands what castray asks of itself, and what other renderers ask of
themselves. 0 of N seen means below 3 / N with 95 % confidence. Chunk k has the seed {seed} + 1000 k.

| figure | precision | N | found | asked | others | |
|---|---|---|---|---|---|---|
"""


def kept(folder, figure):
    """Chunks of a figure that are done: {chunk: numbers}."""
    path = folder / f"{figure.key}.jsonl"
    if not path.exists():
        return {}
    done = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        with contextlib.suppress(json.JSONDecodeError):  # a line that was cut short
            row = json.loads(line)
            if row["n"] == figure.n:
                done[row["chunk"]] = row["found"]
    return done


def measure(figure, folder, share=1.0, say=lambda text: None):
    """Do the chunks that are missing, `share` of them all; the sums and how many chunks they are of."""
    folder.mkdir(exist_ok=True)
    chunks = max(1, math.ceil(share * figure.chunks))
    done = kept(folder, figure)
    for chunk in range(chunks):
        if chunk in done:
            continue
        began = time.perf_counter()
        done[chunk] = figure.measure(SEED + 1000 * chunk)
        with (folder / f"{figure.key}.jsonl").open("a", encoding="utf-8") as file:
            file.write("\n" + json.dumps({"chunk": chunk, "n": figure.n, "found": done[chunk]}) + "\n")
        say(f"{figure.key}: {chunk + 1} of {chunks} ({time.perf_counter() - began:.1f} s)")
    rows = [done[chunk] for chunk in range(chunks)]
    return {
        name: (max if name.startswith("most") else sum)(row[name] for row in rows) for name in rows[0]
    }, chunks


def line(figure, sums, chunks):
    """A figure's line of the table."""
    text, good = figure.judge(sums, chunks)
    cells = (figure.what, figure.precision, f"{figure.n * chunks:.3g}", text, figure.bar, figure.anchors)
    return "| " + " | ".join((*cells, "" if good else "**missed**")) + " |"


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--share", type=float, default=1.0, help="of the chunks of each figure (default: all)")
    words.add_argument("--only", default="", help="figures whose key contains this")
    words.add_argument("--out", type=Path, default=ROOT / "ACCURACY.md")
    asked = words.parse_args()
    lines = []
    for figure in figures():
        if asked.only in figure.key:
            sums, chunks = measure(
                figure, ROOT / ".accuracy", asked.share, lambda text: print(text, flush=True)
            )
            lines.append(line(figure, sums, chunks))
            print(lines[-1], flush=True)
    command = " ".join(("python tests/accuracy.py", *sys.argv[1:]))
    text = HEAD.format(seed=SEED) + "\n".join(lines) + f"\n\n```text\n{command}\n```\n"
    asked.out.write_text(text, encoding="utf-8")
    sys.exit(any("**missed**" in row for row in lines))


if __name__ == "__main__":
    main()
