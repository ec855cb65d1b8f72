"""Stress case S08: a closed white room in a sky so bright that one ray which finds a way out is seen."""

from functools import cache

import numpy as np
from continuation import camera_in, rooms

from tracer import Settings
from tracer.bsdf.diffuse import Diffuse
from tracer.definition import Definition, Surface
from tracer.engine import waves
from tracer.integrator.wave import Wave
from tracer.light.constant import Constant
from tracer.scene import Scene

SKY = 1e6


@cache
def white_room(place, name="box"):
    """The scene: walls that reflect all light and send none, and a `constant` environment."""
    surfaces = tuple(Surface(shape, "white") for shape in rooms(place)[name]())
    sky = (Constant("sky", np.full(3, SKY)),)
    white = {"white": Diffuse(np.ones((3, 1)))}
    return Scene(Definition(name, surfaces, white, camera_in(place), 8, 8, emitters=sky))


def segments(place, precision, seed, side=100, depth=50, integrator="path", name="box"):
    """Trace side x side paths of `depth` segments without roulette; how many there were, and the light that
    arrived over SKY, and paths that ended before."""
    settings = Settings(
        width=side, height=side, spp=1, max_depth=depth, roulette="off", integrator=integrator, seed=seed,
        precision=precision,
    )  # fmt: skip
    pixel = np.arange(side * side)
    wave = Wave(pixel % side, pixel // side, np.zeros(side * side), settings)
    count = early = 0
    for event in waves.events(white_room(place, name).at(settings), settings, wave):
        if event.kind.name == "hit":
            count += event.lane.size
        if event.kind.name == "escape":
            early += event.lane.size
    return {"segments": count, "lit": float(wave.radiance.sum() / SKY) + early}
