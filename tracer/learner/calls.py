"""Runs a learner's cast_ray and keeps, for every call, what it was given and what it returned.

The call itself is wrapped, so nested calls are seen; what it returns is taken apart into its terms.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer.learner.value import Value, known, named
from tracer.learner.world import Ray, World

MOST_DEPTH = 200  # calls within calls, beyond which a recursion is taken for endless


class Runaway(Exception):
    """A recursion that does not end."""


class Looped(Exception):
    """Paths that go on without a call for each bounce."""


@dataclass
class Call:
    """One call of cast_ray."""

    ray: Ray
    depth: int  # calls around it
    hit: Any = None  # the Hit of its own ray
    lights: list = field(default_factory=list)  # LightSamples
    randoms: list = field(default_factory=list)  # leaves
    children: list = field(default_factory=list)  # Calls
    asked: list = field(default_factory=list)  # directions of other rays that it sent
    met: list = field(default_factory=list)  # (ray, Hit) of those that met something
    loops: bool = False  # whether one of them left a point that another had met
    returned: Any = None  # Value


class Runner:
    """A learner's cast_ray on a scene."""

    def __init__(self, scene, module):
        self.world, self._inner, self._stack = World(scene), module.cast_ray, []
        self._looped, self._called_itself = False, False
        module.cast_ray = self._traced  # so that it calls itself through here

    def path(self, origin, direction, pixel, sample, seed):
        """The Call of a path and all within it."""
        self.world.start(pixel, sample, seed)
        self._stack = []
        self._traced(self.world, Ray(origin, direction), 0)
        self._looped |= self._first.loops
        self._called_itself |= bool(self._first.children)
        return self._first

    def check_recursion(self):
        """Raises Looped if no path was followed by calls within calls, and some were by a loop."""
        if self._looped and not self._called_itself:
            raise Looped(
                "one call of cast_ray follows the whole path (a loop, or another function that calls "
                "itself), so that its vertices cannot be told apart: let cast_ray be called for each bounce, "
                "as in what castray check --new writes"
            )

    def _traced(self, scene, ray, depth=0, *more):
        """cast_ray with its call kept."""
        call = Call(ray, len(self._stack))
        if len(self._stack) >= MOST_DEPTH:
            raise Runaway(
                f"cast_ray called itself {MOST_DEPTH} times without an end: is its roulette played, "
                "and does it stop where a ray meets nothing?"
            )
        if self._stack:
            self._stack[-1].children.append(call)
        else:
            self._first = call
        self._stack.append(call)
        self.world.log = call
        try:
            call.returned = colour(self._inner(self.world, ray, depth, *more))
        finally:
            self._stack.pop()
            self.world.log = self._stack[-1] if self._stack else None
        return named("child", call.returned.value, call=call)


def colour(returned):
    """What cast_ray returned, as a Value (3,). Raises TypeError with what would do."""
    if returned is None:
        raise TypeError(
            "cast_ray returned None: it has to return a colour on every way out, (0, 0, 0) for none"
        )
    found = known(returned)
    value = np.broadcast_to(np.asarray(found.value, np.float64), (3,))
    return Value(value, found.terms)
