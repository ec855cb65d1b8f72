"""`import tracer` costs hardly more than `import numpy`."""

import statistics
import subprocess
import sys

import pytest
from suite import ROOT

LIMIT = 0.05  # seconds more than numpy
RUNS = 9


def seconds(module):
    """Time to import a module in a fresh interpreter, as that interpreter measures it."""
    code = f"import time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, encoding="utf-8", check=True
    )
    return float(done.stdout)


@pytest.mark.timed
def test_importing_the_tracer_takes_hardly_longer_than_numpy():
    """Medians of 9 runs each, alternating."""
    seconds("tracer")  # writes the byte code
    pairs = [(seconds("numpy"), seconds("tracer")) for _ in range(RUNS)]
    numpy, tracer = (statistics.median(times) for times in zip(*pairs, strict=True))
    used = statistics.median(
        seconds("tracer; [getattr(tracer, n) for n in tracer.__all__]") for _ in range(RUNS)
    )
    print(f"numpy {numpy:.3f} s, tracer {tracer:.3f} s, with every public name used {used:.3f} s")
    assert tracer - numpy <= LIMIT
