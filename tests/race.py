"""Races castray against Mitsuba 3 on cornell_unit and writes it into BENCHMARKS.md: `make race`.

It may be stopped at any time: pieces of the reference and finished rounds (one seed of all contestants) are
kept in .race/ and not done again at the same commit. Needs Mitsuba (pip install -e '.[peers]') and, for
llvm_ad_rgb, LLVM's library (Debian: libllvm19).
"""

import argparse
import contextlib
import hashlib
import importlib.util
import json
import sys
import tempfile
import time
from itertools import zip_longest
from pathlib import Path

from accuracy import commit
from bench import BENCH, PAPER, say
from benchmarks import VIEWER
from benchmarks.paper import page, section_text, sections_of, stamp
from racing import RACE, truth, whole
from racing.contestant import Contestant, Refused, libllvm
from racing.judging import Entry, Race, Row

import tracer
from tracer.engine.plan import GOALS
from tracer.settings import Settings
from tracer.testing.machine import kernel_seconds

KEPT = Path(__file__).resolve().parent.parent / ".race"
VARIANTS = ("scalar_rgb", "llvm_ad_rgb")
SAMPLERS = ("independent", "stratified", "multijitter", "orthogonal", "ldsampler")


def entries(programs):
    """Every Entry of castray and of the Mitsuba variants among the programs.

    castray samples the lamp by area, which is enough there and costs less, and with its best sampler by solid
    angle, too, as it does unless told.
    """
    found = [Entry("castray", sampler, adaptive) for sampler in _choices("sampler") for adaptive in GOALS]
    found += [Entry("castray", "lattice", adaptive, "solid_angle") for adaptive in GOALS[:2]]
    return found + [Entry(program, sampler) for program in programs[1:] for sampler in SAMPLERS]


def _choices(setting):
    return Settings.__dataclass_fields__[setting].metadata["choices"]


def how(entry):
    """The options of an Entry as its contestant takes them."""
    if entry.program != "castray":
        return {"sampler": entry.sampler}
    more = {"adaptive": entry.adaptive} if entry.is_adaptive else {}
    return {"sampler": entry.sampler, "light_sampling": entry.lamps} | more


def started(asked, xml, folder):
    """{program: Contestant}, castray first."""
    words = (xml, asked.side, asked.depth, asked.workers)
    found = {"castray": Contestant("castray_child.py", words, folder)}
    for variant in asked.variants:
        more = {"DRJIT_LIBLLVM_PATH": libllvm()} if "llvm" in variant else {}
        found[variant] = Contestant("mitsuba_child.py", (*words, variant), folder, **more)
    return found


def warmed(contestants, some, spps, warm):
    """{Entry: numbers of samples it takes}, after each has been warmed up; what is refused is said."""
    taken = {}
    for entry in some:
        taken[entry], until = [], time.perf_counter() + warm
        for spp in spps:
            say(f"warming up: {entry.name}, {spp} spp")
            try:
                contestants[entry.program].render(spp, 0, **how(entry))
                taken[entry].append(spp)
            except Refused as why:
                print(f"{entry.name}, {spp} spp: left out: {why}", flush=True)
        while taken[entry] and time.perf_counter() < until:
            contestants[entry.program].render(max(taken[entry]), 0, **how(entry))
    return {entry: found for entry, found in taken.items() if found}


def rounds(contestants, taken, reference, seeds, kept):
    """All rows, seed by seed; those of finished rounds are read from `kept`, new ones added to it."""
    rows = read(kept)
    for seed in seeds:
        done = {(row.entry, row.spp) for row in rows if row.seed == seed}
        wanted = [
            (entry, spp) for spp in _all_spps(taken) for entry in by_turns(taken) if spp in taken[entry]
        ]
        if done >= set(wanted):
            continue
        fresh = []
        for entry, spp in wanted:
            say(f"seed {seed} of {seeds[-1]}: {entry.name}, {spp} spp")
            kernel = kernel_seconds()
            made = contestants[entry.program].render(spp, seed, **how(entry))
            errors = reference.errors(made.rgb)
            fresh.append(Row(entry, spp, seed, made.seconds, kernel, made.paths, *errors))
        rows = [row for row in rows if row.seed != seed] + fresh
        with kept.open("a", encoding="utf-8") as file:
            file.writelines(json.dumps(row) + "\n" for row in fresh)
    return [row for row in rows if row.seed in seeds and row.spp in taken.get(row.entry, ())]


def _all_spps(taken):
    return sorted({spp for spps in taken.values() for spp in spps})


def by_turns(some):
    """Entries so that the programs take turns."""
    by_program = {}
    for entry in some:
        by_program.setdefault(entry.program, []).append(entry)
    return [entry for turn in zip_longest(*by_program.values()) for entry in turn if entry is not None]


