"""The table of exact values, tests/truth.json, for the formulas that a tracer evaluates."""

import json
from pathlib import Path

TRUTH = {
    entry["key"]: entry
    for entry in json.loads((Path(__file__).parent / "truth.json").read_text(encoding="utf-8"))
}
RELATIVE = 1e-12  # what a deterministic kernel may be off in float64
ULPS = 4  # and in float32, where a form exists that does not lose digits

# Entries that are themselves wrong, with what is right.
MISPRINTS = {
    # The table took erf(a) for 1 (it is 1 - 2.6e-79): here with 250 digits, by the series of erf.
    "point.beckmann.side.a=0.1.Lambda_i": 3.65604918693851448e-82,
}


def keys(*starts):
    """The keys that begin with one of these."""
    return [key for key in TRUTH if key.startswith(starts)]


def entry(key):
    """(parameters, value) of a key."""
    return TRUTH[key]["parameters"], MISPRINTS.get(key, TRUTH[key]["value"])


def close(got, want, relative=RELATIVE):
    """Whether a number is what it should be, but for rounding."""
    return abs(float(got) - want) <= relative * abs(want)
