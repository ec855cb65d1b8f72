"""Random numbers."""

import numpy as np

from lessons.zoo.bug import HOMEWORK, Bug

FROZEN = 0.5617  # what a deterministic std::random_device gives a float of [0, 1)


def engine_per_number(draw, pixel, sample, depth, use):
    """For every number an engine is seeded and thrown away; the numbers are the right ones."""
    u = draw(pixel, sample, depth, use)
    for _ in range(u.size):
        np.random.MT19937(0)
    return u


def frozen(draw, pixel, sample, depth, use):
    """All numbers are equal."""
    return np.full_like(draw(pixel, sample, depth, use), FROZEN)


def shared_by_neighbours(draw, pixel, sample, depth, use):
    """Two pixels beside each other get the same numbers."""
    return draw(pixel & ~np.uint32(1), sample, depth, use)


BUGS = (
    Bug(
        "P01",
        "Random generator built for every number",
        "The picture is right and takes many times as long.",
        "std::random_device device; std::mt19937 engine(device()); inside the function that gives one number",
        "I19: what a number costs",
        {"random": engine_per_number},
        only_cost=True,
    ),
    Bug(
        "P02",
        "Generator that always starts alike",
        "A hard picture without noise, or none at all: the roulette never ends a path.",
        "the same on a system where random_device is deterministic: each engine's first number is the same",
        "I15: random numbers are uniform and independent, each used once",
        {"random": frozen},
        settings=HOMEWORK | {"max_depth": 32},
        endless=True,
    ),
    Bug(
        "P03",
        "One generator shared by threads",
        "Neighbouring pixels have the same noise, so that it looks like bands or pairs.",
        "static std::mt19937 engine, called from all threads",
        "I15: random numbers are uniform and independent, each used once",
        {"random": shared_by_neighbours},
        note="Pixels go in pairs; a real race is slow as well, and different each time.",
    ),
    Bug(
        "P07",
        "Unoptimised build",
        "The picture is right and takes about five times as long.",
        "cmake without CMAKE_BUILD_TYPE=Release, or a debug build",
        "I19: what a path costs",
        {},
        only_cost=True,
        note="A build has no step that could be replaced: this entry changes nothing.",
    ),
)
