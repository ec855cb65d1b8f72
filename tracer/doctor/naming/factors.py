"""What the recorded number has too much or too little of, where no mistake of the catalogue predicts it.

The ratio of recorded to right numbers is held against products of few of the event's own numbers. Of many
events the ratio of each says which, so that one that fits them all is no chance.
"""

from itertools import combinations

import numpy as np

from tracer.doctor.naming import bounds
from tracer.doctor.naming.case import CLOSE, SHARE
from tracer.events import KINDS
from tracer.frame import dot

_FEWEST = 16  # events that a product has to fit
_FINE = 16.0  # machine epsilons by which a number may be off that is hardly wrong
_COLOURS = ("red", "green", "blue")
_POWERS = (1, -1, 2, -2)
_KNOWN = {"pi": np.pi, "2 pi": 2.0 * np.pi, "4 pi": 4.0 * np.pi, "pi^2": np.pi**2}
_OF = {
    "light": ("cos", "cos_light", "r", "pdf", "w", "P(lamp)", "n . wo", "q", "beta", "f", "Le"),
    "bounce": (
        "cos",
        "pdf",
        "n . wo",
        "q",
        "beta",
        "f",
        "cos of the light sample",
        "pdf of the light sample",
    ),
    "roulette": ("q",),
    "hit": ("w", "pdf_bsdf", "pdf_light", "n . wo", "beta", "Le"),
}


def words(case):
    """A sentence such as "recorded = right x cos_light / cos"; "" where no product fits."""
    if case.recorded is None or case.right is None or case.recorded.dtype.kind != "f":
        return ""
    ratio, there = _ratio(case)
    for close in (CLOSE, _FINE * case.evidence.eps):
        # What is hardly off agrees with any product that is near 1
        off = np.abs(ratio - 1.0) > 4.0 * close
        told = there & (off if off.ndim == 1 else off.any(axis=0))
        if np.count_nonzero(told) >= _FEWEST and (said := _told(case, ratio[..., told], told, close)):
            return said
    return ""


def _told(case, ratio, there, close):
    """The words for events whose numbers are off by more than close."""
    if (value := _constant(ratio, close)) is not None:
        return f"recorded = {_spelled(value)} x right"
    right = np.broadcast_to(case.right, case.recorded.shape)[..., there]
    if _fits(ratio / right, close):
        return "recorded = right^2"
    said = _product(ratio, _quantities(case, there, close), close) or bounds.words(case, ratio, there)
    if said or _of_space(case):
        return said
    said = _of_colours(case.recorded[..., there], right)
    return said and said + _only_on(case)


def _only_on(case):
    """The surface, if it is one of several, on which all of the events are."""
    if case.kind not in ("light", "bounce"):
        return ""
    scene = case.evidence.scene
    shape = np.unique(scene.shape_of.take(case.vertex("primitive")))
    return f"; only on {scene.shapes[shape[0]].name}" if shape.size == 1 < len(scene.shapes) else ""


def _of_space(case):
    """Whether the numbers are a point or a direction, whose components are no colours."""
    fields = (field for kind in KINDS if kind.name == case.kind for field in kind.fields)
    return case.outcome.what in {field.name for field in fields if field.domain in ("point", "unit vector")}


def _of_colours(recorded, right):
    """What tells the three channels apart; "" for other numbers."""
    if recorded.ndim != 2 or _alike(right[0], right):
        return ""
    if _alike(recorded[0], recorded):
        mean = _alike(right.mean(axis=0), recorded)
        return f"recorded is {'the mean of the colours' if mean else 'the same for all colours'}"
    for one, other in combinations(range(3), 2):
        order = np.arange(3)
        order[[one, other]] = other, one
        if all(_alike(a, b[None]) for a, b in zip(right[order], recorded, strict=True)):
            return f"{_COLOURS[one]} and {_COLOURS[other]} are exchanged"
    good = [_alike(a, b[None]) for a, b in zip(recorded, right, strict=True)]
    if any(good):
        names = [name for name, there in zip(_COLOURS, good, strict=True) if there]
        return f"{' and '.join(names)} {'are' if len(names) > 1 else 'is'} right, the rest not"
    return ""


