"""Numbers as a function: the same path again, another seed; what happens where they are shared or frozen."""

from collections import deque
from dataclasses import replace

import numpy as np

import tracer
from lessons.zoo import RIGHT, changed
from tracer.engine import waves
from tracer.integrator.wave import Wave

SPP = 1024
SIZE, HOMEWORK_SPP = 784, 16  # the homework's picture
COUNTED = 32  # pixels a side of the picture whose numbers are counted


def experiment(run):
    """Means, correlations between neighbours, and how many numbers a picture takes."""
    at = run.lesson.moments["start"]
    alone = tracer.inspect(run.scene(), run.settings(), at.x, at.y, sample=at.path)
    assert np.array_equal(alone.value, run.path("start").radiance)  # the same path without its company

    one, two = samples(run, "start"), samples(run, "seed")
    assert abs(one.mean() - two.mean()) < 5.0 * np.hypot(one.std(), two.std()) / np.sqrt(SPP)
    right, shared = (correlation(run, m) for m in ("beside", "neighbour"))
    assert abs(right) < 5.0 / np.sqrt(SPP) and shared > 0.5

    frozen = samples(run, "frozen")
    assert frozen.std() < 1e-3 * frozen.mean()
    numbers = numbers_of_a_path(run)
    picture = numbers * SIZE * SIZE * HOMEWORK_SPP
    return {
        "mean": one.mean(),
        "other_mean": two.mean(),
        "error": one.std() / np.sqrt(SPP),
        "samples": SPP,
        "right_correlation": abs(right),
        "shared_correlation": shared,
        "frozen_mean": frozen.mean(),
        "numbers": numbers,
        "size": SIZE,
        "spp": HOMEWORK_SPP,
        "millions": picture / 1e6,
        "of_one_sample": picture / HOMEWORK_SPP / 1e6,
        "of_paths": SIZE * SIZE * HOMEWORK_SPP / 1e6,
        "of_one_side": picture / SIZE / 1e6,
        "words": np.random.MT19937(0).state["state"]["key"].size,
    }


def samples(run, moment):
    """Radiance of each sample, green channel; fewer where paths are long and all alike."""
    spp = 16 if moment == "frozen" else SPP
    return run.wave(moment, spp=spp).radiance[1].astype(float)


def correlation(run, moment):
    """Between the samples of a moment's pixel and those of the first one, with the same bug or none."""
    other = run.wave(moment, spp=SPP)
    settings = replace(other.settings, bug=None)
    at, steps = run.lesson.moments["start"], other.steps
    first = traced(run, np.full(SPP, at.x), np.full(SPP, at.y), np.arange(SPP), settings, steps)
    return float(np.corrcoef(first.radiance[1], other.radiance[1])[0, 1])


def traced(run, x, y, sample, settings, steps=RIGHT):
    """A Wave of any pixels that is done."""
    wave = Wave(x, y, sample, settings, steps)
    deque(waves.events(run.scene(), settings, wave), maxlen=0)
    return wave


def numbers_of_a_path(run):
    """Random numbers that a path of the homework's picture takes, on average."""
    drawn = []

    def counting(draw, pixel, sample, depth, use):
        drawn.append((u := draw(pixel, sample, depth, use)).size)
        return u

    y, x = np.divmod(np.arange(COUNTED * COUNTED), COUNTED)
    settings = replace(run.settings(), width=COUNTED, height=COUNTED)
    traced(run, x, y, np.zeros(x.size), settings, changed(random=counting))
    return sum(drawn) / x.size
