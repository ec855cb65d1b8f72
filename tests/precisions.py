"""Single against double precision, path by path, with the same random numbers.

Two paths are the same if they meet the same primitives, choose the same lobes, get light from the same points
of the same lamps, play roulette alike and end alike; and if their light is the same to 1 %, which it is not
where one of them met the next texel of a picture. Of those that are, light is compared pixel by pixel.
"""

from dataclasses import replace

import numpy as np

from tracer.engine import waves
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave

SIDE, SPP = 32, 16
TELLING = {  # what decides where a path goes, by kind of event
    "hit": lambda c: c["primitive"],
    "light": lambda c: 2 * c["primitive"] + (c["contribution"] > 1e-20).any(axis=0),  # f may underflow
    "bounce": lambda c: c["lobe"],
    "roulette": lambda c: c["survived"],
    "end": lambda c: c["reason"],
}
MIX = np.uint64(6364136223846793005)  # odd and large: no step is forgotten


def walked(scene, settings, steps=RIGHT):
    """A number (N,) that stands for the way each path of a picture took, and its radiance (3, N)."""
    scene = scene.at(settings)
    pixel, sample = np.divmod(np.arange(SIDE * SIDE * SPP), SPP)
    wave = Wave(pixel % SIDE, pixel // SIDE, sample, settings, steps)
    way = np.zeros(pixel.size, np.uint64)
    for event in waves.events(scene, settings, wave):
        if event.kind.name in TELLING:
            chosen = TELLING[event.kind.name](event.columns).astype(np.int64) + 3
            way[event.lane] = way[event.lane] * MIX + chosen.astype(np.uint64)
    assert wave.dropped == 0 and np.isfinite(wave.radiance).all() and (wave.radiance >= 0).all()
    return way, wave.radiance.astype(np.float64)


def compared(scene, settings, steps=RIGHT):
    """Share of paths that go the same way in both precisions, and the mean relative difference of pixels."""
    ways, radiances = zip(
        *(walked(scene, replace(settings, precision=bits), steps) for bits in (32, 64)), strict=True
    )
    off = np.abs(radiances[0] - radiances[1]) > 0.01 * radiances[1]
    same = (ways[0] == ways[1]) & ~off.any(axis=0)
    single, double = ((r * same).reshape(3, -1, SPP).sum(axis=2) for r in radiances)
    lit = double > 0.0
    return same.mean(), np.abs(single[lit] / double[lit] - 1.0).mean()
