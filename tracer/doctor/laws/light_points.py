"""Light samples: the point on a lamp, and the density with which it was chosen."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.laws.emission import radiance_of
from tracer.doctor.rule import Outcome, Rule
from tracer.events import TECHNIQUES
from tracer.frame import dot, length

_AREA = TECHNIQUES.index("area")


def on_lamp(evidence):
    """I16: light points lie on their lamp."""
    primitive = evidence("light.primitive")
    rows = np.flatnonzero(primitive >= 0)
    if not rows.size:
        return None
    primitive, light = primitive[rows], evidence("light.light")[rows]
    off = evidence.brute.off_surface(evidence("light.q")[:, rows], primitive)
    bad = ~(off <= 4.0 * evidence.off_point) | (evidence.scene.light_of.take(primitive) != light)
    return Outcome(
        "light", rows, bad, np.zeros_like(bad), off, np.zeros_like(off), "distance of q from its lamp"
    )


def normal(evidence):
    """I11: nq is the lamp's normal."""
    rows = np.flatnonzero(evidence("light.primitive") >= 0)
    if not rows.size:
        return None
    primitive = evidence("light.primitive")[rows]
    inputs = {"q": (evidence("light.q")[:, rows], evidence.off_point), "primitive": (primitive, 0.0)}
    return judged(
        evidence,
        "light",
        rows,
        evidence("light.nq")[:, rows],
        evidence_normals(evidence),
        inputs,
        "nq",
        absolute=evidence.off_unit,
    )


def evidence_normals(evidence):
    """The normals of primitives at points."""
    return lambda q, primitive: evidence.brute.normals(q, primitive)


def _gap(evidence):
    return evidence("light.q") - evidence.at_vertex("light", "p")


def direction(evidence):
    """I11, I13: wi leads from the vertex to the light point."""
    gap = _gap(evidence)
    size = length(gap)
    near = 4.0 * evidence.off_point / np.maximum(size, 1e-300)
    good = evidence.is_unit("light.wi")
    right = gap / np.maximum(size, 1e-300)
    bad = ~(np.abs(evidence("light.wi") - right) <= near + evidence.off_unit).all(axis=0)
    unsure = ~good | (near > 0.1)
    return Outcome("light", np.arange(size.size), bad & ~unsure, unsure, evidence("light.wi"), right, "wi")


def distance(evidence):
    """The distance to the light point is the length of the way."""
    gap = _gap(evidence)
    inputs = {"gap": (gap, 4.0 * evidence.off_point)}
    rows = np.arange(gap.shape[1])
    return judged(
        evidence, "light", rows, evidence("light.distance"), lambda gap: length(gap), inputs, "distance"
    )


def pick(evidence):
    """I16: the probability of each lamp."""
    right = evidence.lamps.pick.take(evidence("light.light"))
    rows = np.arange(right.size)
    return judged(
        evidence, "light", rows, evidence("light.pick"), lambda right: right, {"right": (right, 0.0)}, "pick"
    )


def radiance(evidence):
    """I5: the radiance of a light point."""
    primitive, light = evidence("light.primitive"), evidence("light.light")
    cos = -dot(evidence("light.nq"), evidence("light.wi"))
    shape = primitive >= 0
    front = shape & (cos > 0.0)
    right = radiance_of(evidence, np.where(shape, primitive, 0), front)
    p = evidence.at_vertex("light", "p")
    hidden, near = evidence.lamps.hidden(p, np.where(shape, primitive, 0), 4.0 * evidence.off_point)
    right = np.where(shape & hidden, 0.0, right)
    unsure = shape & (near | (np.abs(cos) <= 16.0 * evidence.off_unit))
    around = ~shape & ~evidence.lamps.is_delta.take(light)
    for number in np.unique(light[~shape & ~around]):
        lanes = np.flatnonzero((light == number) & ~shape)
        _, _, right[:, lanes] = evidence.lamps.delta(number, p[:, lanes])
    recorded, bad = evidence("light.Le"), np.zeros(light.shape, bool)
    if around.any():
        lanes = np.flatnonzero(around)
        found = _of_environment(evidence, lanes)
        right[:, lanes], bad[lanes] = found.right, found.wrong
    # The irradiance of a point light falls with the square of a distance whose ends are rounded.
    r = np.maximum(length(_gap(evidence)), 1e-300)
    room = (64.0 * evidence.eps + np.where(shape, 0.0, 8.0 * evidence.off_point / r)) * np.abs(right)
    off = ~(np.abs(recorded - right) <= room).all(axis=0)
    bad = np.where(around, bad, off)
    unsure = unsure | unused(evidence, bad & shape & (right == 0.0).all(axis=0))
    return Outcome("light", np.arange(bad.size), bad & ~unsure, unsure, recorded, right, "Le")


