"""Where two paths part, in words: for the command and for the panel."""

import numpy as np

from tracer.twin.parting import DEPTH, KIND, MISSING
from viewer.caption import shown

_SAID = {KIND: "twin.another", MISSING: "twin.over", DEPTH: "twin.depth"}


def kind_of(kind, say):
    """A kind of event by name, None for a path that is over."""
    return say("twin.nothing") if kind is None else say(f"kind.{kind}")


def event_of(kinds, say):
    """The event of both paths, or each of its own."""
    return " / ".join(dict.fromkeys(kind_of(kind, say) for kind in kinds))


def what_differs(what, say):
    """A field's name, or in words what else differs."""
    return say(_SAID[what]) if what in _SAID else what


def all_that_differs(cause, say):
    """What differs first in the pairs of a Cause, and what else does in most of them."""
    others = [name for name, count in cause.also.items() if 2 * count >= cause.pairs]
    what = what_differs(cause.what, say)
    return say("twin.then", field=what, others=say.listed(*others)) if others else what


def range_of(depths, say):
    """From the least to the largest of some depths."""
    low, high = min(depths), max(depths)
    return str(low) if low == high else say("twin.to", low=low, high=high)


def told_apart(differing, scenes, say):
    """Both values of a Number with so many digits that they do not read alike."""
    field = differing.field
    if np.asarray(differing.values[0]).dtype.kind != "f":
        return [shown(field, v, scene, say) for v, scene in zip(differing.values, scenes, strict=True)]
    for digits in (5, 9, 17):
        values = [in_digits(v, digits) for v in differing.values]
        if values[0] != values[1]:
            break
    return values


def in_digits(values, digits):
    """Numbers with so many significant digits, one space apart."""
    return " ".join(f"{float(v):.{digits}g}" for v in np.ravel(values))
