"""How many paths of the gl engine are those of NumPy: `python tests/same_paths.py [SCENE ...]`.

Of each path the first vertices are kept by both: a path is the same if each of them lies on the same
primitive, within 1e-4 of the scene's size, sees its light sample or does not alike, goes on in the same lobe,
and the path ends alike if it ends there. NumPy traces in float32, too.
"""

import sys

import numpy as np

import tracer
from tracer.engine import waves
from tracer.engine.gl.tracing import WATCHED, Tracer
from tracer.events import BOUNCE, END, HIT, LIGHT
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave

NEAR = 1e-4  # of the scene's size
SIDE, SPP = 64, 8
ACCEPTED = tracer.built_in_scenes()


def of_numpy(scene, settings, steps=RIGHT):
    """(number (N, 5, 4), p (N, 5, 3), end (N,)) of all paths of a picture, as Tracer.vertices has them."""
    x, y, samples = _places(settings)
    n = x.size * samples
    number, p = np.zeros((n, WATCHED, 4), np.int32), np.zeros((n, WATCHED, 3), np.float32)
    number[..., 0], end = -1, np.full(n, -1, np.int32)
    sample = np.tile(np.arange(samples), x.size)
    wave = Wave(np.repeat(x, samples), np.repeat(y, samples), sample, settings, steps)
    for event in waves.events(scene, settings, wave):
        kept = np.flatnonzero(event.depth < WATCHED)
        lane, depth = event.lane[kept], event.depth[kept]
        if event.kind is HIT:
            number[lane, depth, 0], number[lane, depth, 3] = event.columns["primitive"][kept], 1
            p[lane, depth] = event.columns["p"][:, kept].T
        elif event.kind is LIGHT:
            number[lane, depth, 2] = 1 + event.columns["visible"][kept]
        elif event.kind is BOUNCE:
            number[lane, depth, 1] = event.columns["lobe"][kept]
        elif event.kind is END:
            end[event.lane] = event.columns["reason"]
    return number, p, end


def of_gl(scene, settings):
    """The same by the gl engine."""
    x, y, samples = _places(settings)
    tracing = Tracer(scene, settings, RIGHT, watched=True)
    tracing.trace(x, y, 0, samples)
    return tracing.vertices(x.size * samples)


def _places(settings):
    y, x = np.divmod(np.arange(settings.width * settings.height), settings.width)
    return x, y, settings.spp


def same(scene, ours, theirs):
    """Whether each path is the same, (N,)."""
    low, high = scene.bounds()
    alike = (ours[0] == theirs[0]).all(axis=(1, 2))
    alike &= (np.abs(ours[1] - theirs[1]) <= NEAR * np.linalg.norm(high - low)).all(axis=(1, 2))
    going_on = ours[0][:, -1, 1] > 0  # after the last vertex kept
    return alike & (going_on | (ours[2] == theirs[2]))


def share(scene, settings):
    """Share of the paths that are the same."""
    settings = settings.at_size_of(scene)
    return same(scene, of_numpy(scene, settings), of_gl(scene, settings)).mean()


def main():
    names = sys.argv[1:] or ACCEPTED
    for name in names:
        scene = tracer.load(name)
        found = share(scene, tracer.Settings(width=SIDE, height=SIDE, spp=SPP))
        print(f"{name}: {found:.4%} of {SIDE * SIDE * SPP} paths are the same", flush=True)


if __name__ == "__main__":
    main()