def unused(evidence, dark):
    """Which of the samples from where nothing arrives are no mistake, (E,): all, if none brings anything. A
    log may say what a lamp sends or a surface reflects before it is asked to which side."""
    if not evidence.has("light.contribution") or evidence("light.contribution")[:, dark].any():
        return np.zeros_like(dark)
    return dark


def _of_environment(evidence, rows):
    inputs = {"wi": (evidence("light.wi")[:, rows], evidence.off_unit)}
    recorded = evidence("light.Le")[:, rows]
    return judged(
        evidence, "light", rows, recorded, lambda wi: evidence.scene.environment(wi)[0], inputs, "Le"
    )


def density(evidence):
    """I4: the density of the direction to a light point."""
    primitive, light = evidence("light.primitive"), evidence("light.light")
    rows = np.flatnonzero((primitive >= 0) & evidence.is_unit("light.wi"))
    lit = _density_on_lamps(evidence, rows, primitive[rows]) if rows.size else None
    others = np.flatnonzero(primitive < 0)
    if not others.size:
        return lit
    right = evidence.lamps.pick.take(light[others])
    around = ~evidence.lamps.is_delta.take(light[others])
    inputs = {
        "wi": (evidence("light.wi")[:, others], evidence.off_unit),
        "around": (around, 0.0),
        "right": (right, 0.0),
    }

    def value(wi, around, right):
        return np.where(around, evidence.lamps.surrounding(wi), right) if around.any() else right

    far = judged(evidence, "light", others, evidence("light.pdf")[others], value, inputs, "pdf")
    return far if lit is None else joined(lit, far)


def _density_on_lamps(evidence, rows, primitive):
    lamps, p, q = evidence.lamps, evidence.at_vertex("light", "p")[:, rows], evidence("light.q")[:, rows]
    by_area = (
        evidence("light.technique")[rows] == _AREA
        if evidence.has("light.technique")
        else np.zeros(rows.shape, bool)
    )
    hidden, near = lamps.hidden(p, primitive, 4.0 * evidence.off_point)

    def value(o, p, primitive, by_area, hidden):
        n = evidence.brute.normals(p, primitive)
        found = lamps.density(o, p, primitive)
        if by_area.any():
            found = np.where(by_area, lamps.density(o, p, primitive, area=True), found)
        return np.where((dot(n, o - p) > 0.0) & ~hidden, found, 0.0)

    inputs = {
        "o": (p, evidence.off_point),
        "p": (q, evidence.off_point),
        "primitive": (primitive, 0.0),
        "by_area": (by_area, 0.0),
        "hidden": (hidden, 0.0),
    }
    return lamps.either(evidence, "light", rows, evidence("light.pdf")[rows], value, inputs, "pdf", ~near)


def joined(a, b):
    """Two Outcomes of one number as one."""
    rows, wrong, unsure, recorded, right = (
        np.concatenate((getattr(a, name), getattr(b, name)), axis=-1)
        for name in ("rows", "wrong", "unsure", "recorded", "right")
    )
    return Outcome(a.kind, rows, wrong, unsure, recorded, right, a.what)


RULES = (
    Rule(
        "light-point",
        "Light points lie on lamps",
        "A light sample is a point on the lamp that was chosen.",
        "q on lamp",
        ("light.q", "light.primitive", "light.light"),
        on_lamp,
    ),
    Rule(
        "light-normal",
        "The lamp's normal is that of its surface",
        "The normal at a light point is the lamp's.",
        "nq = n(q)",
        ("light.nq", "light.q", "light.primitive"),
        normal,
    ),
    Rule(
        "light-direction",
        "wi leads to the light point",
        "A light sample's direction is the way to its point.",
        "wi = (q - p) / |q - p|",
        ("light.wi", "light.q", "hit.p"),
        direction,
    ),
    Rule(
        "light-distance",
        "The distance is that to the light point",
        "r is the length of the way.",
        "r = |q - p|",
        ("light.distance", "light.q", "hit.p"),
        distance,
    ),
    Rule(
        "light-pick",
        "Lamps are chosen with the probability that is said",
        "Each lamp has its probability, and all add up to 1.",
        "sum of P(lamp) = 1",
        ("light.pick", "light.light"),
        pick,
    ),
    Rule(
        "light-radiance",
        "Lamps send what the scene says",
        "A lamp sends its radiance from its front only.",
        "Le(q, -wi); 0 for cos_light <= 0",
        ("light.Le", "light.wi", "light.nq", "light.q", "light.primitive", "light.light", "hit.p"),
        radiance,
    ),
    Rule(
        "light-pdf",
        "The density is that of the light sampler",
        "A density per area becomes one per solid angle by r^2 / cos_light, once.",
        "pdf = P(lamp) pdf_area r^2 / cos_light, or P(lamp) / solid angle",
        ("light.pdf", "light.q", "light.wi", "light.primitive", "light.light", "hit.p"),
        density,
    ),
)
