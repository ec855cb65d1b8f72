"""How long it takes from the shell: to start, to import, and to a picture on disk."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from suite import ROOT

from benchmarks.section import DEPTH, in_turn, short, table

COMMAND = ("-m", "viewer.cli")
IMPORTS = ("numpy", "tracer", "tracer; [getattr(tracer, name) for name in tracer.__all__]")


def run(*words):
    """A Python of ours with these words, to its end; what it printed."""
    done = subprocess.run(
        [sys.executable, *map(str, words)], cwd=ROOT, capture_output=True, encoding="utf-8", check=False
    )
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def importing(module):
    """Seconds of an import, as a fresh interpreter measures it."""
    code = f"import time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
    return float(run("-c", code))


def start(size, say):
    """`castray --help`, and imports, by turns."""
    works = {
        "python -c pass": lambda: run("-c", "pass"),
        "castray --help": lambda: run(*COMMAND, "--help"),
        "import numpy": lambda: importing(IMPORTS[0]),
        "import tracer": lambda: importing(IMPORTS[1]),
        "import tracer, all public names used": lambda: importing(IMPORTS[2]),
    }
    times = in_turn(works, size.starts, say)
    more = times["import tracer"].median - times["import numpy"].median
    asked = {"castray --help": "0.3 s", "import tracer": "numpy + 0.03 s"}
    rows = [
        {
            "what": f"`{name}`",
            "seconds": f"{t.median:.3f}",
            "kernel ms": t.kernel,
            "asked": asked.get(name, ""),
        }
        for name, t in times.items()
    ]
    return f"{table(rows)}\n\n`import tracer` takes {1e3 * more:+.1f} ms more than `import numpy`."


def whole(size, say):
    """`castray render` as a process of its own, from the shell to the PNG."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.png"

        def render(scene, side, spp):
            began = time.perf_counter()
            run(
                *COMMAND, "render", scene, "--size", side, side, "--spp", spp, "--max-depth", DEPTH, "-o", out
            )
            return time.perf_counter() - began

        works = {one: lambda one=one: render(*one) for one in size.wholes}
        times = in_turn(works, size.whole_repeats, say)
    asked = {("cornell", 784, 16): "8 s"}
    return table(
        [
            {
                "scene": one[0],
                "pixels": f"{one[1]} x {one[1]}",
                "spp": one[2],
                "seconds": short(t.median),
                "kernel ms": t.kernel,
                "asked": asked.get(one, ""),
            }
            for one, t in times.items()
        ]
    )