def _alike(one, several):
    """Whether nearly all of (M, K) are the number (K,)."""
    return bool((np.abs(several - one) <= CLOSE * np.abs(one)).all(axis=0).mean() >= SHARE)


def _ratio(case):
    """Recorded over right (..., K), and at which events that says something."""
    recorded, right = np.broadcast_arrays(case.recorded, case.right)
    if recorded.ndim == 2:
        component = np.argmax(np.abs(np.where(np.isfinite(right), right, 0.0)), axis=0)
    ratio = recorded / right
    good = np.isfinite(ratio) & (ratio != 0.0)
    if ratio.ndim == 1:
        return ratio, good
    return ratio, good[component, np.arange(component.size)]


def _constant(ratio, close):
    """The number that nearly all ratios are, or None."""
    value = float(np.nanmedian(ratio))
    return value if np.isfinite(value) and value != 0.0 and _fits(ratio / value, close) else None


def _fits(ratio, close):
    """Whether nearly all events have ratio 1 in all components that say something."""
    good = ~(np.abs(ratio - 1.0) > close) | ~np.isfinite(ratio)
    said = np.isfinite(ratio)
    if ratio.ndim == 2:
        good, said = good.all(axis=0), said.any(axis=0)
    return bool((good & said).mean() >= SHARE)


def _spelled(value):
    for name, known in _KNOWN.items():
        if abs(value / known - 1.0) <= CLOSE:
            return name
        if abs(value * known - 1.0) <= CLOSE:
            return f"1/{name}" if " " not in name else f"1/({name})"
    return f"{value:.4g}"


def _product(ratio, quantities, close):
    """The words of the first product of one or two quantities, and a constant, that the ratios are."""
    powers = [(name, k, value**k) for name, value in quantities.items() for k in _POWERS]
    for number in (1, 2):
        for some in combinations(powers, number):
            if len({name for name, _, _ in some}) < number:
                continue
            rest = ratio / np.prod(np.broadcast_arrays(*(value for *_, value in some)), axis=0)
            value = _constant(rest, close)
            if value is not None and (abs(value - 1.0) <= CLOSE or _spelled(value).strip("1/()") in _KNOWN):
                return f"recorded = right{_written(some, value)}"
    return ""


def _written(some, value):
    parts = [] if abs(value - 1.0) <= CLOSE else [f" x {_spelled(value)}"]
    for name, power, _ in some:
        square = f"{name}^2" if abs(power) == 2 else name
        parts.append(f" {'x' if power > 0 else '/'} {square}")
    return "".join(sorted(parts, key=lambda part: part[1] == "/"))


def _quantities(case, there, close):
    """Name -> values (..., K) at the events `there`, of those that were recorded and vary."""
    found = {}
    for name in _OF.get(case.kind, ()):
        try:
            value = np.asarray(_of_event(case, name), float)[..., there]
        except (KeyError, ValueError):
            continue
        if np.array_equal(value, case.recorded[..., there], equal_nan=True):
            continue  # the judged number itself says nothing about itself
        some = value[np.isfinite(value) & (value != 0.0)]
        if some.size and np.ptp(some) > 10.0 * close * np.abs(some).max():
            found[name] = value
    return found


def _of_event(case, name):
    """One number of each event; KeyError where it was not recorded."""
    if name == "cos_light":
        return -dot(case["nq"], case["wi"])
    if name == "r":
        return case["distance"]
    if name == "P(lamp)":
        return case["pick"]
    if name == "n . wo":
        n, wo = (case["n"], case["wo"]) if case.kind == "hit" else (case.vertex("n"), case.vertex("wo"))
        return np.abs(dot(n, wo))
    if name == "q":
        return case["probability"]
    if name == "beta" and case.kind == "bounce":
        return case["beta_before"]
    if name.endswith(" of the light sample"):
        row = case.evidence.before(case.kind, "light")[case.rows]
        column = case.evidence(f"light.{name.partition(' ')[0]}")
        return np.where(row < 0, np.nan, column.take(np.maximum(row, 0)))
    return case[name]
