"""Light samples: what the surface makes of them, whether they are seen, and what arrives."""

from dataclasses import replace

import numpy as np

from tracer.bsdf.glass import Refracting
from tracer.doctor.compare import judged
from tracer.doctor.laws.chain import carried
from tracer.doctor.laws.emission import mis, strategy
from tracer.doctor.laws.light_points import unused
from tracer.doctor.rule import Outcome, Rule
from tracer.frame import dot, length

_LEAST = 1e-30  # what would arrive and is less may have underflowed: then nobody asks whether it is seen


def reflected(evidence):
    """I2: f is that of the surface at this vertex."""
    found = asked_again(evidence, "light", "eval", "f", evidence.sound("light", "wi"))
    dark = (found.right == 0.0).all(axis=0)
    if (found.wrong & ~dark).any():  # another f, which shows from below as well
        return found
    return _spared(found, unused(evidence, found.wrong))


def _spared(found, which):
    """The Outcome without what is wrong at some of its events (K,), for which nobody knows then."""
    return replace(found, wrong=found.wrong & ~which, unsure=found.unsure | which)


def asked_again(evidence, kind, method, field, sound, rows=None):
    """The Outcome of `eval` or `pdf` asked anew at the events `rows` of a kind."""
    rows = np.arange(evidence.count(kind)) if rows is None else rows
    off = evidence.off_unit
    inputs = {
        "p": (evidence.at_vertex(kind, "p")[:, rows], evidence.off_point),
        "n": (evidence.at_vertex(kind, "n")[:, rows], off),
        "wo": (evidence.at_vertex(kind, "wo")[:, rows], off),
        "wi": (evidence(f"{kind}.wi")[:, rows], off),
        "primitive": (evidence.at_vertex(kind, "primitive")[rows], 0.0),
    }

    def value(p, n, wo, wi, primitive):
        return evidence.asked(p, n, wo, wi, primitive, method)

    recorded = evidence(f"{kind}.{field}")[..., rows]
    return judged(evidence, kind, rows, recorded, value, inputs, field, sound[rows])


def cosine(kind):
    """I3: cos = |n . wi|."""

    def judge(evidence):
        right = np.abs(dot(evidence.at_vertex(kind, "n"), evidence(f"{kind}.wi")))
        recorded = evidence(f"{kind}.cos")
        good = evidence.sound(kind, "wi")
        bad = ~(np.abs(recorded - right) <= 4.0 * evidence.off_unit) & good
        return Outcome(kind, np.arange(bad.size), bad, ~good, recorded, right, "cos")

    return judge


def density_of_bouncing(evidence):
    """pdf_bsdf of a light sample: with which density a bounce would have gone there."""
    meets = ~evidence.lamps.is_delta.take(evidence("light.light"))
    return asked_again(
        evidence, "light", "pdf", "pdf_bsdf", evidence.sound("light", "wi"), np.flatnonzero(meets)
    )


def weight(evidence):
    """I7: the weight of light found by sampling it."""
    settings, rows = evidence.settings, np.flatnonzero(evidence("light.pdf") > 0.0)
    if not rows.size:
        return None
    inputs = {name: (evidence(f"light.{name}")[rows], 0.0) for name in ("pdf", "pdf_bsdf")}

    def value(pdf, pdf_bsdf):
        return np.ones_like(pdf) if strategy(settings) == "light" else mis(settings, pdf, pdf_bsdf)

    w = evidence("light.w")[rows]
    found = judged(evidence, "light", rows, w, value, inputs, "w", absolute=32 * evidence.eps)
    return _spared(found, found.wrong & (w == 0.0) & _brings_nothing(evidence)[rows])


def _brings_nothing(evidence):
    """Light samples (E,) of which a factor that is recorded is 0: a weight of 0 there is no mistake."""
    found = np.zeros(evidence.count("light"), bool)
    for name in ("light.Le", "light.f"):
        if evidence.has(name):
            found |= (evidence(name) == 0.0).all(axis=0)
    for name in ("light.visible", "light.cos"):
        if evidence.has(name):
            found |= evidence(name) <= 0
    return found


