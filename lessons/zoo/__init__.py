"""The bug zoo: mistakes that nearly everyone makes once, each a few lines that replace a step of the loop.

    picture = tracer.render(scene, settings, steps=zoo.steps("E01"))

Ids are stable: links, recordings and lessons name them.
"""

from dataclasses import replace

from lessons.zoo import (
    abandoned,
    bounce,
    directions,
    emission,
    film,
    geometry,
    glass,
    light,
    material,
    normals,
    numbers,
    roulette,
)
from lessons.zoo.bug import Bug
from tracer.integrator.steps import RIGHT
from tracer.settings import TracerError

FAMILIES = {
    "Lamps that are met": emission.BUGS,
    "Light samples": light.BUGS,
    "Bounces": bounce.BUGS,
    "wi and wo": directions.BUGS,
    "Normals and frames": normals.BUGS,
    "Materials": material.BUGS,
    "Glass and mirrors": glass.BUGS,
    "Rays and hits": geometry.BUGS,
    "Roulette": roulette.BUGS,
    "Random numbers and cost": numbers.BUGS,
    "From samples to the picture": film.BUGS,
    "All at once": abandoned.BUGS,
}
ZOO = {bug.id: bug for bugs in FAMILIES.values() for bug in bugs}

# Mistakes that no recording tells apart: they give the same numbers, or none at all.
ALIKE = (frozenset(("E01", "E04")), frozenset(("D01", "D02")), frozenset(("P01", "P07")))

__all__ = ["ALIKE", "FAMILIES", "RIGHT", "ZOO", "Bug", "alike", "changed", "of", "planted", "steps"]


def alike(bug_id):
    """The ids of the bugs that no recording tells from this one, itself among them."""
    return next((group for group in ALIKE if bug_id in group), frozenset((bug_id,)))


def of(bug_id):
    """The Bug with this id. Raises TracerError with the ids there are."""
    if bug_id not in ZOO:
        raise TracerError(f"bug: {bug_id!r} is not in the zoo; there are {', '.join(ZOO)}")
    return ZOO[bug_id]


def steps(bug_id):
    """The Steps of a tracer with this bug. Raises TracerError with the ids there are."""
    return of(bug_id).steps


def planted(settings):
    """The Steps of the tracer that the settings ask for: with their bug, or right. Raises TracerError for a
    bug that is not there, or that would never let go with these settings."""
    if not settings.bug:
        return RIGHT
    bug = of(settings.bug)
    bug.check(settings)
    return bug.steps


def changed(**steps):
    """The right Steps with some replaced: what if?"""
    return replace(RIGHT, **steps)
