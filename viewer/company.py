"""What is drawn in 3D with the selected path: as it would be, its twin, the hemisphere over its vertex."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from viewer.comparing.comparer import beside
from viewer.hemisphere import Hemisphere
from viewer.traces import here
from viewer.understanding import lens

COMPANIONS = ("what_if", "twin")  # paths beside the selected one


@dataclass(frozen=True)
class Companion:
    """A path drawn beside the selected one, from its event `since` on; word: marks the place `at`, or where
    its way leaves the other's."""

    path: Any
    word: str
    since: int = 0
    at: list | None = None


def companions(session, say):
    """The paths to be drawn beside the selected one, {one of COMPANIONS: Companion}."""
    there, twin = session.supposition, beside(session)
    found = {"what_if": Companion(there.path, say("what_if.label"))} if there else {}
    if twin is not None and twin.parting is not None:
        since = twin.since
        at = np.asarray(here(twin.path, since), float).tolist()
        found["twin"] = Companion(twin.path, say("compare.label"), since, at)
    return found


def over_vertex(session, size, say):
    """The Hemisphere over the vertex, in a scene of that size, where it is asked for and there is one."""
    seen = lens.here(session) if session.shelf.get(lens.SHOWN) else None
    return Hemisphere(seen, size, say) if seen else None