def throughput(evidence):
    """The throughput at a light sample is that at its vertex."""
    right = carried(evidence, "light")
    rows = np.arange(right.shape[1])
    return judged(
        evidence, "light", rows, evidence("light.beta"), lambda right: right, {"right": (right, 0.0)}, "beta"
    )


def _refracting(scene, primitive):
    """Whether light gets through the surface of primitives (N,): where rough glass lets through next to
    nothing, rounding decides whether it lets through anything."""
    found = np.array([isinstance(m, Refracting) for m in scene.definition.bsdfs.values()])
    return found.take(scene.bsdf_of.take(primitive))


def from_nowhere(evidence):
    """I5: nothing arrives from behind the lamp, nor where the surface reflects nothing, whatever weights and
    densities are."""
    rows = np.flatnonzero(evidence("light.primitive") >= 0)
    if not rows.size:
        return None
    p, n, wo, surface = (evidence.at_vertex("light", k)[..., rows] for k in ("p", "n", "wo", "primitive"))
    q, lamp = evidence("light.q")[:, rows], evidence("light.primitive")[rows]
    gap, room = q - p, 16.0 * evidence.off_point
    behind = dot(evidence.brute.normals(q, lamp), -gap)
    hidden, near = evidence.lamps.hidden(p, lamp, room)
    f = evidence.asked(p, n, wo, gap / length(gap), surface, "eval")
    ng = evidence.brute.normals(p, surface)
    above, steep = (np.minimum(np.abs(dot(n, way)), np.abs(dot(ng, way))) for way in (gap, wo))
    back = ((behind < -room) | hidden) & ~near
    dark = (f == 0.0).all(axis=0) & (above > room) & (steep > 4.0 * evidence.off_unit)
    dark &= ~_refracting(evidence.scene, surface) & evidence.sound("light")[rows]
    recorded = evidence("light.contribution")[:, rows]
    bad = (back | dark) & (recorded != 0.0).any(axis=0)
    none = np.zeros(bad.shape, bool)
    right = np.zeros_like(recorded)
    return Outcome("light", rows, bad, none, recorded, right, "contribution", facts={"back": back & ~dark})


_PARTS = ("beta", "f", "Le", "cos", "w", "pdf")


def term(evidence):
    """I5: what a light sample brings."""
    inputs = {name: (evidence(f"light.{name}"), 0.0) for name in _PARTS}
    seen = evidence("light.visible").astype(float)
    if evidence.has("light.transmittance"):
        seen = seen * evidence("light.transmittance")
    inputs["seen"] = (seen / evidence.trace.light_samples, 0.0)

    def value(beta, f, Le, cos, w, pdf, seen):
        return np.where(pdf > 0.0, beta * f * Le * cos * w * seen / np.where(pdf > 0.0, pdf, 1.0), 0.0)

    rows = np.arange(evidence.count("light"))
    return judged(evidence, "light", rows, evidence("light.contribution"), value, inputs, "contribution")


def _unrecorded(evidence):
    """What f and the lamp's front leave of the light (E,) where the log does not say them: whether a point is
    seen need not be asked where nothing could arrive."""
    p, q = evidence.at_vertex("light", "p"), evidence("light.q")
    left, primitive = np.ones(q.shape[1]), evidence("light.primitive")
    if not evidence.has("light.Le"):
        shape = primitive >= 0
        nq = evidence.brute.normals(q, np.where(shape, primitive, 0))
        left *= ~shape | (dot(nq, p - q) > 0.0)
    if not evidence.has("light.f") and evidence.has("hit.n") and evidence.has("hit.wo"):
        n, wo, surface = (evidence.at_vertex("light", name) for name in ("n", "wo", "primitive"))
        f = evidence.asked(p, n, wo, (q - p) / length(q - p), surface, "eval")
        left *= f.max(axis=0)
    return left


