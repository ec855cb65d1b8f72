"""The self-hit microscope: both ends of the ray that an event casts, in ulps, as lines that can be read."""

from dataclasses import asdict
from typing import NamedTuple

import numpy as np

from tracer import self_hit
from viewer.caption import named
from viewer.numerals import short
from viewer.understanding.places import places

NEAR = 64.0  # ulps between two lengths that are meant to be the same


class Ends(NamedTuple):
    """The Start of an event's ray; for a light sample its Aim, and what blocked it (None for a bounce)."""

    start: self_hit.Start
    aim: self_hit.Aim | None
    blocker: str | None
    blocker_distance: float | None
    visible: bool | None

    def as_dict(self, scene):
        """Plain values, as `castray inspect --event --json` prints them."""
        found = {"start": {k: None if np.isnan(v) else v for k, v in asdict(self.start).items()}, "aim": None}
        if self.aim:
            aim = {**asdict(self.aim), "shape": named("shape", self.aim.shape, scene), "ulps": self.aim.ulps}
            at = self.blocker_distance
            found["aim"] = aim | {"visible": self.visible, "blocker": self.blocker, "blocker_distance": at}
        return found


def ends(scene, record, path, event):
    """The Ends of a light sample's or a bounce's ray, None for others. scene: at the record's settings."""
    here = next((p for p in places(record, "light", "bounce") if p.at == (path, event)), None)
    if here is None or not np.isfinite(here.event.values["wi"]).all():
        return None
    v = here.event.values
    aim = None
    with np.errstate(all="ignore"):
        began = self_hit.start(scene, here.hit, v["wi"])
        if np.isfinite(v.get("distance", np.inf)):
            aim = self_hit.aim(scene, here.hit, v["wi"], v["distance"])
    if here.event.kind.name == "bounce":
        return Ends(began, None, None, None, None)
    blocked = v["blocker"] >= 0
    return Ends(
        began,
        aim,
        named("shape", v["blocker"], scene) if blocked else None,
        float(v["blocker_distance"]) if blocked else None,
        bool(v["visible"]),
    )


def lines(there, scene, say):
    """[(name, words)] of the Ends."""
    start = there.start

    def both(length):
        return say("microscope.both", length=short(length), ulps=short(length / start.ulp))

    yield "ulp", say("microscope.length", length=short(start.ulp))
    yield "point", both(start.point)
    yield "offset", both(start.offset)
    yield "start", both(start.start)
    if start.aside:
        yield "aside", both(start.aside)
    if not np.isnan(start.own):
        yield "own", say("microscope.length", length=f"{start.own:.9g}")
    aim = there.aim
    if aim is None:
        return
    yield "distance", say("microscope.length", length=f"{aim.distance:.9g}")
    if aim.shape >= 0:
        shape = named("shape", aim.shape, scene)
        yield "first", say("microscope.meets", shape=shape, t=f"{aim.t:.9g}", ulps=short(aim.ulps))
    if there.blocker:
        at = there.blocker_distance
        before = (aim.distance - at) / aim.ulp
        yield "blocker", say("microscope.blocks", shape=there.blocker, at=f"{at:.9g}", ulps=short(before))
    elif not there.visible:
        yield "blocker", say("microscope.unseen")


def verdict(there, say):
    """One sentence on what that means."""
    aim = there.aim
    if aim is not None and aim.shape >= 0 and abs(aim.ulps) <= NEAR:
        return say("microscope.near", ulps=short(aim.ulps))
    return say("microscope.clear", ulps=short(there.start.start / there.start.ulp))


def ruler(there):
    """Heights in ulps over the own surface, as a drawing takes them, and by how many t is beyond q."""
    start, aim = there.start, there.aim
    heights = {name: getattr(start, name) / start.ulp for name in ("point", "offset", "start")}
    near = aim is not None and aim.shape >= 0 and abs(aim.ulps) <= NEAR
    return {**heights, "beyond": aim.ulps if near else None}
