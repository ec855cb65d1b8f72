"""Both engines on the same scenes, by turns."""

import os
import time
from functools import partial
from unittest.mock import patch

import same_paths

import tracer
from benchmarks.scenes import ball, box_with
from benchmarks.section import in_turn, settings, short, table
from tracer.engine import processes
from tracer.engine.gl.device import is_hardware, renderer
from tracer.engine.gl.tracing import Tracer
from tracer.integrator.steps import RIGHT

SCENES = ("cornell_unit", "cornell", "furnace", "cornell_glass", "sky")
HARDWARE = "a graphics card"
SOFTWARE = "the processor itself, on all its cores: no graphics card was there"


def measure(size, say):
    """Paths per second, how long the shader takes to be ready, and how many paths are the same."""
    scenes = {name: tracer.load(name) for name in SCENES}
    scenes["the unit box with 20,480 triangles"] = box_with(ball(5))
    rows = [_row(name, scene, settings(size), size.repeats, say) for name, scene in scenes.items()]
    return f"{table(rows)}\n\nOpenGL is drawn by {HARDWARE if is_hardware() else SOFTWARE} ({renderer()})."


def _row(name, scene, asked, repeats, say):
    say(name)
    cores = os.cpu_count() or 1
    began = time.perf_counter()
    Tracer(scene, asked, RIGHT)
    ready = time.perf_counter() - began
    ways = {"NumPy, one process": {}, f"NumPy, {cores} processes": {"workers": cores}, "gl": {"engine": "gl"}}
    times = in_turn({way: partial(_seconds, scene, asked, more) for way, more in ways.items()}, repeats, say)
    paths = asked.spp * asked.width * asked.height
    return {
        "scene": name,
        **{f"{way}, paths/s": short(paths / t.median) for way, t in times.items()},
        "shader ready, s": short(ready),
        "same paths": f"{same_paths.share(scene, asked):.3%}",
        "kernel ms": times["gl"].kernel,
    }


def _seconds(scene, asked, more):
    with patch.object(processes, "WORTH_A_START", -1.0):  # children are up, as in a longer render
        return tracer.render(scene, asked, **more).seconds