def visible(evidence):
    """I6: whether the light point is seen, by every primitive asked one by one.

    What starts within rounding of a closed shape's face, or outside of the room, meets it from behind only:
    then a program that culls back faces sees the light, which is no mistake.
    """
    arriving = np.ones(evidence.count("light"))
    for name in ("f", "Le", "beta", "pdf", "w", "cos"):
        if evidence.has(f"light.{name}"):
            column = evidence(f"light.{name}")
            column = column.max(axis=0) if column.ndim == 2 else column
            arriving = (
                arriving / np.where(column > 0.0, column, np.inf) if name == "pdf" else arriving * column
            )
    could = arriving * _unrecorded(evidence) > _LEAST
    seen = evidence("light.visible").astype(bool)
    rows = np.flatnonzero(could | seen)
    if not rows.size:
        return None
    p, q = evidence.at_vertex("light", "p")[:, rows], evidence("light.q")[:, rows]
    source, target = evidence.at_vertex("light", "primitive")[rows], evidence("light.primitive")[rows]
    blocked, maybe = evidence.brute.between(
        p, q, source, target, 4.0 * evidence.off_vertex, front_only=evidence.trace.culled
    )
    seen = seen[rows]
    bad = (seen & blocked) | (~seen & ~maybe)
    unsure = maybe & ~blocked
    unsure |= ~(length(q - p) > 64.0 * evidence.off_vertex)
    # In the plane of the vertex or of the lamp, but for rounding, nothing arrives: nobody has to ask.
    normals = evidence.at_vertex("light", "n")[:, rows], evidence.brute.normals(q, np.maximum(target, 0))
    for n in normals:
        unsure |= ~seen & (np.abs(dot(n, q - p)) <= 4.0 * evidence.off_vertex)
    unsure |= ~seen & (target >= 0) & (dot(normals[1], q - p) >= 0.0)  # nor behind the lamp
    return Outcome("light", rows, bad & ~unsure, unsure, seen, ~blocked, "visible")


_VERTEX = ("hit.p", "hit.n", "hit.wo", "hit.primitive")
RULES = (
    Rule(
        "light-f",
        "f is that of the surface that is lit",
        "A light sample is reflected by the material of this vertex, from wi to wo.",
        "f = f(p, wo, wi)",
        ("light.f", "light.wi", *_VERTEX),
        reflected,
    ),
    Rule(
        "light-cos",
        "The cosine at a light sample",
        "Each vertex has exactly one cosine, between n and wi.",
        "cos = |n . wi|",
        ("light.cos", "light.wi", *_VERTEX),
        cosine("light"),
    ),
    Rule(
        "light-pdf-bsdf",
        "The density of bouncing to the light",
        "The weight takes the density with which this surface's own sampler would go there.",
        "pdf_bsdf = p(wi | p, wo)",
        ("light.pdf_bsdf", "light.wi", "light.light", *_VERTEX),
        density_of_bouncing,
    ),
    Rule(
        "light-visible",
        "Light points are seen unless something lies between",
        "A light point is seen if nothing lies strictly between it and the vertex.",
        "V = 1 if no surface at 0 < t < r",
        ("light.visible", "light.q", "light.primitive", "hit.p", "hit.primitive"),
        visible,
    ),
    Rule(
        "light-weight",
        "Light found by sampling counts once",
        "Over all ways to find it, the weights of one light path sum to 1.",
        "w = 1 if bounces that find it are not counted, else MIS(pdf, pdf_bsdf)",
        ("light.w", "light.pdf", "light.pdf_bsdf"),
        weight,
    ),
    Rule(
        "light-throughput",
        "A light sample has the throughput of its vertex",
        "What lies behind the vertex does not depend on the light sample.",
        "beta = beta_k",
        ("light.beta", "hit.beta"),
        throughput,
    ),
    Rule(
        "light-term",
        "What a light sample brings",
        "It brings throughput, f, radiance, cosine and weight, divided by its density, if it is seen.",
        "contribution = beta f Le cos w V / pdf",
        ("light.contribution", *(f"light.{name}" for name in _PARTS), "light.visible"),
        term,
    ),
    Rule(
        "light-nothing",
        "Nothing arrives from a lamp's back, nor from below",
        "Whatever its weight, a light sample brings nothing from behind the lamp or from below the surface.",
        "contribution = 0 for cos_light < 0 or f = 0",
        ("light.contribution", "light.q", "light.primitive", *_VERTEX),
        from_nowhere,
    ),
)
