"""What a rule is, and what it says of a trace."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from tracer.events import KINDS

_AT_VERTICES = ("light", "bounce", "roulette")
FIRED, CLEAN, NOT_TESTABLE = "fired", "clean", "not_testable"


class NotRecordedError(KeyError):
    """A column that a trace does not have: "kind.field"."""


@dataclass(frozen=True)
class Rule:
    """One law of light transport, as it can be held against events.

    law: in words; formula: in symbols; needs: columns "kind.field" that judging takes, first the one that is
    judged: where it was assumed, nothing is proved; judge: from the Evidence to an Outcome, or None where
    nothing here falls under the law.
    """

    id: str
    title: str
    law: str
    formula: str
    needs: tuple
    judge: Callable

    @property
    def kind(self):
        """The kind of event that it judges."""
        return self.needs[0].split(".")[0]


@dataclass(frozen=True)
class Outcome:
    """Events of one kind held against a law.

    rows: (K,) those that fall under it; wrong, unsure: (K,) bool; recorded, right: (..., K) numbers side by
    side, None where the law is not about one number; what: name of that number. p: chance (of a statistical
    law) that a right tracer does as badly, and note what was found, in words.
    """

    kind: str
    rows: np.ndarray
    wrong: np.ndarray
    unsure: np.ndarray
    recorded: np.ndarray | None = None
    right: np.ndarray | None = None
    what: str = ""
    p: float | None = None
    note: str = ""
    facts: dict = field(default_factory=dict)


@dataclass(frozen=True)
class Verdict:
    """What a rule says of a trace: fired, clean or not_testable, and how many events it looked at.

    missing: the columns that are not there, or what else it lacks. checked counts those it could judge,
    abstained those whose verdict would flip within rounding or whose own numbers are wrong already.
    """

    rule: Rule
    state: str
    checked: int = 0
    failed: int = 0
    abstained: int = 0
    missing: str = ""
    outcome: Outcome | None = None


def applied(rule, evidence):
    """The Verdict of a rule on a trace."""
    missing = [place for place in rule.needs if not evidence.has(place)]
    if missing:
        return Verdict(rule, NOT_TESTABLE, missing=", ".join(missing))
    if rule.needs[0] in evidence.trace.assumed:
        return Verdict(rule, NOT_TESTABLE, missing=f"{rule.needs[0]} is worked out by this law")
    if not evidence.count(rule.kind):
        return Verdict(rule, NOT_TESTABLE, missing=f"no {rule.kind} events")
    try:
        with np.errstate(all="ignore"):
            outcome = rule.judge(evidence)
    except NotRecordedError as lacking:
        return Verdict(rule, NOT_TESTABLE, missing=lacking.args[0])
    if outcome is None:
        return Verdict(rule, NOT_TESTABLE, missing="nothing to judge")
    outcome = _at_vertices(rule, evidence, outcome)
    failed = int(np.count_nonzero(outcome.wrong))
    unsure = int(np.count_nonzero(outcome.unsure & ~outcome.wrong))
    return Verdict(
        rule,
        FIRED if failed else CLEAN,
        checked=outcome.rows.size - unsure,
        failed=failed,
        abstained=unsure,
        outcome=outcome,
    )


def _at_vertices(rule, evidence, outcome):
    """The Outcome that abstains where the law takes the vertex of an event, and the trace has none."""
    if outcome.kind not in _AT_VERTICES or not any(place.startswith("hit.") for place in rule.needs):
        return outcome
    nowhere = evidence.before(outcome.kind, "hit")[outcome.rows] < 0
    return replace(outcome, wrong=outcome.wrong & ~nowhere, unsure=outcome.unsure | nowhere)


def fields_of(domain):
    """Places "kind.field" of all carried fields of one domain."""
    return [
        f"{kind.name}.{f.name}" for kind in KINDS for f in kind.fields if f.carried and f.domain == domain
    ]
