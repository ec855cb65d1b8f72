"""From vertex to vertex: along the ray, to the first surface, with the throughput that was left."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.rule import Outcome, Rule
from tracer.frame import dot, length

_NEAR = 1e-3  # share of the scene: what other programs do not meet nearer than that may be their tolerance
_LEAST = 64.0  # ways shorter than this many times what points may be off have no direction to speak of


def ways(evidence):
    """Of each HIT: the way from the vertex before (3, E), its length, how far it leads past the ray (E,), and
    how far it may."""
    o, d, _ = evidence.arrivals
    gap = evidence("hit.p") - o
    along = dot(gap, d)
    aside = length(gap - along * d)
    # A point on a mesh's face slides along it by its rounding over the cosine; the start was moved off its
    # face, and off faces that it touches, by some error bounds.
    cos = np.maximum(np.abs(dot(evidence("hit.ng"), d)), 1e-4) if evidence.has("hit.ng") else 1e-2
    room = 4.0 * evidence.off_point / cos + np.abs(along) * 2.0 * evidence.off_unit
    return gap, along, aside, room


def sound(evidence):
    """Whether a HIT's ray has a unit direction and lies on numbers, (E,)."""
    o, d, _ = evidence.arrivals
    return (np.abs(length(d) - 1.0) <= 4.0 * evidence.off_unit) & np.isfinite(o).all(axis=0)


def on_the_ray(evidence):
    """I13: which HITs do not lie on the ray from the vertex before."""
    gap, along, aside, room = ways(evidence)
    size = length(gap)
    rows = np.arange(size.size)
    bad = ~((aside <= room) & (along >= -room))
    unsure = ~sound(evidence) | (size < _LEAST * room)
    return Outcome(
        "hit",
        rows,
        bad & ~unsure,
        unsure,
        gap / np.maximum(size, 1e-300),
        evidence.arrivals[1],
        "(p' - p) / |p' - p|",
    )


def own_surface(evidence):
    """I12: which HITs lie on the very surface that their ray starts on."""
    o, d, source = evidence.arrivals
    primitive, brute = evidence("hit.primitive"), evidence.brute
    placed = evidence.starts_on_surface("hit") & evidence.lies_on_surface
    rows = np.flatnonzero((primitive == source) & sound(evidence) & placed)
    bad = np.ones(rows.size, bool)
    chord = np.zeros(rows.size)
    ball = brute.is_sphere.take(primitive[rows])
    if ball.any():
        # Inside a sphere a ray meets it again, at the other end of the chord.
        out = o[:, rows] - brute.center[:, np.where(ball, brute.column.take(primitive[rows]), 0)]
        chord = np.where(ball, -2.0 * dot(out, d[:, rows]), 0.0)
        room = 32.0 * evidence.off_point
        along = dot(evidence("hit.p")[:, rows] - o[:, rows], d[:, rows])
        bad = ~ball | (np.abs(along - chord) > room)
        unsure = ball & (np.abs(chord) <= room) & ~bad
    else:
        unsure = np.zeros_like(bad)
    everyone = np.arange(primitive.size)
    wrong, doubt = np.zeros(everyone.size, bool), np.zeros(everyone.size, bool)
    wrong[rows], doubt[rows] = bad, unsure
    doubt |= ~placed
    return Outcome("hit", everyone, wrong, doubt, primitive, np.full(primitive.size, -1), "primitive")


def distance(evidence):
    """t is the length of the way."""
    _, d, _ = evidence.arrivals
    gap, along, aside, room = ways(evidence)
    t = evidence("hit.t")
    rows = np.arange(t.size)
    good = sound(evidence) & (aside <= room)
    bad = ~(np.abs(t - along) <= 2.0 * room) & good
    return Outcome("hit", rows, bad, ~good, t, along, "t")


def met(evidence):
    """Of each HIT the distance to the nearest surface that its ray surely meets (E,), inf for none, which
    primitive that is, and by how much it may be off; nan where the ray is not known."""
    if "met" not in evidence.__dict__:
        evidence.__dict__["met"] = _met(evidence, evidence.arrivals, sound(evidence))
    return evidence.__dict__["met"]


def _met(evidence, arrivals, good):
    o, d, source = arrivals
    slack = 4.0 * evidence.off_point
    sure, may, which = evidence.brute.nearest(o, d, source, slack)
    n = evidence.brute.normals(o + np.where(np.isfinite(sure), sure, 0.0) * d, np.maximum(which, 0))
    room = 4.0 * slack / np.maximum(np.abs(dot(n, d)), 1e-9) + 2.0 * slack
    return np.where(good, sure, np.nan), may, which, room


def first_surface(evidence):
    """I12: which HITs lie behind a surface that their ray meets first."""
    gap, along, aside, room = ways(evidence)
    sure, may, which, off = met(evidence)
    rows = np.arange(along.size)
    bad = along > sure + off + room
    unsure = np.isnan(sure) | ~(aside <= room) | (~bad & (may < along - off - room))
    unsure |= bad & _too_near(evidence, sure)
    return Outcome("hit", rows, bad & ~unsure, unsure, along, sure, "t", facts={"met": which})


