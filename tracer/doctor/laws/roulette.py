"""How paths are ended by chance, and what the survivors carry for it."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.laws.chain import carried
from tracer.doctor.rule import NotRecordedError, Outcome, Rule
from tracer.integrator.steps import AUTO_DEPTH, AUTO_MOST


def chance(settings, beta, depth):
    """Probability (N,) to go on after a bounce with throughput beta (3, N)."""
    if settings.roulette == "off":
        return np.ones(depth.shape)
    if settings.roulette != "auto":
        return np.full(depth.shape, float(settings.roulette))
    return np.where(depth < AUTO_DEPTH, 1.0, np.minimum(beta.max(axis=0), AUTO_MOST))


def probability(evidence):
    """I9: the probability is the one that is declared."""
    settings, depth = evidence.settings, evidence.trace.tables["roulette"].depth
    rows = np.arange(depth.size)
    if "roulette" in evidence.trace.free:
        q = evidence("roulette.probability")
        return Outcome(
            "roulette", rows, ~(q > 0.0), np.zeros(q.shape, bool), q, np.ones_like(q), "probability"
        )
    inputs = {"beta": (carried(evidence, "roulette"), 0.0), "depth": (depth, 0.0)}
    recorded = evidence("roulette.probability")
    return judged(
        evidence,
        "roulette",
        rows,
        recorded,
        lambda beta, depth: chance(settings, beta, depth),
        inputs,
        "probability",
    )


def played(evidence):
    """I9: roulette is played where its probability is below 1, and there only."""
    if "roulette" in evidence.trace.free:
        raise NotRecordedError("one probability, declared")
    depth = evidence.trace.tables["bounce"].depth
    here = _beside(evidence, evidence.after("bounce", "roulette"), 1)
    here |= _beside(evidence, evidence.before("bounce", "roulette"), -1)
    due = chance(evidence.settings, evidence("bounce.beta"), depth) < 1.0
    if "roulette-start" in evidence.trace.free and here.any():
        due &= depth >= depth[here].min()
    bad = here != due
    return Outcome("bounce", np.arange(bad.size), bad, np.zeros_like(bad), here, due, "roulette played")


def _beside(evidence, row, steps):
    """Whether the roulette in each of these rows, -1 for none, is so many steps after its bounce."""
    here = row >= 0
    step = evidence.trace.tables["roulette"].step.take(row[here])
    here[here] = step == evidence.trace.tables["bounce"].step[here] + steps
    return here


def survival(evidence):
    """I9: who draws less than the probability goes on."""
    u, q = evidence("roulette.u"), evidence("roulette.probability")
    right = u < q
    survived = evidence("roulette.survived").astype(bool)
    unsure = np.abs(u - q) <= (2.0 * evidence.eps if evidence.eps > 1e-6 else 0.0)
    return Outcome(
        "roulette", np.arange(u.size), (survived != right) & ~unsure, unsure, survived, right, "survived"
    )


def paid(evidence):
    """I9: every survivor carries exactly one 1/q."""
    rows = np.flatnonzero(evidence("roulette.survived"))
    inputs = {
        "beta": (carried(evidence, "roulette")[:, rows], 0.0),
        "q": (evidence("roulette.probability")[rows], 0.0),
    }
    recorded = evidence("roulette.beta")[:, rows]
    return judged(evidence, "roulette", rows, recorded, lambda beta, q: beta / q, inputs, "beta")


RULES = (
    Rule(
        "roulette-probability",
        "The survival probability is the declared one",
        "Russian roulette may be played with any probability above 0; this trace declares which.",
        "q as declared",
        ("roulette.probability", "bounce.beta"),
        probability,
    ),
    Rule(
        "roulette-played",
        "Roulette is played where it is due",
        "Paths are ended by roulette wherever its probability is below 1, and nowhere else.",
        "q < 1",
        ("bounce.beta",),
        played,
    ),
    Rule(
        "roulette-survival",
        "Who draws less than q goes on",
        "A share q of the paths goes on.",
        "survived = (u < q)",
        ("roulette.survived", "roulette.u", "roulette.probability"),
        survival,
    ),
    Rule(
        "roulette-weight",
        "Survivors stand in for the dead",
        "Each survivor carries exactly one 1/q.",
        "beta' = beta / q",
        ("roulette.beta", "roulette.probability", "roulette.survived"),
        paid,
    ),
)
