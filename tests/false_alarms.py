"""How often the doctor finds something in a right trace, and writes it into DOCTOR.md.

Every scene, three integrators, both precisions: a cell each. Laws of single events are held against --paths
paths of each cell, statistical ones against its first --rounds traces. It may be stopped at any time and goes
on where it was, as long as the commit is the same.
"""

import argparse
import contextlib
import math
import multiprocessing
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path

from accuracy import commit
from doctor_paper import PAPER, keep, kept, write
from scipy.stats import binom

import tracer
from tracer.doctor import LAWS, examine
from tracer.doctor.statistics.cells import ALPHA
from tracer.trace import gather

SIDE, SPP = 32, 16
SEED = 40_000
WAYS = (
    {},
    {"integrator": "direct", "hemisphere": "uniform", "roulette": "0.8", "light_sampling": "area"},
    {"integrator": "walk"},
)
_SINGLE = frozenset(rule.id for rule in LAWS)


def plan(scenes, paths, rounds):
    """Yield (key, scene, settings, all laws or those of single events): traces of each cell in turn until it
    has so many paths; each trace has a seed of its own round."""
    cells = [
        (scene, number, way, precision)
        for scene, (number, way), precision in product(scenes, enumerate(WAYS), (32, 64))
        if way.get("integrator") != "walk" or not tracer.load(scene).unmeetable
    ]
    for turn in range(max(rounds, math.ceil(paths / (SIDE * SIDE * SPP)))):
        for scene, number, way, precision in cells:
            settings = tracer.Settings(
                width=SIDE, height=SIDE, spp=SPP, seed=SEED + turn, precision=precision, **way
            )
            yield f"{scene} {number} {precision} {turn}", scene, settings, None if turn < rounds else _SINGLE


def measured(key, scene, settings, only=None):
    """One row: what was found in a right trace; many: None where no statistical law was asked."""
    trace = gather(tracer.load(scene), settings)
    diagnosis = examine(trace, only)
    return {
        "key": key,
        "scene": scene,
        "paths": trace.size,
        "events": sum(v.checked for v in diagnosis.rules if v.rule.id in _SINGLE),
        "abstained": sum(v.abstained for v in diagnosis.rules),
        "single": [f.rule for f in diagnosis.findings if f.rule in _SINGLE],
        "many": None if only else [f.rule for f in diagnosis.findings if f.rule not in _SINGLE],
    }


def text(rows):
    """The section."""
    scenes = sorted({row["scene"] for row in rows})
    asked = [row for row in rows if row["many"] is not None]
    wrong = sum(bool(row["many"]) for row in asked)
    most = int(binom.ppf(0.999, len(asked), ALPHA))
    cells = {row["key"].rpartition(" ")[0]: 0 for row in rows}
    for row in rows:
        cells[row["key"].rpartition(" ")[0]] += row["paths"]
    lines = [
        f"Right traces of {SIDE} x {SIDE} pixels and {SPP} spp at commit {commit()}: three integrators, both "
        f"precisions, seeds from {SEED} on. Each of the {len(cells)} cells has at least "
        f"{min(cells.values()):.3g} paths. The statistical laws were held against {len(asked)} traces; one "
        f"fired in {wrong} of them; with a chance of {ALPHA:g} each, up to {most} are expected (99.9 %).",
        "",
        "| scene | cells | paths | checks of events | abstained | findings | traces | statistical findings |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for scene in scenes:
        here = [row for row in rows if row["scene"] == scene]
        total = {name: sum(row[name] for row in here) for name in ("paths", "events", "abstained")}
        single = sum(len(row["single"]) for row in here)
        many = [len(row["many"]) for row in here if row["many"] is not None]
        lines.append(
            f"| {scene} | {sum(cell.startswith(f'{scene} ') for cell in cells)} | {total['paths']:.3g} | "
            f"{total['events']:.3g} | {total['abstained'] / total['events']:.1e} | {single} | {len(many)} | "
            f"{sum(many)} |"
        )
    return "\n".join(lines) + "\n"


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--paths", type=float, default=1e6, help="paths of each cell")
    words.add_argument("--rounds", type=int, default=3, help="traces of each cell for the statistical laws")
    words.add_argument("--scenes", nargs="*", default=list(tracer.built_in_scenes()))
    words.add_argument("--workers", type=int, default=min(2, os.cpu_count() or 1), help="processes")
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    done = kept("alarms")
    todo = list(plan(asked.scenes, asked.paths, asked.rounds))
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(asked.workers, spawn) if asked.workers > 1 else contextlib.nullcontext() as pool:
        try:
            measure([task for task in todo if task[0] not in done], done, pool)
        except KeyboardInterrupt:
            if pool:
                pool.shutdown(cancel_futures=True)
            raise
        finally:
            if done:
                write(
                    "alarms", text([row for row in done.values() if row["scene"] in asked.scenes]), asked.out
                )


def measure(todo, done, pool):
    """Put a row of each task into `done`."""
    tasks = zip(*todo, strict=True) if todo else ([], [], [], [])
    for row in pool.map(measured, *tasks) if pool else map(measured, *tasks):
        done[row["key"]] = row
        keep("alarms", row)
        if row["single"] or row["many"]:
            print(f"{row['key']}: {row['single']} {row['many']}", flush=True)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is in the paper")