def _too_near(evidence, t):
    """Whether a surface is so near to a ray's start that a program with a tolerance may not meet it."""
    return t < (_NEAR * evidence.scale if evidence.trace.culled else 0.0)


def nothing_met(evidence):
    """I12: which ESCAPEs leave through a surface."""
    o, d, source = evidence.departures
    good = (np.abs(length(d) - 1.0) <= 4.0 * evidence.off_unit) & evidence.starts_on_surface("escape")
    sure, may, which, off = _met(evidence, (o, d, source), good)
    bad = np.isfinite(sure) & good
    unsure = ~good | (~bad & np.isfinite(may))
    unsure |= bad & _too_near(evidence, sure)
    bad &= ~unsure
    return Outcome(
        "escape", np.arange(bad.size), bad, unsure, np.full(bad.size, np.inf), sure, "t", facts={"met": which}
    )


def backwards(evidence):
    """I11: wo is the direction of the ray, turned round."""
    _, d, _ = evidence.arrivals
    wo = evidence("hit.wo")
    bad = ~(np.abs(wo + d) <= 2.0 * evidence.off_unit).all(axis=0)
    good = sound(evidence)
    return Outcome("hit", np.arange(bad.size), bad & good, ~good, wo, -d, "wo")


def escape_direction(evidence):
    """The direction of an ESCAPE is that of the last bounce."""
    _, d, _ = evidence.departures
    there = evidence("escape.d")
    unsure = np.isnan(d).any(axis=0)
    bad = ~(np.abs(there - d) <= 2.0 * evidence.off_unit).all(axis=0) & ~unsure
    return Outcome("escape", np.arange(bad.size), bad, unsure, there, d, "d")


def carried(evidence, kind):
    """The throughput (3, E) that was recorded last in its path before each event of a kind."""
    found = np.ones((3, evidence.count(kind)))
    latest = np.full(evidence.count(kind), -1)
    for other in ("camera", "hit", "bounce", "roulette"):
        if not evidence.count(other):
            continue
        row = evidence.before(kind, other)
        step = np.where(row >= 0, evidence.trace.tables[other].step.take(row), -1)
        newer = step > latest
        found = np.where(newer, evidence(f"{other}.beta").take(row, axis=1), found)
        latest = np.maximum(latest, step)
    return found


def arriving(evidence):
    """I8: the throughput on arrival is what left the vertex before, times what the way let through."""
    left = carried(evidence, "hit")
    through = evidence("hit.transmittance") if evidence.has("hit.transmittance") else np.ones_like(left)
    inputs = {"beta": (left, 0.0), "share": (through, 0.0)}
    rows = np.arange(left.shape[1])
    return judged(
        evidence, "hit", rows, evidence("hit.beta"), lambda beta, share: beta * share, inputs, "beta"
    )


_RAY = ("camera.o", "camera.d", "bounce.wi")
RULES = (
    Rule(
        "chain",
        "The next vertex lies on the ray",
        "From a vertex the path goes along the direction that was chosen there, to the next vertex.",
        "p' = p + t wi",
        ("hit.p", *_RAY),
        on_the_ray,
    ),
    Rule(
        "own-surface",
        "Rays do not meet what they start on",
        "A flat face is not met by a ray that starts on it; a sphere at the other end of the chord only.",
        "primitive_k+1 != primitive_k",
        ("hit.primitive", "hit.p", *_RAY),
        own_surface,
    ),
    Rule(
        "first-surface",
        "The next vertex is the first surface",
        "Rays end at the first surface that they meet.",
        "t = min over all surfaces",
        ("hit.p", "hit.primitive", *_RAY),
        first_surface,
    ),
    Rule(
        "escape-free",
        "Rays that escape meet nothing",
        "A ray leaves the scene only where no surface is in its way.",
        "t = inf",
        ("escape.d", "hit.p", "hit.primitive", *_RAY),
        nothing_met,
    ),
    Rule(
        "distance",
        "t is the distance to the next vertex",
        "The distance along the ray is that between its start and the next vertex.",
        "t = |p' - p|",
        ("hit.t", "hit.p", *_RAY),
        distance,
    ),
    Rule(
        "wo",
        "wo points back along the ray",
        "At a vertex wo leaves the surface, back to where the path came from.",
        "wo = -d",
        ("hit.wo", *_RAY),
        backwards,
    ),
    Rule(
        "escape-direction",
        "The escaping ray is the one that was chosen",
        "A path leaves the scene in the direction of its last bounce.",
        "d = wi",
        ("escape.d", *_RAY),
        escape_direction,
    ),
    Rule(
        "throughput-on-arrival",
        "Throughput is carried from vertex to vertex",
        "Between two vertices only what fills the way takes light.",
        "beta_k+1 = beta after bounce and roulette x transmittance",
        ("hit.beta",),
        arriving,
    ),
)
