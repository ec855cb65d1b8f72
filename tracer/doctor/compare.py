"""Recorded numbers against what they have to be, within what rounding can do.

The right number is worked out in float64 from recorded ones, which are rounded themselves. The bound on the
difference is STEPS machine epsilons of the trace, relative, for the few operations that made the recorded
number; where that is not enough, the inputs are moved, one component at a time, by as much as each may be
off, and all the changes of the right number are added up (first-order error propagation, Higham 2002, 1.6,
with differences in the place of derivatives, so that a jump within reach counts as well).
"""

import numpy as np

from tracer.doctor.rule import Outcome

STEPS = 32.0
_DOUBT = 0.1  # a bound above this share of the number lets nothing be said of it


def judged(evidence, kind, rows, recorded, value, inputs, what, sound=None, most=np.inf, absolute=0.0):
    """The Outcome of one number at events `rows` (K,) of a kind.

    recorded: (..., K); value: from the inputs, as named arrays of K lanes, to the right number; inputs: name
    -> (array (..., K), how far each component may be off: a number or (K,), 0 for none); sound: (K,) where
    inputs can be relied on; most: numbers that are larger are not judged; absolute: bound on top.
    """
    given = {name: array for name, (array, _) in inputs.items()}
    sound = np.ones(rows.shape, bool) if sound is None else sound
    for array in given.values():
        if array.dtype.kind == "f":
            sound = sound & ~_any(np.isnan(array))
    right = value(**given)
    tiny = 1e-36  # what underflows in float32 underflows in any order
    bound = STEPS * evidence.eps * np.abs(right) + tiny + absolute
    suspect = np.flatnonzero(_any(~(np.abs(recorded - right) <= bound) & ~(recorded == right)) & sound)
    wrong, unsure = np.zeros(rows.shape, bool), ~sound
    if suspect.size:
        some = {name: array[..., suspect] for name, array in given.items()}
        spread = _propagated(value, some, right[..., suspect], inputs, suspect)
        bound = bound[..., suspect] + 2.0 * spread
        off = np.abs(recorded[..., suspect] - right[..., suspect])
        wrong[suspect] = _any(~(off <= bound) & (np.abs(right[..., suspect]) < most))
        doubt = bound > _DOUBT * np.maximum(np.abs(right), np.abs(recorded))[..., suspect] + absolute * 2.0
        unsure[suspect] = _any(doubt) & ~wrong[suspect]
    return Outcome(kind, rows, wrong, unsure, recorded, right, what)


def _propagated(value, given, right, inputs, lanes):
    """How far value(given) moves as each component of its inputs is moved by what it may be off, added up."""
    spread = np.zeros_like(right)
    for name, (_, off) in inputs.items():
        if np.ndim(off) == 0 and off == 0.0:
            continue
        step = off if np.ndim(off) == 0 else off[lanes]
        whole = given[name]
        for component in range(whole.shape[0] if whole.ndim == 2 else 1):
            moved = np.zeros_like(right)
            for sign in (-1.0, 1.0):
                other = whole.copy()
                if whole.ndim == 2:
                    other[component] += sign * step
                else:
                    other += sign * step
                change = np.abs(value(**(given | {name: other})) - right)
                moved = np.fmax(moved, change)
            spread += moved
    return spread


def _any(bad):
    """Whether any component of (..., K) is bad, (K,)."""
    return bad if bad.ndim == 1 else bad.any(axis=0)


def equal(evidence, kind, rows, recorded, right, what, sound=None):
    """The Outcome of what must be equal exactly: numbers of tables, flags, choices."""
    bad = _any(recorded != right)
    unsure = np.zeros(rows.shape, bool) if sound is None else ~sound
    return Outcome(kind, rows, bad & ~unsure, unsure, recorded, right, what)
