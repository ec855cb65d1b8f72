"""A law that was broken, and the guesses at what breaks it, each tested on the recorded numbers."""

from dataclasses import dataclass, field

import numpy as np

MOST = 4096  # events that guesses are tested on
SHARE = 0.95  # of them a guess has to explain
CLOSE = 1e-3  # relative distance within which a number is the one that a guess predicts


@dataclass(frozen=True)
class Clue:
    """What a broken law looks like. bug: id in the catalogue, None where no guess holds; alike: ids that no
    trace tells from it; words: what was found."""

    bug: str | None
    words: str
    alike: tuple = ()
    values: dict = field(default_factory=dict)


class Case:
    """The events at which one rule fired, or an even share of them where they are many."""

    def __init__(self, evidence, outcome):
        self.evidence, self.outcome, self.kind = evidence, outcome, outcome.kind
        wrong = np.flatnonzero(outcome.wrong)
        if wrong.size > MOST:
            wrong = wrong[np.linspace(0, wrong.size - 1, MOST).astype(int)]
        self.rows = outcome.rows[wrong]
        self.recorded = None if outcome.recorded is None else np.asarray(outcome.recorded[..., wrong], float)
        self.right = None if outcome.right is None else np.asarray(outcome.right[..., wrong], float)

    @property
    def depth(self):
        """Bounces before each event, (K,)."""
        return self.evidence.trace.tables[self.kind].depth[self.rows]

    def has(self, *names):
        """Whether columns of this kind of event were recorded."""
        return all(self.evidence.has(f"{self.kind}.{name}") for name in names)

    def __getitem__(self, name):
        """A column of the events, (..., K)."""
        return self.evidence(f"{self.kind}.{name}")[..., self.rows]

    def vertex(self, name):
        """A column of the HIT that the events belong to."""
        return self.evidence.at_vertex(self.kind, name)[..., self.rows]

    def matches(self, predicted, recorded=None):
        """Share of the events whose recorded number is the predicted one."""
        recorded = self.recorded if recorded is None else recorded
        with np.errstate(all="ignore"):
            good = np.abs(recorded - predicted) <= CLOSE * np.abs(predicted) + 1e-30
        return float((good if good.ndim == 1 else good.all(axis=0)).mean()) if good.size else 0.0

    def is_(self, predicted):
        """Whether nearly all recorded numbers are the predicted ones, and these are not the right ones."""
        if self.right is not None and self.matches(predicted, self.right) >= SHARE:
            return False
        return self.matches(predicted) >= SHARE

    def times(self, factor):
        """Whether nearly all recorded numbers are the right ones times a factor."""
        return self.is_(self.right * factor)


def first(case, guesses):
    """The Clue of the first guess that holds: (bug, words, predicted numbers or True or False) each."""
    for bug, words, predicted in guesses:
        holds = predicted() if callable(predicted) else predicted
        if holds is True or (holds is not False and case.is_(holds)):
            bug, *alike = bug if isinstance(bug, tuple) else (bug,)
            return Clue(bug, words, tuple(alike))
    return None
