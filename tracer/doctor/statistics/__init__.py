"""The laws that only many events together can break."""

from dataclasses import replace

import numpy as np

from tracer.doctor.rule import CLEAN, FIRED, NOT_TESTABLE, NotRecordedError, Outcome, Rule, Verdict
from tracer.doctor.statistics import directions, film, lamps, means, numbers
from tracer.doctor.statistics.cells import ALPHA, FEW

_VERTEX = ("hit.p", "hit.n", "hit.wo", "hit.primitive")
RULES = (
    Rule(
        "numbers-once",
        "Each random number is used once",
        "Numbers for different vertices are different ones.",
        "u_i != u_j",
        ("light.u", "bounce.u", "hit.primitive"),
        numbers.once,
    ),
    Rule(
        "numbers-uniform",
        "Random numbers are uniform",
        "Random numbers fill [0, 1) evenly, and those of one use the square and the cube.",
        "P(u < x) = x",
        ("light.u", "bounce.u", "camera.film", "path.x", "path.y", "hit.primitive"),
        numbers.evenly,
    ),
    Rule(
        "numbers-independent",
        "Random numbers are independent",
        "Numbers of neighbouring pixels, samples, depths and uses have nothing to do with each other.",
        "E[(u_i - 1/2)(u_j - 1/2)] = 0",
        ("light.u", "bounce.u", "path.x", "path.y", "path.sample", "hit.primitive"),
        numbers.unrelated_ones,
    ),
    Rule(
        "film",
        "Samples lie evenly in their pixels",
        "Places on the film lie about the middle of their pixels, in the last column as in the first.",
        "E[film - pixel] = 1/2",
        ("camera.d", "path.x", "path.y"),
        film.within,
    ),
    Rule(
        "lamp-choice",
        "Lamps are chosen as often as they should be",
        "Each lamp is chosen as often as its probability says, each of its faces by its area.",
        "N(lamp) = n P(lamp)",
        ("light.light", "light.primitive"),
        lamps.chosen,
    ),
    Rule(
        "lamp-points",
        "Light points are spread evenly",
        "Points are uniform over the lamp's area, or over the solid angle in which it is seen.",
        "p(q) = 1 / A, or p(wi) = 1 / Omega",
        ("light.q", "light.primitive", "light.technique", "hit.p"),
        lamps.spread,
    ),
    Rule(
        "directions",
        "Directions come as often as their density says",
        "Diffuse surfaces choose directions of the hemisphere by the density that they claim.",
        "p(wi) = cos / pi, or 1 / (2 pi)",
        ("bounce.wi", *_VERTEX),
        directions.diffuse,
    ),
    Rule(
        "directions-beside",
        "Directions come as often as the reference's",
        "Glossy and layered surfaces choose lobes and directions as the material's own sampler does.",
        "p(wi | wo)",
        ("bounce.wi", "bounce.lobe", "bounce.delta", *_VERTEX),
        directions.others,
    ),
    Rule(
        "roulette-share",
        "As many go on as roulette says",
        "Of the paths that play, a share q goes on.",
        "N(survived) = sum of q",
        ("roulette.survived", "roulette.probability"),
        numbers.survivors,
    ),
    Rule(
        "mean",
        "Paths bring what they should",
        "By depth and technique, paths bring on average what those of a right tracer bring.",
        "E[contribution] = E[contribution of the reference]",
        ("path.radiance", "path.vertices", "path.x", "path.y", "hit.contribution"),
        means.means,
    ),
    Rule(
        "variance",
        "Samples spread as they should",
        "The samples of a pixel have the variance of those of a right tracer.",
        "Var[L] = Var[L of the reference]",
        ("path.radiance", "path.vertices", "path.x", "path.y", "hit.contribution"),
        means.variances,
    ),
)


def judged(evidence, only=None):
    """The Verdicts of all statistical rules on a trace: each of their tests has its Sidak share of ALPHA.
    only: ids of rules, to ask these alone."""
    found = [(rule, *_cells(rule, evidence)) for rule in RULES if only is None or rule.id in only]
    tests = max(1, sum(len(cells) for _, cells, _ in found))
    limit = 1.0 - (1.0 - ALPHA) ** (1.0 / tests)
    return tuple(_verdict(rule, cells, missing, limit, tests) for rule, cells, missing in found)


def _cells(rule, evidence):
    trace = evidence.trace
    if trace.left_out > FEW * np.sqrt(trace.size):
        return [], f"{trace.left_out} paths, which are left out for what they did"
    missing = [place for place in rule.needs if not evidence.has(place)]
    if missing:
        return [], ", ".join(missing)
    if not evidence.count(rule.kind):
        return [], f"no {rule.kind} events"
    try:
        with np.errstate(all="ignore"):
            return list(rule.judge(evidence)), "too few events"
    except NotRecordedError as lacking:
        return [], lacking.args[0]


def _verdict(rule, cells, missing, limit, tests):
    if not cells:
        return Verdict(rule, NOT_TESTABLE, missing=missing)
    bad = [cell for cell in cells if not cell.p > limit]
    shown = min(bad or cells, key=lambda cell: cell.p if cell.p == cell.p else 0.0)
    wrong = np.zeros(shown.rows.size, bool)
    wrong[:1] = bool(bad)
    family = min(1.0, shown.p * tests)
    outcome = Outcome(
        shown.kind, shown.rows, wrong, np.zeros_like(wrong), p=family,
        note="; ".join([*dict.fromkeys(cell.words for cell in sorted(bad, key=lambda cell: cell.p))][:3]),
        facts=shown.facts | {"cells": bad},
    )  # fmt: skip
    return replace(
        Verdict(rule, FIRED if bad else CLEAN, checked=len(cells), failed=len(bad)), outcome=outcome
    )