def read(path):
    """Rows that were kept; of a round that was done twice the last."""
    found = {}
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        with contextlib.suppress(json.JSONDecodeError):  # a line that was cut short
            entry, *rest = json.loads(line)
            row = Row(Entry(*entry), *rest)
            found[row.entry, row.spp, row.seed] = row
    return list(found.values())


def race(asked, folder):
    """The text of the section, and whether both programs draw the same picture."""
    xml = folder / "cornell_unit.xml"
    tracer.export(tracer.load("cornell_unit"), xml)
    key = f"{xml.read_text(encoding='utf-8')} {asked.side} {asked.depth} {asked.piece_spp}"
    KEPT.mkdir(exist_ok=True)
    contestants = started(asked, xml, folder)
    try:
        longs = {}
        theirs = contestants[asked.variants[-1]]
        for name, one, options in (
            ("castray", contestants["castray"], {"sampler": "independent"}),
            ("mitsuba", theirs, {"sampler": "multijitter"}),
        ):
            longs[name] = truth.LongRender(KEPT / f"{name}.npz", key)
            truth.grow(longs[name], one, asked.pieces, asked.piece_spp, options, say)
        test, reference = truth.agreement(*longs.values()), truth.reference(*longs.values())
        text = [_agreement(test, reference, asked)]
        print(text[0], flush=True)
        if test.same:
            at = commit()
            kept = KEPT / f"{hashlib.sha256(f'{key} {at} {asked.workers}'.encode()).hexdigest()[:16]}.jsonl"
            if "+" in at:
                kept.unlink(missing_ok=True)  # files have changed since the commit: nothing is known of them
            taken = warmed(contestants, entries(tuple(contestants)), (1, *asked.spps), asked.warm)
            rows = rounds(contestants, taken, reference, range(1, asked.seeds + 1), kept)
            text.append(Race(rows).tables())
        version = theirs.version
    finally:
        for one in contestants.values():
            one.close()
    if test.same:
        text.append(
            whole.measure(xml, asked.side, asked.depth, asked.whole_spp, asked.variants, asked.repeats, say)
        )
    return "\n\n".join(text), test.same, version


def _agreement(test, reference, asked):
    """What the long renders say of each other."""
    said = "the same picture but for noise" if test.same else "DIFFERENT pictures: no race"
    side, Z = asked.side, ", ".join(f"{v:+.2f}" for v in test.Z)
    return (
        f"{side} x {side}, depth {asked.depth}, box filter, {asked.workers} processes or threads,\n"
        f"seeds 1 to {asked.seeds}. Long renders of {asked.pieces * asked.piece_spp:,} spp by each program\n"
        f"show {said} (p = {test.p_value:.2g}, bias Z = {Z});\n"
        f"the MSE of their mean, {reference.mse:.2g} (relMSE {reference.rel_mse:.2g}), is taken off every\n"
        f"error."
    )


def missing(variants):
    """What is not there, in one line; empty if all is."""
    if importlib.util.find_spec("mitsuba") is None:
        return "Mitsuba is missing: pip install -e '.[peers]'"
    if any("llvm" in variant for variant in variants) and not libllvm():
        return "LLVM's library is missing: install libllvm19, or race with --variants scalar_rgb"
    return ""


def options(words=None):
    """The options of the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=12, help="rounds, at least 2")
    parser.add_argument("--spps", type=int, nargs="+", default=[16, 64, 256])
    parser.add_argument("--side", type=int, default=128)
    parser.add_argument("--depth", type=int, default=8)
    parser.add_argument("--workers", type=int, default=2, help="castray's processes and Mitsuba's threads")
    parser.add_argument("--variants", nargs="+", default=list(VARIANTS), choices=VARIANTS)
    parser.add_argument("--pieces", type=int, default=32, help="of each long render")
    parser.add_argument("--piece-spp", type=int, default=1024)
    parser.add_argument("--warm", type=float, default=3.0, help="seconds each warms up; pools start then")
    parser.add_argument("--whole-spp", type=int, default=64)
    parser.add_argument("--repeats", type=int, default=9, help="of the whole processes")
    parser.add_argument("--out", type=Path, default=PAPER)
    return parser.parse_args(words)


def main():
    asked = options()
    lacking = missing(asked.variants)
    if lacking:
        sys.exit(lacking)
    with tempfile.TemporaryDirectory() as folder:
        found, same, version = race(asked, Path(folder))
    texts = sections_of(asked.out)
    texts[RACE.key] = section_text(RACE, stamp("1 and on", Mitsuba=version), found)
    asked.out.write_text(page((*BENCH, VIEWER, RACE), texts), encoding="utf-8")
    say("")
    print(found, flush=True)
    sys.exit(not same)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; what is done is kept in .race/")
