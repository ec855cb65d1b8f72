"""What breaks the laws of light that a path runs into."""

import numpy as np

from tracer.doctor.laws.emission import DENSITIES, mis
from tracer.doctor.naming.case import SHARE, Clue, first
from tracer.doctor.naming.weights import of_known, wrong_weights
from tracer.frame import dot


def weight(case):
    """The weight of a lamp that is met."""
    settings, recorded = case.evidence.settings, case.recorded
    pdf_bsdf, pdf_light = DENSITIES[case.kind](case.evidence, case.rows)
    twice = bool(((recorded == 1.0) & (case.right < 1.0)).mean() >= SHARE)
    never = bool(((recorded == 0.0) & (case.right == 1.0)).mean() >= SHARE)
    depths = ", ".join(map(str, np.unique(case.depth)))
    outcome = case.outcome
    others, unbalanced = wrong_weights(case, pdf_bsdf, pdf_light)
    others += _per_area(case, pdf_bsdf, pdf_light)
    # Of lamps that are met alike, some only: then it is not the rule that is wrong.
    alike = outcome.right < 1.0 if twice else outcome.right == 1.0
    everywhere = bool(outcome.wrong[alike].mean() >= SHARE)
    return first(
        case,
        [
            (
                ("E01", "E04"),
                "recorded 1 at lamps that light samples counted at the vertex before: counted twice",
                twice and everywhere,
            ),
            (
                None,
                f"recorded 1 at depth {depths}, at lamps that light samples counted at the vertex before",
                twice,
            ),
            (
                "E02",
                "recorded 0 at lamps that nothing else can count: their own light is lost",
                never and everywhere,
            ),
            (
                None,
                f"recorded 0 at some lamps that nothing else can count, at depth {depths}",
                never,
            ),
            (
                "M02",
                "recorded = MIS(1, pdf_light) after the camera or a mirror, which no light sample does",
                lambda: _of_dirac(case, pdf_bsdf, mis(settings, np.ones_like(pdf_light), pdf_light)),
            ),
            *others,
            unbalanced,
        ],
    )


def _per_area(case, pdf_bsdf, pdf_light):
    """The guess that the density of a light sample is the one per area."""
    if case.kind != "hit" or not case.has("t"):
        return []
    cos = np.abs(dot(case["n"], case["wo"]))
    of_area = of_known(case.evidence.settings, pdf_bsdf, pdf_light * cos / case["t"] ** 2)
    return [("M01", "recorded = MIS(pdf_bsdf, pdf_area): the lamp's density is the one per area", of_area)]


def _of_dirac(case, pdf_bsdf, predicted):
    """What is predicted after the camera and Dirac lobes alone; False where others are wrong, too."""
    dirac = np.isinf(pdf_bsdf)
    if case.guess is None and dirac.mean() < SHARE:
        return False
    return np.where(dirac, predicted, np.nan)


def emission(case):
    """Le of a vertex."""
    nothing = (case.recorded == 0.0).all(axis=0) & (case.right > 0.0).any(axis=0)
    n = case.evidence.brute.normals(case["p"], case["primitive"])
    back = (dot(n, case["wo"]) < 0.0) & (case.recorded > 0.0).any(axis=0)
    return first(
        case,
        [
            (
                "E03",
                "recorded 0 on a lamp's bright side: its emission is read from where it was never put",
                bool(nothing.mean() >= SHARE),
            ),
            ("E06", "the lamp shines from its back", bool(back.mean() >= SHARE)),
        ],
    )


def last_density(case):
    """pdf_bsdf of a vertex."""
    early = np.isfinite(case.recorded) & np.isinf(case.right)
    if early.mean() >= SHARE:
        return Clue(None, "recorded a number after the camera, a mirror or glass, where it is infinite")
    return None


def escaped(case):
    """What a ray brings that meets nothing."""
    if np.any(case.right != 0.0):
        return None
    return Clue(None, "nothing is met there: what was met before may be used again")


NAMES = {
    "environment-term": escaped,
    "pdf-of-last-bounce": last_density,
    "emission-weight": weight,
    "environment-weight": weight,
    "emission": emission,
}
