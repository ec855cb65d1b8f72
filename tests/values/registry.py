"""What castray makes of the values in truth.json: functions that say which keys they are for.

    @kernel("fresnel.R0.")
    def head_on(key, given, to):               # the number, in the precision of `to`

    @estimator("rect.corner.", n=100_000)
    def corners(key, given, bits, seed, n):    # n independent estimates (n,), or one Estimate

    @bound("gamma3.")
    def products(key, given, to):              # a number that may not be above the value

    @refuted("accum.naive.")
    def variance(key, given, to):              # a number that must not be the value

given: the key's parameters; to(x) makes inputs of them. but: parts of keys that are left to others.
only, why: the one precision in which there is such a number, and the reason.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from truth import PERCENT, SIGMAS, entry, keys

DTYPES = {32: np.float32, 64: np.float64}
ROUNDING = {32: 1e-5, 64: 1e-12}  # relative, of an estimate that has no noise
MOST_GOES = 64
EVALUATORS = {}


class Precision(NamedTuple):
    """In which precision a number is made."""

    bits: int
    of: int  # precision to which inputs are rounded before

    def __call__(self, x):
        """An input, in this precision."""
        return np.asarray(x, np.float64).astype(DTYPES[self.of]).astype(self.dtype)

    @property
    def dtype(self):
        """Its NumPy type."""
        return DTYPES[self.bits]


class Evaluator(NamedTuple):
    """How castray comes to a value."""

    kind: str  # kernel, estimator, bound or refuted
    make: Callable
    bits: tuple  # the precisions it is for
    why: str  # why not for both
    n: int  # samples of an estimator in one go
    slack: float  # relative error that its scene has by construction
    dear: bool  # an estimate takes seconds: the tests make it in float32 only, `make accuracy` in both


class Estimate(NamedTuple):
    """A mean of random numbers."""

    mean: float
    error: float  # standard error

    @classmethod
    def of(cls, samples):
        """The mean of independent samples (n,)."""
        samples = np.asarray(samples, np.float64)
        return cls(float(samples.mean()), float(samples.std(ddof=1) / np.sqrt(samples.size)))

    @classmethod
    def together(cls, parts):
        """The mean of estimates that are worth the same."""
        error = np.sqrt(sum(part.error**2 for part in parts)) / len(parts)
        return cls(sum(part.mean for part in parts) / len(parts), float(error))


def _registering(kind):
    def of(*starts, but=(), only=None, why="", n=0, slack=0.0, dear=False):
        def register(make):
            for key in keys(*starts):
                if any(part in key for part in but):
                    continue
                assert key not in EVALUATORS, key
                bits = (only,) if only else (32, 64)
                EVALUATORS[key] = Evaluator(kind, make, bits, why, n, slack, dear)
            return make

        return register

    return of


kernel, estimator, bound, refuted = map(_registering, ("kernel", "estimator", "bound", "refuted"))


def evaluated(*kinds):
    """(key, bits) of everything that castray has a number for, of some kinds."""
    return [(key, bits) for key, e in EVALUATORS.items() if e.kind in kinds for bits in e.bits]


def number(key, bits, of=None):
    """What castray makes of a key that needs no random numbers. of: precision of its inputs, if another."""
    with np.errstate(all="ignore"):  # as the loops do
        return EVALUATORS[key].make(key, entry(key)[0], Precision(bits, of or bits))


def kernel_error(key, bits):
    """How far a kernel is off: relative to the table in float64; in float32 in ulp, from the kernel in
    float64 for the inputs that float32 has. A value of 0 is met exactly or not at all."""
    got, want = float(number(key, bits)), entry(key)[1]
    if bits == 32:
        want = float(number(key, 64, of=32))
    off = abs(got - want)
    if not off <= 0.0 and want != 0.0:
        off /= abs(want) if bits == 64 else float(np.spacing(np.float32(abs(want))))
    return off if want != 0.0 or off == 0.0 else np.inf


def estimate(key, bits, seed):
    """One Estimate of a key."""
    found = EVALUATORS[key].make(key, entry(key)[0], bits, seed, EVALUATORS[key].n)
    return found if isinstance(found, Estimate) else Estimate.of(found)


def to_a_percent(key, bits, seed):
    """The Estimate of as many goes as bring SIGMAS standard errors to 1 % of the value."""
    parts = []
    while True:
        parts.append(estimate(key, bits, seed + 7919 * len(parts)))
        whole = Estimate.together(parts)
        if SIGMAS * whole.error <= PERCENT * abs(entry(key)[1]) or len(parts) == MOST_GOES:
            return whole


def off(key, bits, found):
    """How far an Estimate is off its value, in units of what it may be off: SIGMAS errors and slack."""
    value = entry(key)[1]
    slack = EVALUATORS[key].slack + ROUNDING[bits]
    return abs(found.mean - value) / (SIGMAS * found.error + slack * abs(value))
