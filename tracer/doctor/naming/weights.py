"""What makes the weights of light that is found both ways."""

import numpy as np

from tracer.doctor.laws.emission import mis
from tracer.doctor.naming.case import SHARE

_FEWEST = 64
_SMOOTH = 0.1  # share of the difference of strangers that neighbours may have


def wrong_weights(case, mine, other):
    """Guesses about a weight of the technique with density mine (K,) against that of the other (K,), and the
    last one, for when none holds."""
    settings = case.evidence.settings
    with np.errstate(all="ignore"):
        of_both = (mine / (mine + other)) ** 2
    guesses = []
    if case.has("pick"):
        without = "recorded = MIS(pdf / P(lamp), pdf_bsdf): the probability of choosing the lamp is left out"
        guesses.append(("M01", without, of_known(settings, mine / case["pick"], other)))
    guesses += [
        ("M01", "recorded = (p / (p + q))^2: the square of a sum, where a sum of squares belongs", of_both),
        ("M01", "recorded is the weight of the other technique", of_known(settings, other, mine)),
        ("M01", "recorded = MIS(2 p, q)", of_known(settings, 2.0 * mine, other)),
        ("M01", "recorded = MIS(p, 2 q)", of_known(settings, mine, 2.0 * other)),
    ]
    words = "the weights of this light found both ways do not sum to 1, all over"
    return guesses, ("M01", words, lambda: _another_function(case, mine, other))


def of_known(settings, mine, other):
    """The declared weight (K,); nan where a density is not known, or stands for certainty."""
    known = np.isfinite(mine) & np.isfinite(other)
    return np.where(known, mis(settings, mine, other), np.nan)


def _another_function(case, mine, other):
    """Whether a function of the ratio of the two densities is recorded at all events that have both, another
    than the declared one: mistakes elsewhere change some of the weights, or let them depend on more."""
    outcome = case.outcome
    both = (outcome.right > 0.0) & (outcome.right < 1.0) & ~outcome.unsure
    if not both.any() or outcome.wrong[both].mean() < SHARE:
        return False
    with np.errstate(all="ignore"):
        order = np.argsort(other / mine)
    use = np.isfinite((other / mine)[order]) & (case.right[order] < 1.0) & (case.right[order] > 0.0)
    w = case.recorded[order][use]
    if w.size < _FEWEST:
        return False
    strangers = np.abs(w - np.roll(w, w.size // 2)).mean()
    return bool(np.abs(np.diff(w)).mean() <= max(_SMOOTH * strangers, 1e-6))
