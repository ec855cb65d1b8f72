"""Light that a path runs into: what it is, and how much of it counts."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.rule import Outcome, Rule
from tracer.frame import dot


def strategy(settings):
    """How lights are found: mis, light or bsdf."""
    return {"walk": "bsdf", "direct": "light"}.get(settings.integrator, settings.strategy)


def mis(settings, mine, other):
    """Weight of the technique with density `mine`; 0 where it cannot give the direction."""
    power = 2.0 if settings.heuristic == "power" else 1.0
    ratio = (other / mine) ** power
    return np.where(mine > 0.0, 1.0 / (1.0 + np.where(np.isnan(ratio), 0.0, ratio)), 0.0)


def weight_of_bouncing(settings, pdf_bsdf, pdf_light):
    """Weight of light found by bouncing into it."""
    way = strategy(settings)
    if way == "bsdf":
        return np.ones_like(pdf_light)
    if way == "light":
        return np.isinf(pdf_bsdf).astype(float)
    return mis(settings, pdf_bsdf, pdf_light)


def radiance_of(evidence, primitive, front):
    """Radiance (3, N) that primitives send from the side that is seen, (N,)."""
    scene = evidence.scene
    light = scene.light_of.take(primitive)
    lit = (light >= 0) & front
    if not lit.any():
        return np.zeros((3, light.size))
    return np.where(lit, scene.lights.area.radiance.take(light, axis=1, mode="clip"), 0.0)


def emitted(evidence):
    """I7: the emission of each HIT."""
    primitive = evidence("hit.primitive")
    cos = dot(evidence.brute.normals(evidence("hit.p"), primitive), evidence("hit.wo"))
    right = radiance_of(evidence, primitive, cos > 0.0)
    recorded = evidence("hit.Le")
    bad = (~(np.abs(recorded - right) <= 32.0 * evidence.eps * np.abs(right))).any(axis=0)
    unsure = ~(np.abs(cos) > 64.0 * evidence.off_unit) & bad
    return Outcome("hit", np.arange(bad.size), bad & ~unsure, unsure, recorded, right, "Le")


def surrounding(evidence):
    """The radiance of the environment in each ESCAPE's direction."""

    def value(d):
        around = evidence.scene.environment(d)
        return np.zeros_like(d) if around is None else around[0]

    return _of_escapes(evidence, "Le", value)


def _of_escapes(evidence, name, value):
    """The column of that name of every ESCAPE beside value(d)."""
    inputs = {"d": (evidence("escape.d"), evidence.off_unit)}
    rows, recorded = np.arange(evidence.count("escape")), evidence(f"escape.{name}")
    sound = evidence.is_unit("escape.d")
    return judged(evidence, "escape", rows, recorded, value, inputs, name, sound=sound)


def last_density(evidence):
    """pdf_bsdf of a HIT is the density of the bounce that led there, inf after the camera or a Dirac lobe."""
    bounce, recorded = evidence.before("hit", "bounce"), evidence("hit.pdf_bsdf")
    right = np.full(recorded.shape, np.inf)
    if evidence.count("bounce"):
        pdf = np.where(evidence("bounce.delta"), np.inf, evidence("bounce.pdf"))
        right = np.where(bounce < 0, np.inf, pdf.take(bounce))
    near = np.abs(recorded - right) <= 4.0 * evidence.eps * np.where(np.isinf(right), 0.0, right)
    bad = ~(near | (recorded == right))
    return Outcome("hit", np.arange(bad.size), bad, np.zeros_like(bad), recorded, right, "pdf_bsdf")


def light_density(evidence):
    """pdf_light of a HIT on a lamp: with which density a light sample at the vertex before gives it."""
    rows = np.flatnonzero((evidence("hit.Le") > 0.0).any(axis=0))
    if not rows.size or evidence.scene.lights is None or evidence.scene.lights.area is None:
        return None
    primitive = evidence("hit.primitive")[rows]
    on_lamp = evidence.scene.light_of.take(primitive) >= 0
    rows, primitive = rows[on_lamp], primitive[on_lamp]
    o, p = evidence.arrivals[0][:, rows], evidence("hit.p")[:, rows]

    def value(o, p, primitive):
        return evidence.lamps.density(o, p, primitive)

    inputs = {"o": (o, evidence.off_point), "p": (p, evidence.off_point), "primitive": (primitive, 0.0)}
    recorded = evidence("hit.pdf_light")[rows]
    return evidence.lamps.either(evidence, "hit", rows, recorded, value, inputs)


def sky_density(evidence):
    """pdf_light of an ESCAPE into an environment."""
    if evidence.scene.lights is None or not evidence.scene.lights.surround:
        return None
    return _of_escapes(evidence, "pdf_light", evidence.lamps.surrounding)


