"""Whole processes of both programs, from the shell to a PNG, by turns."""

import os
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.programs import COMMAND
from benchmarks.section import Times, short, table
from suite import ROOT

from racing.contestant import libllvm
from racing.judging import ratio
from racing.scene import for_mitsuba
from tracer.testing.machine import kernel_seconds

MITSUBA = """
import sys
import mitsuba as mi
variant, scene, spp, out = sys.argv[1:]
mi.set_variant(variant)
mi.util.write_bitmap(out, mi.render(mi.load_file(scene), spp=int(spp)))
"""


def works(xml, side, depth, spp, variants, folder):
    """{what: (command, environment)}."""
    out, theirs = folder / "out.png", folder / "mitsuba.xml"
    theirs.write_text(for_mitsuba(xml.read_text(encoding="utf-8"), side, depth), encoding="utf-8")
    words = ("render", xml, "--size", side, side, "--spp", spp, "--max-depth", depth, "-o", out)
    found = {"castray": ([sys.executable, *COMMAND, *map(str, words)], {})}
    for variant in variants:
        command = [sys.executable, "-c", MITSUBA, variant, str(theirs), str(spp), str(out)]
        llvm = {"DRJIT_LIBLLVM_PATH": libllvm()} if "llvm" in variant else {}
        found[variant] = command, llvm
        if llvm:  # compiled kernels are kept below the home folder
            found[f"{variant}, nothing compiled before"] = command, llvm | {"HOME": "fresh"}
    return found


def measure(xml, side, depth, spp, variants, repeats, say):
    """The table, with castray's time over each of the others'."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        found = works(xml, side, depth, spp, variants, folder)
        times = {name: Times() for name in found}
        for k in range(-1, repeats):  # the first round warms up the disk
            for name, (command, environment) in found.items():
                say(f"shell to PNG, {name}: {k + 1} of {repeats}")
                kernel, took = kernel_seconds(), _timed(command, environment, folder)
                if k >= 0:
                    times[name].kernels.append(kernel)
                    times[name].seconds.append(took)
    ours = dict(enumerate(times["castray"].seconds))
    rows = []
    for name, t in times.items():
        over = "" if name == "castray" else str(ratio(ours, dict(enumerate(t.seconds))))
        asked = "at most 0.5" if over and (name == "scalar_rgb" or name.endswith("before")) else ""
        rows.append(
            {
                "program": name,
                "seconds": short(t.median),
                "kernel ms": t.kernel,
                "castray's over it": over,
                "asked": asked,
            }
        )
    return f"### From the shell to a PNG, {side} x {side}, {spp} spp\n\n{table(rows)}"


def _timed(command, environment, folder):
    """Seconds of a whole process; a HOME of "fresh" is an empty folder."""
    import subprocess

    with tempfile.TemporaryDirectory(dir=folder) as fresh:
        environment = {name: fresh if value == "fresh" else value for name, value in environment.items()}
        began = time.perf_counter()
        done = subprocess.run(
            command,
            cwd=ROOT,
            env={**os.environ, **environment},
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        took = time.perf_counter() - began
    if done.returncode:
        raise RuntimeError(f"{command[:3]}: {done.stderr}")
    return took
