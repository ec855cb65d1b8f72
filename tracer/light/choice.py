"""With which probability lights are chosen, as light samples say it."""

import numpy as np

_EVEN = 16.0  # machine epsilons by which probabilities of one light may differ, and their sum from 1


def said(light, pick, own, eps):
    """Probability of each light (L,) of a sampler that chooses in its own way, from what its samples say.

    light, pick: the number of each sample's light (N,), and the probability with which it was chosen (N,).
    own: the probabilities (L,) that castray has. eps: of the numbers in `pick`. None where there is nothing
    to be taken over: they are castray's, depend on more than the light, or cannot add up to 1. What is left
    over is shared by the lights that were never chosen: evenly if the others are chosen evenly, else as `own`
    has it.
    """
    size, near = own.size, _EVEN * eps
    if size < 2 or not light.size or not np.isfinite(pick).all():
        return None
    low, high = np.full(size, np.inf), np.full(size, -np.inf)
    np.minimum.at(low, light, pick)
    np.maximum.at(high, light, pick)
    seen = np.isfinite(low)
    as_own, evenly = ((np.abs(high - way) <= near * high)[seen].all() for way in (own, 1.0 / size))
    if as_own or not ((low > 0.0) & (high - low <= near * high))[seen].all():
        return None
    rest = 1.0 - high[seen].sum()
    if seen.all():
        return high if abs(rest) <= near else None
    share = np.where(seen, 0.0, 1.0 if evenly else own)
    return np.where(seen, high, rest * share / share.sum()) if rest > near else None
