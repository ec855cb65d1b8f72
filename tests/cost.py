"""What a scene pays for features it does not use: cornell_unit by this tree and by another commit.

    python tests/cost.py --against REV [--rounds 30]

NumPy calls and bytes of one wave are counted (tests/counting.py); its time is taken by turns, in processes of
their own. Writes the section "What the features cost" of ACCURACY.md. Take times on a quiet machine.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections import Counter
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from accuracy import ROOT, put, text_of
from counting import DEPTH, SIDE, SPP, TIMES
from scipy import stats

SECTION = """## What the features cost

One wave of `cornell_unit` ({side} x {side}, {spp} samples, `path`, depth {depth}, lamps by area) at {before},
the last commit before materials, lights and meshes beyond the simplest came, and at {now}. Counted are the
calls that the tracer makes to NumPy, operators included, and the bytes of the arrays they return. Time:
{rounds} alternations of the two commits, each the fastest of {times} waves in a process of its own; medians,
and the median of the {rounds} ratios with its 95 % interval.

| per wave | {before} | {now} | ratio |
|---|---|---|---|
| NumPy calls | {calls[0]} | {calls[1]} | {calls_ratio:.3f} |
| bytes of new arrays | {bytes[0]:,} | {bytes[1]:,} | {bytes_ratio:.3f} |
| milliseconds | {ms[0]:.1f} | {ms[1]:.1f} | {ratio:.3f} ({low:.3f} to {high:.3f}) |

{remark} With lamps sampled by solid angle, the default now, a wave makes {default[calls]} calls and
{default[bytes]:,} bytes.

```text
python tests/cost.py --against {before} --rounds {rounds}
```
"""
SAME = "Both walk the same {rays:,} rays."
OTHER = "They walk {rays[0]:,} and {rays[1]:,} rays: the count is not of the same work."


@contextmanager
def checkout(revision):
    """A folder with this revision, for a while."""
    with tempfile.TemporaryDirectory() as folder:
        where = Path(folder) / "castray"
        git("worktree", "add", "--detach", str(where), revision)
        try:
            yield where
        finally:
            git("worktree", "remove", "--force", str(where))


def git(*words):
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        sys.exit(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout.strip()


def child(folder, *words):
    """What tests/counting.py says of a checkout, in a process of its own."""
    command = [sys.executable, str(ROOT / "tests" / "counting.py"), str(folder), *words]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, encoding="utf-8", check=True)
    return json.loads(done.stdout)


def alternations(folders, rounds, say=print):
    """Seconds (rounds, 2) of a wave by turns; which comes first changes from round to round."""
    rows = []
    for k in range(rounds):
        times = {}
        for folder in folders if k % 2 == 0 else folders[::-1]:
            times[folder] = child(folder, "--seconds")
        rows.append([times[folder] for folder in folders])
        say(f"{k + 1} of {rounds}: {rows[-1][0]:.4f} s before, {rows[-1][1]:.4f} s now")
    return np.array(rows)


def interval(values, confidence=0.95):
    """(median, low, high): order statistics between which the median lies with at least that confidence."""
    values, n = np.sort(values), len(values)
    k = int(stats.binom.ppf(0.5 * (1.0 - confidence), n, 0.5))  # ranks k and n + 1 - k, from 1
    k = max(k if stats.binom.cdf(k - 1, n, 0.5) <= 0.5 * (1.0 - confidence) else k - 1, 1)
    return float(np.median(values)), float(values[k - 1]), float(values[n - k])


def section(before, now, counts, times, default):
    """The section from the names of the two commits, their counts, the seconds (rounds, 2), and the count of
    what is the default now."""
    ratio, low, high = interval(times[:, 1] / times[:, 0])
    rays = [count["rays"] for count in counts]
    return SECTION.format(
        side=SIDE,
        spp=SPP,
        depth=DEPTH,
        times=TIMES,
        rounds=len(times),
        before=before,
        now=now,
        calls=[count["calls"] for count in counts],
        calls_ratio=counts[1]["calls"] / counts[0]["calls"],
        bytes=[count["bytes"] for count in counts],
        bytes_ratio=counts[1]["bytes"] / counts[0]["bytes"],
        ms=1e3 * np.median(times, axis=0),
        ratio=ratio,
        low=low,
        high=high,
        default=default,
        remark=SAME.format(rays=rays[0]) if rays[0] == rays[1] else OTHER.format(rays=rays),
    )


def differences(counts):
    """Lines on which module calls what more or less often than before."""
    before, now = (Counter(count["calls_by"]) for count in counts)
    for key in sorted(before.keys() | now.keys()):
        if before[key] != now[key]:
            yield f"{key:44s} {before[key]:6d} {now[key]:6d}"


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--against", required=True, help="a commit of castray")
    words.add_argument("--rounds", type=int, default=30, help="alternations")
    words.add_argument("--out", type=Path, default=ROOT / "ACCURACY.md")
    asked = words.parse_args()
    changed = git("status", "--porcelain", "--", "tracer", "scenes")
    names = (
        git("rev-parse", "--short", asked.against),
        git("rev-parse", "--short", "HEAD") + "+" * bool(changed),
    )
    with checkout(asked.against) as other:
        counts = [child(folder) for folder in (other, ROOT)]
        print(*differences(counts), sep="\n")
        new = section(*names, counts, alternations((other, ROOT), asked.rounds), child(ROOT, "--default"))
    print(new)
    asked.out.write_text(put(text_of(asked.out), "cost", new), encoding="utf-8")


if __name__ == "__main__":
    main()
