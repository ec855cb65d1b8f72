"""What is seen over a vertex in words, the same in the page and in the terminal."""

from collections import Counter

import numpy as np

from viewer.numerals import short
from viewer.understanding.draws import DRAWS, OFF

NAMES = {"n": "n", "ng": "n_g", "wo": "ωₒ", "wi": "ωᵢ", "h": "h"}
KINDS = ("bounce", "lit", "blocked", "idle")


def judged(lens, say):
    """Whether bounces go where the density says: {judged: good, warning or dim, verdict: words}."""
    worst = lens.worst
    if not lens.counts:
        return {"judged": "dim", "verdict": say("lens.foreign")}
    if worst is None:
        return {"judged": "dim", "verdict": say("lens.sharp")}
    off = short(round(abs(worst.off), 2))
    if abs(worst.off) < OFF:
        return {"judged": "good", "verdict": say("lens.fits", off=off)}
    said = say("lens.misses", off=off, observed=worst.observed, expected=_expected(worst))
    return {"judged": "warning", "verdict": said}


def lobes(lens, say):
    """A line for each Dirac lobe, and for what goes nowhere."""
    return [_lobe(count, say) for count in lens.counts if isinstance(count.where, str)]


def _lobe(count, say):
    """How often bounces took a lobe, and how often they should have, where that is known."""
    lobe = say.optional(f"choice.{count.where}", say("lens.nowhere"))
    said = {"lobe": lobe, "observed": count.observed, "draws": DRAWS}
    if count.expected is None:
        return say("lens.lobe_alone", **said)
    return say("lens.lobe", **said, expected=_expected(count))


def _expected(count):
    return short(round(count.expected * DRAWS, 1))


def tried(lens, say):
    """How many directions the pixel's paths tried there."""
    kinds = Counter(one.kind for one in lens.tried)
    return say("lens.tried", n=len(lens.tried), **{kind: kinds[kind] for kind in KINDS})


def vector(w, say):
    """A shown direction (3,): its angle off n."""
    degrees = float(np.degrees(np.arctan2(np.hypot(w[0], w[1]), w[2])))  # an arc cosine of nearly 1 is coarse
    return say("lens.vector", degrees=short(round(degrees, 2)), cos=short(w[2]))
