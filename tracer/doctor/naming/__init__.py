"""Names for broken laws: which mistake of the catalogue makes these numbers.

For each rule a few guesses, each a formula that predicts what was recorded. A guess that does not predict
nearly all of the numbers, those that are right as well, is no name: then the law and the vertex are what can
be said, and by which of the event's own numbers the recorded one is off, where it is a product of them
(`factors`).
"""

import numpy as np

from tracer.doctor.naming import bounce, emission, ends, factors, light, many, path, surface
from tracer.doctor.naming.case import Case, Clue

_FAMILIES = (ends, path, surface, emission, light, bounce, many)
_NAMES = {law: guess for family in _FAMILIES for law, guess in family.NAMES.items()}


def named(evidence, rule, outcome):
    """The Clue of what breaks a rule in a trace."""
    case, guess = Case(evidence, outcome), _NAMES.get(rule.id)
    clue = None
    with np.errstate(all="ignore"):
        if guess is not None:
            try:
                clue = guess(case)
            except KeyError:  # a guess needs what was not recorded
                clue = None
        if clue is not None and clue.formula and clue.bug is not None:
            clue = _if_everywhere(case, guess, clue)
        if clue is None and outcome.p is None:
            clue = Clue(None, factors.words(case))
    return clue or Clue(None, "")


def _if_everywhere(case, guess, clue):
    """The Clue of a guess that predicts numbers; without its name where others of the same sort are right
    against it."""
    others = case.elsewhere(clue.words)
    if others is None:
        return clue
    try:
        holds = guess(others)
    except KeyError:
        holds = None
    if holds is not None and holds.words == clue.words:
        return clue
    return Clue(None, f"{clue.words}; but others of the same sort are right")
