"""Measures what castray takes in time and memory and writes BENCHMARKS.md: `make bench`.

It may be stopped at any time: a section that is done is in the paper, and is not measured again at the same
commit on the same machine. `--only KEY` does some of the sections; the others stay as they are.
"""

import argparse
import sys
import time
from pathlib import Path

from benchmarks import BENCH, VIEWER
from benchmarks.paper import page, section_text, sections_of, stamp
from benchmarks.section import FULL, TINY
from racing import RACE

ROOT = Path(__file__).resolve().parent.parent
PAPER = ROOT / "BENCHMARKS.md"


def say(line):
    """Progress, where somebody watches."""
    if sys.stderr.isatty():
        print(f"\r\033[K{line}", end="", file=sys.stderr, flush=True)


def bench(out, only="", again=False, size=FULL, sections=BENCH):
    """Measure the sections whose key contains `only` and keep each in the paper as soon as it is done."""
    for section in sections:
        if only not in section.key:
            continue
        texts, mark = sections_of(out), stamp(size="" if size == FULL else "a trial of the machinery")
        if not again and "+" not in mark.split(";")[0] and mark in texts.get(section.key, ""):
            print(f"{section.key}: is measured at this commit; --again measures it again", flush=True)
            continue
        began = time.perf_counter()
        found = section.measure(size, say)
        texts[section.key] = section_text(section, mark, found)
        out.write_text(page((*BENCH, VIEWER, RACE), texts), encoding="utf-8")
        say("")
        print(f"{section.key}: {time.perf_counter() - began:.0f} s\n\n{found}\n", flush=True)


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--only", default="", help="sections whose key contains this")
    words.add_argument("--again", action="store_true", help="measure what is measured at this commit, too")
    words.add_argument("--tiny", action="store_true", help="a few pixels only, to see that all works")
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    bench(asked.out, asked.only, asked.again, TINY if asked.tiny else FULL)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; the sections that are done are in the paper")
