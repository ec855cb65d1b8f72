"""The table of exact values, tests/truth.json, and how near castray has to come to them.

What castray makes of a value is in tests/values, by subject; tests/tracer/test_truth.py holds it to the
bars here, and ACCURACY.md says how near it came.
"""

import json
from pathlib import Path

TRUTH = {
    entry["key"]: entry
    for entry in json.loads((Path(__file__).parent / "truth.json").read_text(encoding="utf-8"))
}
RELATIVE = 1e-12  # what a deterministic kernel may be off in float64
ULPS = 4  # and in float32, where a form exists that does not lose digits
SIGMAS = 4.0  # standard errors that an estimate may be off
PERCENT = 0.01  # and those may be at most so much of the value

# Entries that are themselves wrong, with what is right.
MISPRINTS = {
    # The table took erf(a) for 1 (it is 1 - 2.6e-79): here with 250 digits, by the series of erf.
    "point.beckmann.side.a=0.1.Lambda_i": 3.65604918693851448e-82,
}

# Values that nothing in castray gives: key (or its beginning) and why.
UNTESTED: dict[str, str] = {}

# Kernels that miss RELATIVE in float64 or ULPS in float32: by the key's beginning the bar they keep, and why.
EXCEPTIONS = {
    64: {
        "fresnel.diel.air_1+1e-7.": (
            2e-9,
            "no float64 is 1.0000001: the nearest is off by 1e-9 of the index less 1, and R goes with "
            "its square; at that index R is right to 1e-12",
        ),
        "critical.": (
            5e-5,
            "the cosine is 1e-12 above the critical one, and a float64 rounds it by 1e-16, 1e-4 of that; "
            "1 - R goes with the root",
        ),
    },
    32: {
        "point.beckmann.aniso.": (
            32,
            "exp(-23): half an ulp of the normal, as float32 rounds it, is 12 ulp of D",
        ),
        "schlick.maxerr.": (16, "a difference: what it is of is eight times as large, and so are its ulp"),
    },
}


def untested(key):
    """Why a key is not tested, None if it is."""
    return next((why for start, why in UNTESTED.items() if key.startswith(start)), None)


def bar(key, bits):
    """What a kernel may be off: relative in float64, ulp in float32."""
    usual = {64: RELATIVE, 32: ULPS}[bits]
    return next((bar for start, (bar, _) in EXCEPTIONS[bits].items() if key.startswith(start)), usual)


def keys(*starts):
    """The keys that begin with one of these."""
    return [key for key in TRUTH if key.startswith(starts)]


def entry(key):
    """(parameters, value) of a key."""
    return TRUTH[key]["parameters"], MISPRINTS.get(key, TRUTH[key]["value"])


def close(got, want, relative=RELATIVE):
    """Whether a number is what it should be, but for rounding."""
    return abs(float(got) - want) <= relative * abs(want)
