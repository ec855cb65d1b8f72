"""What the tests of the tracer run over, and which of it is left for the long run."""

import tomllib
from functools import cache

import pytest
from suite import ROOT

import tracer
from tracer.scene_file.objects import SENSORS, SHAPES

SCENES = ("cornell", "cornell_unit", "cornell_glass", "furnace")
INTEGRATORS = ("walk", "direct", "path")


def placed(name, *steps):
    """A built-in scene with these transforms after those of every shape and of the camera."""
    folder = ROOT / "scenes"
    description = tomllib.loads((folder / f"{name}.toml").read_text(encoding="utf-8"))
    for table in description.values():
        if isinstance(table, dict) and table["type"] in (*SHAPES, *SENSORS):
            table["to_world"] = [*table.get("to_world", []), *steps]
    return tracer.load_dict(description, name, folder)


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
