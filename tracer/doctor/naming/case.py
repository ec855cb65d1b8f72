"""A law that was broken, and the guesses at what breaks it, each tested on the recorded numbers."""

from dataclasses import dataclass

import numpy as np

MOST = 4096  # events that guesses are tested on
SHARE = 0.95  # of them a guess has to explain
CLOSE = 1e-3  # relative distance within which a number is the one that a guess predicts


@dataclass(frozen=True)
class Clue:
    """What a broken law looks like. bug: id in the catalogue, None where no guess holds; alike: ids that no
    trace tells from it; words: what was found; formula: whether a guess predicted the numbers."""

    bug: str | None
    words: str
    alike: tuple = ()
    formula: bool = False


class Case:
    """The events at which one rule fired, or an even share of them where they are many.

    of: numbers of other events of the outcome to look at; guess: words of the only guess that is asked of
    them, None for all.
    """

    def __init__(self, evidence, outcome, of=None, guess=None):
        self.evidence, self.outcome, self.kind, self.guess = evidence, outcome, outcome.kind, guess
        some = np.flatnonzero(outcome.wrong) if of is None else of
        if some.size > MOST:
            some = some[np.linspace(0, some.size - 1, MOST).astype(int)]
        self.rows = outcome.rows[some]
        self.recorded = None if outcome.recorded is None else np.asarray(outcome.recorded[..., some], float)
        self.right = None if outcome.right is None else np.asarray(outcome.right[..., some], float)

    def elsewhere(self, guess):
        """The Case of the events of the same sort at which the rule did not fire, None where there are none:
        what a mistake makes of all events it makes of them, too."""
        outcome = self.outcome
        sort = _sorts(self.evidence, self.kind, outcome.rows)
        fine = ~outcome.wrong & ~outcome.unsure & np.isin(sort, sort[outcome.wrong])
        if f"{self.kind}.beta" in self.evidence.trace.rebuilt:
            fine &= _came_back(self.evidence, self.kind)[outcome.rows]
        return Case(self.evidence, outcome, np.flatnonzero(fine), guess) if fine.any() else None

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

    def agrees(self, predicted):
        """Share of the events whose recorded number is the predicted one, or for which none is predicted."""
        predicted = np.broadcast_to(predicted, self.recorded.shape)
        unsaid = ~np.isfinite(predicted)
        return self.matches(np.where(unsaid, self.recorded, predicted))

    def is_(self, predicted):
        """Whether nearly all recorded numbers are the predicted ones, and these are not the right ones."""
        if self.right is not None and self.matches(predicted, self.right) >= SHARE:
            return False
        return self.matches(predicted) >= SHARE

    def times(self, factor):
        """Whether nearly all recorded numbers are the right ones times a factor."""
        return self.is_(self.right * factor)


def _came_back(evidence, kind):
    """Whether any light came back after each event (E,): of the rest a log of calls says no throughput."""
    last = np.full(evidence.trace.size, -1)
    for giving in ("hit", "light", "escape"):
        if evidence.has(f"{giving}.contribution"):
            table = evidence.trace.tables[giving]
            some = (evidence(f"{giving}.contribution") != 0.0).any(axis=0)
            np.maximum.at(last, table.path[some], table.step[some])
    table = evidence.trace.tables[kind]
    return table.step < last[table.path]


def _sorts(evidence, kind, rows):
    """A number for each event (K,): those with the same have the same material and lobe."""
    sort = np.zeros(rows.size, np.int64)
    if kind not in ("hit", "light", "bounce") or not evidence.has("hit.primitive"):
        return sort
    primitive = evidence("hit.primitive") if kind == "hit" else evidence.at_vertex(kind, "primitive")
    sort = evidence.scene.bsdf_of.take(primitive[rows]).astype(np.int64)
    for name, many in (("lobe", 8), ("delta", 2)):
        if evidence.has(f"{kind}.{name}"):
            sort = sort * many + evidence(f"{kind}.{name}")[rows].astype(np.int64)
    return sort


def first(case, guesses):
    """The Clue of the first guess that holds: (bug, words, predicted numbers or True or False) each.

    Of a Case that asks one guess only: a Clue if it holds there, too, or predicts no numbers.
    """
    for bug, words, predicted in guesses:
        if case.guess not in (None, words):
            continue
        holds = predicted() if callable(predicted) else predicted
        if holds is False:
            good = False
        elif case.guess is None:
            good = holds is True or case.is_(holds)
        else:
            good = holds is True or case.agrees(holds) >= SHARE
        if good:
            bug, *alike = bug if isinstance(bug, tuple) else (bug,)
            return Clue(bug, words, tuple(alike), formula=holds is not True)
    return None