def _weight(kind):
    def judge(evidence):
        rows = np.flatnonzero((evidence(f"{kind}.Le") > 0.0).any(axis=0))
        if not rows.size:
            return None
        pdf_bsdf, pdf_light = DENSITIES[kind](evidence, rows)
        inputs = {"pdf_bsdf": (pdf_bsdf, 0.0), "pdf_light": (pdf_light, 0.0)}

        def value(pdf_bsdf, pdf_light):
            return weight_of_bouncing(evidence.settings, pdf_bsdf, pdf_light)

        return judged(
            evidence, kind, rows, evidence(f"{kind}.w")[rows], value, inputs, "w", absolute=32 * evidence.eps
        )

    return judge


def _of_hit(evidence, rows):
    return evidence("hit.pdf_bsdf")[rows], evidence("hit.pdf_light")[rows]


def _of_escape(evidence, rows):
    bounce = evidence.before("escape", "bounce")[rows]
    pdf = np.full(rows.shape, np.inf)
    if evidence.count("bounce"):
        density = np.where(evidence("bounce.delta"), np.inf, evidence("bounce.pdf"))
        pdf = np.where(bounce < 0, np.inf, density.take(bounce))
    return pdf, evidence("escape.pdf_light")[rows]


DENSITIES = {"hit": _of_hit, "escape": _of_escape}  # pdf_bsdf and pdf_light (K,) of events (rows) of a kind


def _gain(kind):
    def judge(evidence):
        if kind == "hit":
            beta = evidence("hit.beta")
        else:
            from tracer.doctor.laws.chain import carried

            beta = carried(evidence, kind)
        inputs = {name: (evidence(f"{kind}.{name}"), 0.0) for name in ("Le", "w")} | {"beta": (beta, 0.0)}
        rows = np.arange(evidence.count(kind))
        return judged(
            evidence,
            kind,
            rows,
            evidence(f"{kind}.contribution"),
            lambda beta, Le, w: beta * Le * w,
            inputs,
            "contribution",
        )

    return judge


_ONCE = "Over all ways to find it, the weights of one light path sum to 1, so that it counts once."
_WEIGHT = "w = 1 if only bounces find lights; 0 if light samples do and could; else MIS(pdf_bsdf, pdf_light)"
RULES = (
    Rule(
        "emission",
        "Surfaces shine as the scene says",
        "A lamp sends its radiance from its front, and nothing from its back; other surfaces send none.",
        "Le(p, wo)",
        ("hit.Le", "hit.p", "hit.wo", "hit.primitive"),
        emitted,
    ),
    Rule(
        "environment",
        "The environment shines as the scene says",
        "A ray that escapes finds the environment's radiance.",
        "Le(d)",
        ("escape.Le", "escape.d"),
        surrounding,
    ),
    Rule(
        "pdf-of-last-bounce",
        "The density of the last bounce is remembered",
        "What a light found by bouncing is weighted with is the density of that bounce.",
        "pdf_bsdf = pdf, inf after the camera or a Dirac lobe",
        ("hit.pdf_bsdf", "bounce.pdf", "bounce.delta"),
        last_density,
    ),
    Rule(
        "pdf-of-light",
        "The light sampler's density at a lamp that is met",
        "With the density with which a light sample would have found the point that a bounce found.",
        "pdf_light = P(lamp) pdf_area r^2 / cos_light, or P(lamp) / solid angle",
        ("hit.pdf_light", "hit.Le", "hit.p", "hit.primitive", "camera.o", "camera.d", "bounce.wi"),
        light_density,
    ),
    Rule(
        "pdf-of-environment",
        "The light sampler's density in the direction of an escape",
        "With the density with which a light sample would have gone there.",
        "pdf_light = P(environment) pdf(d)",
        ("escape.pdf_light", "escape.d"),
        sky_density,
    ),
    Rule(
        "emission-weight",
        "Light found by bouncing counts once",
        _ONCE,
        _WEIGHT,
        ("hit.w", "hit.Le", "hit.pdf_bsdf", "hit.pdf_light"),
        _weight("hit"),
    ),
    Rule(
        "environment-weight",
        "Light of the environment counts once",
        _ONCE,
        _WEIGHT,
        ("escape.w", "escape.Le", "escape.pdf_light", "bounce.pdf", "bounce.delta"),
        _weight("escape"),
    ),
    Rule(
        "emission-term",
        "What a met lamp brings",
        "A lamp that is met brings throughput times radiance times weight.",
        "contribution = beta Le w",
        ("hit.contribution", "hit.beta", "hit.Le", "hit.w"),
        _gain("hit"),
    ),
    Rule(
        "environment-term",
        "What the environment brings",
        "The environment brings throughput times radiance times weight.",
        "contribution = beta Le w",
        ("escape.contribution", "escape.Le", "escape.w", "bounce.beta"),
        _gain("escape"),
    ),
)
