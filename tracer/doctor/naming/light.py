"""What breaks the laws of light samples."""

import numpy as np

from tracer.doctor.laws.emission import mis
from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.doctor.naming.reflection import exchanged, given_to, leaks, local, materials, mixed, nothing_rough
from tracer.events import TECHNIQUES
from tracer.frame import dot

_INV_2PI = 0.5 / np.pi


def _cos_light(case):
    return -dot(case["nq"], case["wi"])


def term(case):
    """What a light sample brings."""
    ratio = case.right
    r, cos, pdf, w = case["distance"], case["cos"], case["pdf"], case["w"]
    cos_light = _cos_light(case)
    per_area = pdf * cos_light / (r * r)
    q = _survival(case)
    pick = case["pick"] if case.has("pick") else 1.0
    return first(
        case,
        [
            (
                "D08",
                "recorded < 0, and only behind the lamp: its cosine is not clamped",
                lambda: bool(np.mean((case.recorded.min(axis=0) < 0.0) & (cos_light < 0.0)) >= SHARE),
            ),
            ("D07", "recorded = -right: the lamp's cosine has the wrong sign", -ratio),
            ("D10", "recorded = right / cos: the cosine at the surface is missing", ratio / cos),
            ("D10", "recorded = right x cos: there is one cosine too many", ratio * cos),
            ("D11", "recorded = right x r: divided by the distance, not by its square", ratio * r),
            ("D11", "recorded = right x r^2: not divided by the square of the distance", ratio * r * r),
            (
                "D13",
                "recorded = right x pdf / pdf_area: the density per area is used as one per solid angle",
                ratio * pdf / per_area,
            ),
            (
                "D13",
                "recorded = right x cos_light / r^2: the geometry term is there twice",
                ratio * cos_light / (r * r),
            ),
            ("D21", "recorded = right / q: direct light is divided by the roulette's probability", ratio / q),
            ("D21", "recorded = right x q: direct light pays for the roulette", ratio * q),
            (
                "D14",
                "recorded = right x P(lamp): the probability of choosing the lamp is left out",
                ratio * pick,
            ),
            (None, "recorded = right / cos_light: a cosine of the lamp too few", ratio / cos_light),
            (None, "recorded = right x cos_light: a cosine of the lamp too many", ratio * cos_light),
            ("M01", "recorded = right / w: the weight is left out", ratio / w),
            (None, "recorded = right x pi", ratio * np.pi),
            (None, "recorded = right / pi", ratio / np.pi),
            (None, "recorded = right x 2", ratio * 2.0),
            (None, "recorded = right / 2", ratio / 2.0),
            (None, "recorded = right x pdf: the density is left out", ratio * pdf),
            (None, "recorded without the throughput", ratio / case["beta"]),
            (None, "recorded without f", ratio / case["f"]),
            (
                None,
                "what is hidden counts as if it were seen",
                lambda: bool(np.mean(~case["visible"].astype(bool)) >= SHARE),
            ),
        ],
    )


def _survival(case):
    q = case.evidence.settings.roulette
    return float(q) if q not in ("auto", "off") else 1.0


def visible(case):
    """Whether light points are seen."""
    outcome = case.outcome
    sure = ~outcome.unsure
    seen, free = outcome.recorded.astype(bool)[sure], outcome.right.astype(bool)[sure]
    wrongly_dark, wrongly_seen = ~seen & free, seen & ~free
    if not wrongly_seen.any() and not (seen & free).any():
        return Clue(
            "D04",
            "no light point at all is seen, though nothing lies before it but the lamp itself",
            ("D03",),
        )
    if not wrongly_seen.any():
        share = wrongly_dark.sum() / free.sum()
        return Clue(
            "D01",
            f"{share:.0%} of the free light points count as blocked, by the lamp itself: the "
            "comparison of the two distances has no tolerance, and rounding decides",
            ("D02",),
        )
    dark, hidden = wrongly_dark.mean(), ~free
    if dark <= 0.01 and (seen & hidden).sum() >= 0.99 * hidden.sum():
        return Clue("D03", "every blocked light point counts as seen: the test is not made, or reversed")
    if wrongly_dark.sum() >= 0.99 * free.sum() and wrongly_seen.sum() >= 0.99 * hidden.sum():
        return Clue("D03", "seen and blocked are exchanged")
    if not wrongly_dark.any():
        return Clue(
            None, f"{wrongly_seen.sum() / hidden.sum():.0%} of the blocked light points count as seen"
        )
    return Clue(None, "some free light points count as blocked, and some blocked ones as seen")


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
    evidence = case.evidence
    given = given_to(case)
    right, wi, wo, n = case.right, case["wi"], given["wo"], given["n"]
    cos = np.abs(dot(n, wi))

    def lamp():
        primitive = case["primitive"]
        if (primitive < 0).any():
            return False
        frame = evidence.scene.frame(n, given["p"], given["primitive"])
        return evidence.scene.bsdf.eval(
            evidence.scene.bsdf_of.take(primitive), frame.to_local(wo), frame.to_local(wi)
        )

    def grey():
        lit = case.recorded.max(axis=0) > 0.0
        here = case.recorded[:, lit]
        several = np.unique(evidence.scene.bsdf_of.take(given["primitive"][lit])).size > 1
        return bool(several and here.size and np.ptp(here, axis=1).max() <= 1e-3 * here.max())

    return first(
        case,
        [
            (
                "G09",
                "light from below the true surface is let through by the shading normal",
                lambda: leaks(case, given, wi),
            ),
            (
                "S08",
                "recorded NaN on rough surfaces: a roughness of 0 is divided by",
                lambda: nothing_rough(case, given),
            ),
            ("D06", "recorded is the f of the lamp's material, not of the surface's", lamp),
            ("D06", "f is the same at surfaces of different materials: that of the lamp's", grey),
            ("B03", "recorded = right x pi: 1/pi is missing", right * np.pi),
            (None, "recorded = right / pi: 1/pi is there twice", right / np.pi),
            ("D10", "recorded = right x cos: the cosine is in f already", right * cos),
            (
                "B14",
                "recorded = f(wi, wo): the two directions are exchanged",
                lambda: exchanged(evidence, given, wi, "eval"),
            ),
            (
                "B14",
                "recorded = f(wi, wi): wi is given for both directions",
                lambda: evidence.asked(**given | {"wo": wi}, wi=wi, what="eval"),
            ),
            (
                "W04",
                "recorded is f asked with world directions as if they were local",
                lambda: local(evidence, given, wi, "eval"),
            ),
            (
                "W04",
                "recorded is f asked with a local wo and wi in world space",
                lambda: mixed(evidence, given, wi, "eval"),
            ),
        ]
        + materials(case, given, wi),
    )


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
    other = mis(settings, case["pdf_bsdf"], pdf)
    return first(
        case,
        [
            (
                "M01",
                "recorded = MIS(pdf, 1/(2 pi)): the other density is that of a sampler that is not used",
                uniform,
            ),
            ("M01", "recorded is the weight of the other technique", other),
            ("M01", "recorded 1, though bounces find this light, too", np.ones_like(pdf)),
            (
                "M02",
                "a light that no bounce can meet is weighted",
                bool(np.mean(case["technique"] == TECHNIQUES.index("delta")) >= SHARE)
                if case.has("technique")
                else False,
            ),
        ],
    ) or Clue("M01", "the weights of this light found both ways do not sum to 1")


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
