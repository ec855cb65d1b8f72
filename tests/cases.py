"""What the tests of the tracer run over, and which of it is left for the long run."""

from functools import cache

import pytest

import tracer

SCENES = ("cornell", "cornell_unit", "cornell_glass", "furnace")
INTEGRATORS = ("walk", "direct", "path")


@cache
def loaded(name):
    """A built-in scene, read once."""
    return tracer.load(name)


def slow_but(values, *quick):
    """`values` as parameters of a test, all but `quick` ones marked slow."""
    return [
        v if v in quick else pytest.param(*(v if isinstance(v, tuple) else (v,)), marks=pytest.mark.slow)
        for v in values
    ]
