"""What breaks the laws of light samples."""

import numpy as np

from tracer.doctor.laws.emission import mis
from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.doctor.naming.reflection import exchanged, given_to, local, wrong_f
from tracer.doctor.naming.visibility import visible
from tracer.doctor.naming.weights import of_known, wrong_weights
from tracer.events import TECHNIQUES
from tracer.frame import dot

_INV_2PI = 0.5 / np.pi


def _cos_light(case):
    return -dot(case["nq"], case["wi"])


def term(case):
    """What a light sample brings."""
    right, q = case.right, _survival(case)
    pick = case["pick"] if case.has("pick") else 1.0
    return first(
        case,
        [
            *_wrong_geometry(case),
            ("D21", "recorded = right / q: direct light is divided by the roulette's probability", right / q),
            ("D21", "recorded = right x q: direct light pays for the roulette", right * q),
            (
                "D14",
                "recorded = right x P(lamp): the probability of choosing the lamp is left out",
                right * pick,
            ),
            ("M01", "recorded = right / w: the weight is left out", right / case["w"]),
            (None, "recorded = right x pdf: the density is left out", right * case["pdf"]),
            (None, "recorded without the throughput", right / case["beta"]),
            (None, "recorded without f", right / case["f"]),
            (
                None,
                "what is hidden counts as if it were seen",
                lambda: bool(np.mean(~case["visible"].astype(bool)) >= SHARE),
            ),
        ],
    )


def _wrong_geometry(case):
    """Guesses about cosines, distance and measure in what a light sample brings."""
    right, r, cos, pdf = case.right, case["distance"], case["cos"], case["pdf"]
    cos_light = _cos_light(case)
    behind = lambda: bool(np.mean((case.recorded.min(axis=0) < 0.0) & (cos_light < 0.0)) >= SHARE)  # noqa: E731
    per_angle = "recorded = right x pdf / pdf_area: the density per area is used as one per solid angle"
    twice = "recorded = right x cos_light / r^2: the geometry term is there twice"
    to_area = cos_light / (r * r)
    return [
        ("D08", "recorded < 0, and only behind the lamp: its cosine is not clamped", behind),
        ("D07", "recorded = -right: the lamp's cosine has the wrong sign", -right),
        ("D10", "recorded = right / cos: the cosine at the surface is missing", right / cos),
        ("D10", "recorded = right x cos: there is one cosine too many", right * cos),
        ("D11", "recorded = right x r: divided by the distance, not by its square", right * r),
        ("D11", "recorded = right x r^2: not divided by the square of the distance", right * r * r),
        ("D13", per_angle, right * pdf / (pdf * to_area)),
        ("D13", twice, right * to_area),
        (None, "recorded = right / cos_light: a cosine of the lamp too few", right / cos_light),
        (None, "recorded = right x cos_light: a cosine of the lamp too many", right * cos_light),
    ]


def _survival(case):
    q = case.evidence.settings.roulette
    return float(q) if q not in ("auto", "off") else 1.0


def density(case):
    """The density of a light sample."""
    r, cos_light = case["distance"], _cos_light(case)
    pick = case.evidence.lamps.pick.take(case["light"])
    to_area = cos_light / (r * r)
    guesses: list = [
        (
            "D14",
            "recorded = right / P(lamp): the probability of choosing the lamp is left out",
            case.right / pick,
        ),
        ("D13", "recorded is the density per area, without r^2 / cos_light", case.right * to_area),
        (
            None,
            "recorded = right x cos_light: the lamp's cosine is missing in the density",
            case.right * cos_light,
        ),
        ("D11", "recorded = right / r: r where r^2 belongs", case.right / r),
        (None, "recorded = right x pi", case.right * np.pi),
        (None, "recorded = right x 2", case.right * 2.0),
        (None, "recorded = right / 2", case.right / 2.0),
    ]
    rows = np.flatnonzero(case["primitive"] >= 0)
    if rows.size == case.rows.size:
        other = case.evidence.lamps.density(case.vertex("p"), case["q"], case["primitive"], area=True)
        guesses.append(
            (
                None,
                "recorded is the density of sampling the lamp by area, which is not what is declared",
                other,
            )
        )
    behind = lambda: bool(np.mean((cos_light < 0.0) & (case.right == 0.0) & (case.recorded != 0.0)) >= SHARE)  # noqa: E731
    guesses.append((("E06", "D08"), "recorded > 0 behind the lamp, which shines from its front only", behind))
    return first(case, guesses)


def pick(case):
    """The probability of a lamp."""
    one = np.ones_like(case.right)
    return first(case, [("D14", "recorded 1: the lamp's probability is left out", one)])


def from_nowhere(case):
    """Light that arrives from where none can."""
    outcome, evidence = case.outcome, case.evidence
    back = outcome.facts["back"]
    if back[outcome.wrong].mean() < SHARE:
        return Clue(None, "light arrives from below the surface") if not back[outcome.wrong].any() else None
    rows = outcome.rows[back]
    p, q = evidence.at_vertex("light", "p")[:, rows], evidence("light.q")[:, rows]
    source, lamp = evidence.at_vertex("light", "primitive")[rows], evidence("light.primitive")[rows]
    _, maybe = evidence.brute.between(p, q, source, lamp, 4.0 * evidence.off_vertex)
    some = outcome.recorded[:, back][
        :, ~(maybe | evidence.brute.is_sphere.take(lamp))
    ]  # a ball hides its back
    if some.size and (some > 0.0).any(axis=0).mean() >= SHARE:
        return Clue("E06", "the lamp shines from its back")
    if some.size and (some < 0.0).any(axis=0).mean() >= SHARE:
        return Clue("D08", "recorded < 0, and only behind the lamp: its cosine is not clamped")
    return None


