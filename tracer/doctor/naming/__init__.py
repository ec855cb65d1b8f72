"""Names for broken laws: which mistake of the catalogue makes these numbers.

For each rule a few guesses, each a formula that predicts what was recorded. A guess that does not predict
nearly all of the numbers is no name: then the law and the vertex are what can be said.
"""

import numpy as np

from tracer.doctor.naming import bounce, light, many, path
from tracer.doctor.naming.case import Case, Clue

_NAMES = light.NAMES | bounce.NAMES | path.NAMES | many.NAMES


def named(evidence, rule, outcome):
    """The Clue of what breaks a rule in a trace."""
    guess = _NAMES.get(rule.id)
    clue = None
    if guess is not None:
        try:
            with np.errstate(all="ignore"):
                clue = guess(Case(evidence, outcome))
        except KeyError:  # a guess needs what was not recorded
            clue = None
    return clue or Clue(None, "")
