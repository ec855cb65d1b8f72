"""What the bits of a path depend on beside scene and settings: processor, NumPy, castray.

Between kinds of processors and versions of NumPy sin, cos, exp, log and power differ in the last bit, so a
path is promised to be the same bit for bit under one fingerprint only.
"""

import platform
from functools import cache
from importlib import metadata

import numpy as np


@cache
def fingerprint():
    """{what: which}, plain values."""
    return {
        "processor": processor(),
        "machine": platform.machine(),
        "numpy": np.__version__,
        "castray": castray_version(),
    }


def processor():
    """The processor's model name, as the system tells it."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:
            names = [line.partition(":")[2].strip() for line in file if line.startswith("model name")]
    except OSError:
        names = []
    return (names or [platform.processor() or platform.machine()])[0]


def castray_version():
    """The version of castray that is installed, "unknown" where it is run without being installed."""
    try:
        return metadata.version("castray")
    except metadata.PackageNotFoundError:
        return "unknown"


def differences(recorded):
    """What of a recorded fingerprint is different here, as words; empty if nothing is."""
    here = fingerprint()
    return [
        f"{what} {recorded.get(what)!s} there, {here[what]} here"
        for what in here
        if recorded.get(what) != here[what]
    ]
