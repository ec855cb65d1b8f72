"""What a time was taken on, and how fast that was just then."""

import os
import platform
import time
import tracemalloc

import numpy as np

from tracer.trace.fingerprint import processor

KERNEL = "exp(-sqrt(x)) of 1e6 float32 numbers in NumPy, mean of 24"
_NUMBERS = 1_000_000
_TIMES = 24  # long enough to notice who else is using the processor


def machine():
    """Processor, its cores, system and versions, by name."""
    return {
        "processor": processor(),
        "cores": os.cpu_count() or 1,
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def kernel_seconds():
    """Seconds of a fixed computation (KERNEL), so that times of different machines and hours can be compared.

    A time divided by it hardly depends on what else the machine was doing.
    """
    x = np.linspace(0.0, 1.0, _NUMBERS, dtype=np.float32)
    y = np.empty_like(x)
    began = time.perf_counter()
    for _ in range(_TIMES):
        np.sqrt(x, out=y)
        np.negative(y, out=y)
        np.exp(y, out=y)
    return (time.perf_counter() - began) / _TIMES


def peak_bytes(work):
    """Most bytes that Python and NumPy held at once during work(), above those held before; of this process
    only. Counting slows the work down, so it is no run to time."""
    outer = tracemalloc.is_tracing()
    if not outer:
        tracemalloc.start(1)
    try:
        tracemalloc.reset_peak()
        before = tracemalloc.get_traced_memory()[0]
        work()
        return tracemalloc.get_traced_memory()[1] - before
    finally:
        if not outer:
            tracemalloc.stop()
