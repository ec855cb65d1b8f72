"""The bug zoo: mistakes that nearly everyone makes once, each a few lines that replace a step of the loop.

    picture = tracer.render(scene, settings, steps=zoo.steps("E01"))  # or "E01,D06": both at once

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
from tracer.scene_file.words import near
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

__all__ = [
    "ALIKE",
    "FAMILIES",
    "RIGHT",
    "ZOO",
    "Bug",
    "alike",
    "changed",
    "of",
    "planted",
    "several",
    "steps",
]


def alike(bug_id):
    """The ids of the bugs that no recording tells from this one, itself among them."""
    return next((group for group in ALIKE if bug_id in group), frozenset((bug_id,)))


def of(bug_id):
    """The Bug with this id. Raises TracerError with the ids there are."""
    if bug_id not in ZOO:
        close = near(bug_id.upper(), ZOO)
        known = "castray bugs lists them" if close else f"there are {', '.join(ZOO)}"
        raise TracerError(f"bug: {bug_id!r} is not in the zoo; {close}{known}")
    return ZOO[bug_id]


def several(bug_ids):
    """The Bugs of one id, or of some that commas join, such as E01,D01. Raises TracerError for one that is
    not there, and for two that would replace the same step."""
    found = tuple(of(name.strip()) for name in bug_ids.split(","))
    planter = {}
    for bug in found:
        for step in bug.changes:
            if step in planter:
                raise TracerError(
                    f"bug: {planter[step]} and {bug.id} both replace the step {step}; plant one of them"
                )
            planter[step] = bug.id
    return found


def steps(bug_ids):
    """The Steps of a tracer with one bug, or some at once (see several)."""
    return changed(**{step: wrong for bug in several(bug_ids) for step, wrong in bug.changes.items()})


def planted(settings):
    """The Steps of the tracer that the settings ask for: with their bugs, or right. Raises TracerError for
    bugs that are not there, clash, or would never let go with these settings."""
    if not settings.bug:
        return RIGHT
    for bug in several(settings.bug):
        bug.check(settings)
    return steps(settings.bug)


def changed(**steps):
    """The right Steps with some replaced: what if?"""
    return replace(RIGHT, **steps)
