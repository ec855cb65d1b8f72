"""The bug zoo: mistakes that nearly everyone makes once, each a few lines that replace a step of the loop.

    picture = tracer.render(scene, settings, steps=zoo.steps("E01"))

Ids are stable: links, recordings and lessons name them.
"""

from dataclasses import replace

from lessons.zoo import bounce, emission, film, glass, light, roulette
from lessons.zoo.bug import Bug
from tracer.integrator.steps import RIGHT
from tracer.settings import TracerError

ZOO = {bug.id: bug for family in (emission, light, bounce, roulette, film, glass) for bug in family.BUGS}

__all__ = ["RIGHT", "ZOO", "Bug", "changed", "planted", "steps"]


def steps(bug_id):
    """The Steps of a tracer with this bug. Raises TracerError with the ids there are."""
    if bug_id not in ZOO:
        raise TracerError(f"bug: {bug_id!r} is not in the zoo; there are {', '.join(ZOO)}")
    return ZOO[bug_id].steps


def planted(settings):
    """The Steps of the tracer that the settings ask for: with their bug, or right."""
    return steps(settings.bug) if settings.bug else RIGHT


def changed(**steps):
    """The right Steps with some replaced: what if?"""
    return replace(RIGHT, **steps)
