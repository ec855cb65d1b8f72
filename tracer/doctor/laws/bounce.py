"""Where a path goes on, and what it is worth there."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.laws.chain import carried
from tracer.doctor.laws.light_terms import asked_again, cosine
from tracer.doctor.rule import Outcome, Rule
from tracer.events import LOBES
from tracer.frame import dot

_TRANSMISSION = LOBES.index("transmission")
_LAST = 1.0 - 2.0**-53  # the largest number below 1


def side(evidence):
    """I11: reflected directions leave on the side of wo, transmitted ones on the other."""
    n, wo, wi = evidence.at_vertex("bounce", "n"), evidence.at_vertex("bounce", "wo"), evidence("bounce.wi")
    lobe = evidence("bounce.lobe")
    opposite = np.where(lobe == _TRANSMISSION, -1.0, 1.0)
    away = dot(n, wi) * np.sign(dot(n, wo)) * opposite
    good = evidence.sound("bounce", "wi")
    room = 4.0 * evidence.off_unit
    bad = (away < -room) & good & (lobe > 0)
    unsure = ~good | (np.abs(away) <= room)
    return Outcome(
        "bounce", np.arange(bad.size), bad, unsure, away, np.abs(away), "n . wi on the side it belongs to"
    )


def _dirac(evidence):
    """Of the BOUNCEs off Dirac lobes what the lobe says: rows, and a function to (7, K): wi, f, pdf."""
    rows = np.flatnonzero(evidence("bounce.delta"))
    off = evidence.off_unit
    inputs = {
        "p": (evidence.at_vertex("bounce", "p")[:, rows], evidence.off_point),
        "n": (evidence.at_vertex("bounce", "n")[:, rows], off),
        "wo": (evidence.at_vertex("bounce", "wo")[:, rows], off),
        "primitive": (evidence.at_vertex("bounce", "primitive")[rows], 0.0),
        "lobe": (evidence("bounce.lobe")[rows], 0.0),
    }

    def value(p, n, wo, primitive, lobe):
        scene = evidence.scene
        frame = scene.frame(n, p, primitive)
        local, material, texture = (
            frame.to_local(wo),
            scene.bsdf_of.take(primitive),
            scene.painted(p, primitive),
        )
        found = np.full((7, lobe.size), np.nan)
        for choice in (0.0, _LAST):
            u = np.full((3, lobe.size), 0.5)
            u[0] = choice
            sample = scene.bsdf.sample(material, local, u, texture)
            same = (sample.lobe == lobe) & sample.delta
            said = np.concatenate((frame.to_world(sample.wi), sample.f, sample.pdf[None]))
            found = np.where(same & np.isnan(found[0]), said, found)
        return found

    return rows, value, inputs


def _of_dirac(part, field):
    """The Outcome of some of the numbers that a Dirac lobe says."""

    def judge(evidence):
        rows, value, inputs = _dirac(evidence)
        if not rows.size:
            return None
        recorded = evidence(f"bounce.{field}")[..., rows]

        def some(**given):
            found = value(**given)[part]
            return found[0] if recorded.ndim == 1 else found

        absolute = evidence.off_unit if field == "wi" else 4.0 * evidence.eps
        sound = evidence.sound("bounce")[rows]
        return judged(evidence, "bounce", rows, recorded, some, inputs, field, sound, absolute=absolute)

    return judge


def _smooth(evidence):
    return np.flatnonzero(~evidence("bounce.delta").astype(bool))


def reflected(evidence):
    """I2: f is that of the surface at this vertex."""
    return asked_again(evidence, "bounce", "eval", "f", evidence.sound("bounce", "wi"), _smooth(evidence))


def density(evidence):
    """I1: the density is that of the surface's sampler."""
    return asked_again(evidence, "bounce", "pdf", "pdf", evidence.sound("bounce", "wi"), _smooth(evidence))


def before(evidence):
    """The throughput before the bounce is that at the vertex."""
    right = carried(evidence, "bounce")
    rows = np.arange(right.shape[1])
    recorded = evidence("bounce.beta_before")
    return judged(
        evidence, "bounce", rows, recorded, lambda right: right, {"right": (right, 0.0)}, "beta_before"
    )


