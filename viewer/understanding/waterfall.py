"""What a pixel is made of, by depth and technique: bars that add up to its value exactly."""

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from tracer.twin.exact import exact_colours
from viewer.numerals import luminance

DEEP = 8  # depths from here on are one bar of each technique
KINDS = ("hit", "light", "escape")
FILM, INVALID, ROUNDING = "film", "invalid", "rounding"


class Bar(NamedTuple):
    """One share of the pixel.

    kind: of the events that gave it; or, with depth None, what these do not make up: invalid (paths with a
    number that is not finite), film (paths that count for something else than they carry), rounding. value:
    exact, the number of samples divided out. events: how many; place: (path, event) of the largest, or None.
    """

    kind: str
    depth: int | None
    value: tuple  # of Fractions
    events: int
    place: tuple | None

    def as_dict(self):
        """Plain values, as `castray inspect --why --json` prints them."""
        path, event = self.place or (None, None)
        value = [float(v) for v in self.value]
        said = {"kind": self.kind, "depth": self.depth, "value": value, "events": self.events}
        return said | {"path": path, "event": event}


def waterfall(record):
    """The Bars of a recorded pixel, by depth; their sum is its value to the last bit."""
    paths, given = record.paths, _given(record.paths)
    invalid = {path for path, event in given if not np.isfinite(event.values["contribution"]).all()}
    groups = {}
    for path, event in given:
        if path not in invalid:
            groups.setdefault((min(event.depth, DEEP), KINDS.index(event.kind.name)), []).append(
                (path, event)
            )
    order = sorted(groups)
    cell = np.array([k for k, key in enumerate(order) for _ in groups[key]], np.int64)
    events = [one for key in order for one in groups[key]]
    terms = np.array([e.values["contribution"] for _, e in events], np.float64).reshape(-1, 3).T
    sums = exact_colours(cell, terms, len(order))
    bars = [
        Bar(KINDS[kind], depth, _share(value, paths), len(groups[depth, kind]), _largest(groups[depth, kind]))
        for (depth, kind), value in zip(order, sums, strict=True)
    ]
    bars += [*_invalid(paths, given, invalid), *_film(paths, invalid)]
    rest = tuple(_exact(v) - sum(bar.value[c] for bar in bars) for c, v in enumerate(record.value))
    return (*bars, Bar(ROUNDING, None, rest, 0, None)) if any(rest) else tuple(bars)


def bar_name(bar, say):
    """What a Bar of the waterfall is called."""
    key = f"ledger.{bar.kind}"
    return say(f"{key}.deep" if bar.depth == DEEP else key, depth=bar.depth, n=bar.events)


def carried(path):
    """The contributions of a path (3,), added in the order they came, in the path's own precision."""
    added = np.zeros_like(path.radiance)
    for event in path.events:
        if "contribution" in event.values:
            added = added + event.values["contribution"]
    return added


def _given(paths):
    """(path, event) of all that gave something."""
    return [
        (k, event)
        for k, path in enumerate(paths)
        for event in path.events
        if np.any(event.values.get("contribution", 0) != 0)
    ]


def _largest(group):
    """(path, event) of the largest contribution, negative ones as large as they are far from 0."""
    path, event = max(group, key=lambda one: abs(luminance(one[1].values["contribution"])))
    return path, event.step


def _exact(value):
    """A number as the film counts it: 0 where it is none, or was not recorded."""
    return Fraction(float(value)) if np.isfinite(value) else Fraction(0)


def _share(colour, paths):
    return tuple(v / len(paths) for v in colour)


def _invalid(paths, given, invalid):
    """The Bar of paths that carry a number that is not finite: all that they count for, usually nothing."""
    if not invalid:
        return
    broken = [(k, e) for k, e in given if not np.isfinite(e.values["contribution"]).all()]
    counted = tuple(sum(_exact(paths[k].radiance[c]) for k in invalid) for c in range(3))
    yield Bar(INVALID, None, _share(counted, paths), len(broken), (broken[0][0], broken[0][1].step))


def _film(paths, invalid):
    """The Bar of paths that count for something else than what they carry."""
    otherwise = [
        k for k, p in enumerate(paths) if k not in invalid and not np.array_equal(carried(p), p.radiance)
    ]
    if not otherwise:
        return
    apart = {
        k: tuple(_exact(b) - _exact(a) for a, b in zip(carried(paths[k]), paths[k].radiance, strict=True))
        for k in otherwise
    }
    total = tuple(sum(colour[c] for colour in apart.values()) for c in range(3))
    most = max(otherwise, key=lambda k: abs(luminance([float(v) for v in apart[k]])))
    yield Bar(FILM, None, _share(total, paths), len(otherwise), (most, len(paths[most].events) - 1))
