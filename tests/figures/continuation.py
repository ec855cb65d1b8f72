"""Rays that go on from edges and corners of closed rooms; a white room in a bright sky that stays dark."""

import numpy as np
from continuation import AIMS, KINDS, PLACES, WAYS, continuation
from lamps_outside import lit_from_outside
from white_room import segments

from figures.figure import Figure

TITLE = "Rays from edges and corners"
WHAT = {
    "concave": "where walls meet",
    "convex": "of what stands free",
    "coplanar": "within flat walls",
    "standing": "where one body stands on another",
}
ANCHORS = "pbrt, Mitsuba: an epsilon or a bound, no count"
CHUNKS = {"away": 20}  # 200 where not said otherwise


def notes():
    """What counts as a fault."""
    return """
A ray starts within 4 ulp (in each coordinate) of an edge or a corner of a face: at random, grazing, or along
another face. It escapes if it meets nothing; it meets something falsely if that is its own face or one that
does not reach into the side of its face's plane to which it leaves (a coplanar or a convex neighbour), or if
it comes to a face from behind. The rule that prevents it is at the head of `tracer/shape/start.py`. Places:
the origin, (148376, 1234, -223423) with rooms of 2 km, and 2 km from the origin with rooms of 2 m.
"""


def _continued(kind, place, dtype, n):
    ways = [(name, aim, way) for name in KINDS[kind] for aim in AIMS for way in WAYS]

    def measure(seed):
        name, aim, way = ways[seed // 1000 % len(ways)]
        found = continuation(name, place, dtype, aim, way, n, seed)
        return {"rays": found.rays, "escaped": found.escaped, "false": found.self_hit + found.behind}

    return measure


def none_false(sums, chunks):
    """A judge: nothing escaped, and nothing was met falsely."""
    seen = f"{sums['escaped']} escaped, {sums['false']} met falsely of {sums['rays']:,}"
    return seen, sums["escaped"] == sums["false"] == 0 and sums["rays"] > 0


def _dark(sums, chunks):
    return f"{sums['lit']:g} of {sums['segments']:.3g} segments", sums["lit"] == 0 < sums["segments"]


def figures():
    """Continuation rays by kind of edge, place and precision; then the white room (S08)."""
    n = 52_500  # some grazing ones leave to the other side, by rounding, and do not count
    for kind, what in WHAT.items():
        for place in PLACES[:3]:
            for dtype in (np.float32, np.float64):
                bits = np.dtype(dtype).itemsize * 8
                yield Figure(
                    f"continue-{kind}-{place.name}-{bits}",
                    f"rays from edges and corners {what}, {place.name}: escapes and false hits",
                    "0",
                    ANCHORS,
                    f"float{bits}",
                    CHUNKS.get(place.name, 200),
                    n,
                    _continued(kind, place, dtype, n),
                    none_false,
                )
    for place in PLACES[:2]:
        for bits in (32, 64):
            yield Figure(
                f"white-room-{place.name}-{bits}",
                f"light from a sky of 1e6 in a closed white room of 12 triangles (S08), {place.name}",
                "0",
                "we know of none",
                f"float{bits}",
                60,
                500_000,
                lambda seed, place=place, bits=bits: segments(place, bits, seed),
                _dark,
            )
    n = 50_000
    for dtype in (np.float32, np.float64):
        bits = np.dtype(dtype).itemsize * 8
        yield Figure(
            f"lamps-outside-{bits}",
            "shadow rays from a closed room, half from edges and corners, that reach a lamp outside",
            "0",
            "we know of none",
            f"float{bits}",
            20,
            n,
            lambda seed, dtype=dtype: {"lit": lit_from_outside(dtype, n, seed // 1000)},
            lambda sums, chunks: (str(sums["lit"]), sums["lit"] == 0),
        )
