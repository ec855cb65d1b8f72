"""Roulette that a program plays and pays for, and of which its log has no word."""

import numpy as np

CLOSE = 1e-3  # relative: how far the factors of bounces may be apart that are meant to be one
NEARLY = 0.95  # of the bounces whose factor is not that of a path without roulette
SURE = 5.0  # standard errors
PRINTED = 1e-6  # relative: of a median of numbers with six digits and more
FEWEST = 64  # bounces


def shown(tables, dark):
    """The survival probability that pays for paths which end, None if none does.

    Where throughput grows by the same 1/q too much at all bounces, and a share q of the vertices that may
    send a path on does so, roulette was played with q. dark: how many vertices send nothing on anyway.
    """
    bounce, bounces = tables["bounce"], tables["bounce"].path.size
    needed = [bounce[name] for name in ("beta", "beta_before", "f", "cos", "pdf")]
    if bounces < FEWEST or any(column is None for column in needed):
        return None
    after, before, f, cos, pdf = (np.asarray(column, np.float64) for column in needed)
    with np.errstate(all="ignore"):
        factor = np.median(after * pdf / (before * f * cos), axis=0)
    factor = factor[np.isfinite(factor) & (np.abs(factor - 1.0) > CLOSE)]  # where nothing comes back it is 1
    if factor.size < FEWEST or not (q := 1.0 / float(np.median(factor))) < 1.0:
        return None
    if not (np.abs(factor * q - 1.0) <= CLOSE).mean() >= NEARLY:
        return None
    played = tables["hit"].path.size - dark
    share, error = bounces / max(played, bounces), np.sqrt(q * (1.0 - q) / max(played, 1))
    return _meant(q) if abs(share - q) <= SURE * error else None


def _meant(q):
    """The shortest number within what printing leaves open, such as 0.8."""
    short = (float(f"{q:.{digits}g}") for digits in range(1, 9))
    return next((one for one in short if abs(one / q - 1.0) <= PRINTED), q)
