"""How long `castray doctor` takes for a million vertices, and how much memory, and writes it into DOCTOR.md.

A recording of castray's own, and logs that tests/cpp/castray_box.cpp prints with 9 digits and with 6; all of
them right. The time is that of the whole process.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from accuracy import ROOT, commit
from doctor_paper import PAPER, write

from tracer.testing.machine import kernel_seconds, machine
from tracer.trace.jsonl import header_file

SIDE, SPP = 160, 16  # the homework's box: 1.06 million vertices
ASKED = "30 s, 2 GB"
HOMEWORK = (
    "--integrator",
    "direct",
    "--hemisphere",
    "uniform",
    "--roulette",
    "0.8",
    "--light-sampling",
    "area",
)
COMMAND = (sys.executable, "-m", "viewer.cli")


def recording(folder, side):
    """Words for `castray doctor` on a recording that castray made."""
    size = ("--size", side, side, "--spp", SPP)
    where = ("--record", folder / "box", "--record-level", "events")
    run(*COMMAND, "render", "cornell", *HOMEWORK, *size, *where, "-o", folder / "box.png")
    return [folder / "box"]


def printed(digits):
    """The same for a log of a C++ program, with so many digits."""

    def made(folder, side):
        program, log = folder / "box", folder / "box.jsonl"
        shape = (f"-DPICTURE={side}", f"-DSAMPLES={SPP}", f"-DCASTRAY_DIGITS={digits}")
        source = ROOT / "tests" / "cpp" / "castray_box.cpp"
        compiler = shutil.which("g++") or shutil.which("clang++") or "g++"
        run(
            compiler,
            "-std=c++11",
            "-O2",
            "-pthread",
            *shape,
            "-I",
            header_file().parent,
            source,
            "-o",
            program,
        )
        run(program, "none", 2, 3, env=os.environ | {"CASTRAY_LOG": str(log), "CASTRAY_PIXELS": "all"})
        return [log, "--scene", "cornell"]

    return made


WAYS = {"castray's recording": recording, "C++, %.9g": printed(9), "C++, %.6g": printed(6)}


def run(*words, **more):
    """A program to its end."""
    subprocess.run(list(map(str, words)), check=True, cwd=ROOT, stdout=subprocess.DEVNULL, **more)


def judged(words):
    """What `castray doctor` takes and says: {seconds, cpu, bytes, said, findings}."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as out:
        began = time.perf_counter()
        child = subprocess.Popen([*COMMAND, "doctor", *map(str, words)], cwd=ROOT, stdout=out)
        _, status, used = os.wait4(child.pid, 0)
        seconds, child.returncode = time.perf_counter() - began, os.waitstatus_to_exitcode(status)
        out.seek(0)
        said = out.readline().strip()
    unit = 1 if sys.platform == "darwin" else 1024
    return {
        "seconds": seconds,
        "cpu": used.ru_utime + used.ru_stime,
        "bytes": used.ru_maxrss * unit,
        "said": said,
        "code": child.returncode,
    }


def line(name, size, found, kernel):
    """A row of the table."""
    vertices = found["said"].rpartition(", ")[2]
    says = {0: "none", 1: "**some**"}.get(found["code"], "**failed**")
    return (
        f"| {name} | {size / 1e6:.0f} | {vertices} | {found['seconds']:.1f} | {found['cpu']:.1f} | "
        f"{1e3 * kernel:.2f} | {found['bytes'] / 1e9:.2f} | {says} |"
    )


def measured(side=SIDE):
    """The section."""
    rows = []
    for name, make in WAYS.items():
        with tempfile.TemporaryDirectory() as folder:
            words = make(Path(folder), side)
            files = [words[0], *words[0].rglob("*")]
            size = sum(file.stat().st_size for file in files if file.is_file())
            kernel = kernel_seconds()
            found = judged(words)
            rows.append(line(name, size, found, 0.5 * (kernel + kernel_seconds())))
            print(rows[-1], flush=True)
    here = machine()
    return (
        f"Right traces of the homework's box, {side} x {side}, {SPP} spp, at commit {commit()}; asked: "
        f"{ASKED}. {here['processor']}, {here['cores']} cores; the kernel of "
        "BENCHMARKS.md tells how busy they were.\n\n"
        "| log | MB | | s | s of processor | kernel ms | GB at most | findings |\n"
        "|---|---|---|---|---|---|---|---|\n" + "\n".join(rows) + "\n"
    )


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--side", type=int, default=SIDE, help="pixels of the square picture")
    words.add_argument("--out", type=Path, default=PAPER)
    asked = words.parse_args()
    write("large", measured(asked.side), asked.out)


if __name__ == "__main__":
    main()
