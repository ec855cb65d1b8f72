"""How often the doctor finds something in a right trace, and writes it into DOCTOR.md.

Every scene, three integrators, both precisions, seed after seed, until each scene has --paths paths. It may
be stopped at any time and goes on where it was, as long as the commit is the same.
"""

import argparse
import sys
from itertools import count, product
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
_SINGLE = {rule.id for rule in LAWS}


def plan(scenes):
    """Yield (key, scene, settings) without end: one trace of each scene, way and precision a round."""
    for turn in count():
        for scene, (number, way), precision in product(scenes, enumerate(WAYS), (32, 64)):
            if way.get("integrator") == "walk" and tracer.load(scene).unmeetable:
                continue
            settings = tracer.Settings(
                width=SIDE, height=SIDE, spp=SPP, seed=SEED + turn, precision=precision, **way
            )
            yield f"{scene} {number} {precision} {turn}", scene, settings


def measured(key, scene, settings):
    """One row: what was found in a right trace."""
    trace = gather(tracer.load(scene), settings)
    diagnosis = examine(trace)
    return {
        "key": key,
        "scene": scene,
        "paths": trace.size,
        "events": sum(v.checked for v in diagnosis.rules if v.rule.id in _SINGLE),
        "abstained": sum(v.abstained for v in diagnosis.rules),
        "single": [f.rule for f in diagnosis.findings if f.rule in _SINGLE],
        "many": [f.rule for f in diagnosis.findings if f.rule not in _SINGLE],
    }


def text(rows):
    """The section."""
    scenes = sorted({row["scene"] for row in rows})
    traces, wrong = len(rows), sum(bool(row["many"]) for row in rows)
    most = int(binom.ppf(0.999, traces, ALPHA))
    lines = [
        f"Right traces of {SIDE} x {SIDE} pixels and {SPP} spp at commit {commit()}: three integrators, both "
        f"precisions, seeds from {SEED} on. {traces} traces, in {wrong} of them a statistical law fired; "
        f"with a chance of {ALPHA:g} each, up to {most} are to be expected (99.9 %).",
        "",
        "| scene | paths | checks of single events | abstained | findings | traces | statistical findings |",
        "|---|---|---|---|---|---|---|",
    ]
    for scene in scenes:
        here = [row for row in rows if row["scene"] == scene]
        total = {name: sum(row[name] for row in here) for name in ("paths", "events", "abstained")}
        single, many = (sum(len(row[name]) for row in here) for name in ("single", "many"))
        lines.append(
            f"| {scene} | {total['paths']:.3g} | {total['events']:.3g} | "
            f"{total['abstained'] / total['events']:.1e} | {single} | {len(here)} | {many} |"
        )
    return "\n".join(lines) + "\n"


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--paths", type=float, default=1e6, help="paths of each scene")
    words.add_argument("--scenes", nargs="*", default=list(tracer.built_in_scenes()))
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    done = kept("alarms")
    try:
        measure(asked.scenes, asked.paths, done)
    finally:
        if done:
            write("alarms", text([row for row in done.values() if row["scene"] in asked.scenes]), asked.out)


def measure(scenes, most, done):
    """Put rows into `done` until each scene has `most` paths."""
    paths = dict.fromkeys(scenes, 0)
    for key, scene, settings in plan(scenes):
        if min(paths.values()) >= most:
            break
        if paths[scene] >= most:
            continue
        if key not in done:
            done[key] = measured(key, scene, settings)
            keep("alarms", done[key])
            if done[key]["single"] or done[key]["many"]:
                print(f"{key}: {done[key]['single']} {done[key]['many']}", flush=True)
        paths[scene] += done[key]["paths"]


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is in the paper")