def throughput(evidence):
    """I8: throughput grows by f cos / pdf."""
    start = (
        evidence("bounce.beta_before") if evidence.has("bounce.beta_before") else carried(evidence, "bounce")
    )
    cos = np.where(evidence("bounce.delta"), 1.0, evidence("bounce.cos"))
    inputs = {
        "beta": (start, 0.0),
        "f": (evidence("bounce.f"), 0.0),
        "cos": (cos, 0.0),
        "pdf": (evidence("bounce.pdf"), 0.0),
    }
    rows = np.arange(cos.size)
    return judged(
        evidence,
        "bounce",
        rows,
        evidence("bounce.beta"),
        lambda beta, f, cos, pdf: beta * f * cos / pdf,
        inputs,
        "beta",
    )


_VERTEX = ("hit.p", "hit.n", "hit.wo", "hit.primitive")
_MIRROR = "A mirror or a smooth glass sends light one way only, by the laws of reflection and of Snell."
RULES = (
    Rule(
        "bounce-side",
        "Bounces leave the surface",
        "What is reflected stays on the side of wo, what is transmitted goes to the other.",
        "(n . wi)(n . wo) > 0 for reflection, < 0 for transmission",
        ("bounce.wi", "bounce.lobe", *_VERTEX),
        side,
    ),
    Rule(
        "bounce-mirror",
        "Mirrored and refracted directions",
        _MIRROR,
        "wi = 2 (n . wo) n - wo; sin i = eta sin t",
        ("bounce.wi", "bounce.delta", "bounce.lobe", *_VERTEX),
        _of_dirac(slice(0, 3), "wi"),
    ),
    Rule(
        "bounce-mirror-f",
        "The share that a mirror or glass sends on",
        "Fresnel's reflectance is reflected, the rest is transmitted; radiance that enters a medium "
        "changes by the square of the index.",
        "f = F, or (1 - F) / eta^2",
        ("bounce.f", "bounce.delta", "bounce.lobe", *_VERTEX),
        _of_dirac(slice(3, 6), "f"),
    ),
    Rule(
        "bounce-mirror-pdf",
        "The probability of a Dirac lobe",
        "The density of a Dirac lobe is the probability of choosing it.",
        "pdf = F, or 1 - F",
        ("bounce.pdf", "bounce.delta", "bounce.lobe", *_VERTEX),
        _of_dirac(slice(6, 7), "pdf"),
    ),
    Rule(
        "bounce-f",
        "f is that of the surface that is left",
        "A bounce is reflected by the material of its vertex, from wi to wo.",
        "f = f(p, wo, wi)",
        ("bounce.f", "bounce.wi", "bounce.delta", *_VERTEX),
        reflected,
    ),
    Rule(
        "bounce-cos",
        "The cosine at a bounce",
        "Each vertex has exactly one cosine, between n and wi.",
        "cos = |n . wi|",
        ("bounce.cos", "bounce.wi", *_VERTEX),
        cosine("bounce"),
    ),
    Rule(
        "bounce-pdf",
        "The density is that of the sampler",
        "The density of a bounce is that with which the surface's sampler gives its direction.",
        "pdf = p(wi | p, wo)",
        ("bounce.pdf", "bounce.wi", "bounce.delta", *_VERTEX),
        density,
    ),
    Rule(
        "bounce-before",
        "A bounce starts from the vertex's throughput",
        "Light samples change nothing of the throughput.",
        "beta_before = beta_k",
        ("bounce.beta_before", "hit.beta"),
        before,
    ),
    Rule(
        "throughput",
        "Throughput grows by f cos / pdf",
        "At every bounce the throughput is multiplied by f and the cosine and divided by the density.",
        "beta' = beta f cos / pdf, at a Dirac lobe beta f / pdf",
        ("bounce.beta", "bounce.f", "bounce.cos", "bounce.pdf", "bounce.delta"),
        throughput,
    ),
)
