"""Samples that are no light: not a number, infinite or negative, in every scene by every loop."""

from collections import deque
from functools import cache

import numpy as np
from cases import INTEGRATORS, loaded

import tracer
from figures.figure import Figure
from tracer import Settings
from tracer.engine import waves
from tracer.integrator.wave import Wave

TITLE = "Invalid samples"
SIDE, SPP = 64, 4


@cache
def ways():
    """(scene, integrator) of all built-in scenes that the integrator does not refuse."""
    scenes = tracer.built_in_scenes()
    return [(s, i) for s in scenes for i in INTEGRATORS if i != "walk" or not loaded(s).unmeetable]


def _invalid(precision):
    def measure(seed):
        pixel, sample = np.divmod(np.arange(SIDE * SIDE * SPP), SPP)
        found = {"dropped": 0, "negative": 0}
        for name, integrator in ways():
            settings = Settings(
                width=SIDE, height=SIDE, spp=SPP, seed=seed, precision=precision, integrator=integrator
            )
            wave = Wave(pixel % SIDE, pixel // SIDE, sample, settings)
            deque(waves.events(loaded(name).at(settings), settings, wave), maxlen=0)
            found["dropped"] += wave.dropped
            found["negative"] += int((wave.radiance < 0.0).any(axis=0).sum())
        return found

    return measure


def figures():
    for precision in (32, 64):
        n = len(ways()) * SIDE * SIDE * SPP

        def judge(sums, chunks, n=n):
            seen, all_of_them = sums["dropped"] + sums["negative"], n * chunks
            text = f"{seen / all_of_them * 1e9:.3g}" if seen else f"0 (< {3e9 / all_of_them:.3g})"
            return f"{text} per 1e9", not seen

        yield Figure(
            f"invalid-{precision}",
            f"samples that are NaN, infinite or negative: {len(ways())} pairs of scene and loop",
            "0",
            "logged, not published",
            f"float{precision}",
            180,
            n,
            _invalid(precision),
            judge,
        )