def radiance(case):
    """The radiance of a light point."""
    back = (_cos_light(case) < 0.0) & (case.right == 0.0).all(axis=0) & (case.recorded != 0.0).any(axis=0)
    negative = bool((case.evidence("light.contribution") < 0.0).any()) if case.has("contribution") else False
    guess = (
        ("D08", "the lamp's cosine is negative there, and what arrives is, too")
        if negative
        else ("E06", "the lamp shines from its back")
    )
    return first(case, [(*guess, bool(back.mean() >= SHARE))])


def reflected(case):
    """f at a light sample."""
    given = given_to(case)
    of_lamp = "recorded is the f of the lamp's material, not of the surface's"
    same = "f is the same at surfaces of different materials: that of the lamp's"
    return first(
        case,
        [
            ("D06", of_lamp, lambda: _of_the_lamp(case, given)),
            ("D06", same, lambda: _grey_everywhere(case, given)),
            *wrong_f(case, given, case["wi"]),
        ],
    )


def _of_the_lamp(case, given):
    """What the lamp's BSDF says, (3, K); False where a light has none."""
    primitive, scene = case["primitive"], case.evidence.scene
    if (primitive < 0).any():
        return False
    frame = scene.frame(given["n"], given["p"], given["primitive"])
    local_wo, local_wi = frame.to_local(given["wo"]), frame.to_local(case["wi"])
    return scene.bsdf.eval(scene.bsdf_of.take(primitive), local_wo, local_wi)


def _grey_everywhere(case, given):
    """Whether f is one number at surfaces of several materials."""
    lit = case.recorded.max(axis=0) > 0.0
    here = case.recorded[:, lit]
    several = np.unique(case.evidence.scene.bsdf_of.take(given["primitive"][lit])).size > 1
    return bool(several and here.size and np.ptp(here, axis=1).max() <= 1e-3 * here.max())


def density_of_bouncing(case):
    """pdf_bsdf of a light sample."""
    given, wi = given_to(case), case["wi"]
    return first(
        case,
        [
            (
                "W02",
                "recorded = pdf(wo | wi): the density of the opposite way",
                lambda: exchanged(case.evidence, given, wi, "pdf"),
            ),
            (
                "M01",
                "recorded 1/(2 pi): the density of a uniform bounce, which is not what is used",
                np.full_like(case.right, _INV_2PI),
            ),
            (
                "W04",
                "recorded is the density asked with world directions",
                lambda: local(case.evidence, given, wi, "pdf"),
            ),
        ],
    )


def weight(case):
    """The MIS weight of a light sample."""
    settings, pdf = case.evidence.settings, case["pdf"]
    uniform = mis(settings, pdf, np.full_like(pdf, _INV_2PI))
    others, unbalanced = wrong_weights(case, pdf, case["pdf_bsdf"])
    if case.has("distance", "nq", "wi"):
        of_area = of_known(settings, pdf * _cos_light(case) / case["distance"] ** 2, case["pdf_bsdf"])
        per_area = "recorded = MIS(pdf_area, pdf_bsdf): the lamp's density is the one per area"
        others.append(("M01", per_area, of_area))
    return first(
        case,
        [
            (
                "M01",
                "recorded = MIS(pdf, 1/(2 pi)): the other density is that of a sampler that is not used",
                uniform,
            ),
            *others,
            ("M01", "recorded 1, though bounces find this light, too", np.ones_like(pdf)),
            (
                "M02",
                "a light that no bounce can meet is weighted",
                bool(np.mean(case["technique"] == TECHNIQUES.index("delta")) >= SHARE)
                if case.has("technique")
                else False,
            ),
            unbalanced,
        ],
    )


def left(case):
    """What the way lets through."""
    return first(case, [("A01", "recorded 1: nothing is absorbed on the way", np.ones_like(case.right))])


def unit(case):
    """Directions to lights that are not unit."""
    size = case.recorded
    return first(
        case,
        [
            (
                "D20",
                "the direction to the light keeps its length r",
                case["distance"] if case.has("distance") else False,
            ),
            ("D20", "the direction to the light is the difference of the points", lambda: _apart(case)),
            ("D20", "the direction is not made unit", bool(np.isfinite(size).all())),
        ],
    )


def _apart(case):
    gap = case["q"] - case.vertex("p")
    return np.sqrt(dot(gap, gap))


NAMES = {
    "light-term": term,
    "light-nothing": from_nowhere,
    "light-visible": visible,
    "light-pdf": density,
    "light-pick": pick,
    "light-radiance": radiance,
    "light-f": reflected,
    "light-pdf-bsdf": density_of_bouncing,
    "light-weight": weight,
    "light-transmittance": left,
    "transmittance": left,
    "unit-light": unit,
}
