"""A number that is held between bounds before it is used, such as 1/r^2 against white dots.

Where the bound acts, something else stands in the place of the right number, and it is always the same.
"""

import numpy as np

from tracer.doctor.naming.case import CLOSE, SHARE
from tracer.frame import dot

_FEWEST = 16  # events at which a bound has to act


def words(case, ratio, there):
    """A sentence such as "as if r^2 were never less than 400"; "" where no bound fits.

    ratio: recorded over right (..., K) at the events `there` of the case.
    """
    if case.kind != "light" or case.outcome.what != "contribution":
        return ""
    for name, value, above in _quantities(case, there):
        bound = _same(ratio * value if above else value / ratio, ratio)
        if bound is not None:
            if (np.nanmax(ratio) < 1.0) == above:
                return f"as if {name} were never more than {bound:.4g}"
            return f"as if {name} were never less than {bound:.4g}"
    return _cut(case, there)


def _quantities(case, there):
    """(name, values, whether the right number grows with it)."""
    r2 = case["distance"][there] ** 2
    cos, cos_light = case["cos"][there], -dot(case["nq"], case["wi"])[there]
    yield "r^2", r2, False
    yield "cos cos_light / r^2", cos * cos_light / r2, True
    yield "cos", cos, True
    yield "cos_light", cos_light, True
    yield "pdf", case["pdf"][there], False


def _same(values, ratio):
    """The number that nearly all are, where the bound acts in one direction only; else None."""
    less = ratio < 1.0
    if np.isfinite(ratio).sum() < _FEWEST or not (less.all() or not less.any()):
        return None
    bound = float(np.nanmedian(values))
    good = (np.abs(values - bound) <= CLOSE * abs(bound)) | ~np.isfinite(values)
    return bound if (good if good.ndim == 1 else good.all(axis=0)).mean() >= SHARE else None


def _cut(case, there):
    """Where each channel of what a sample brings is cut by itself."""
    brought = (case.recorded / case["beta"])[:, there]
    lost = (np.abs(case.recorded) < (1.0 - CLOSE) * np.abs(case.right))[:, there]
    if lost.sum() < _FEWEST:
        return ""
    bound = float(np.median(brought[lost]))
    good = (np.abs(brought[lost] - bound) <= CLOSE * abs(bound)).mean() >= SHARE and bound > 0.0
    return f"what a light sample brings is cut at {bound:.4g}, before the throughput" if good else ""
