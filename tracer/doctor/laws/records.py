"""Every number by itself: finite, within its domain, and vectors of length 1."""

import numpy as np

from tracer.doctor.rule import Outcome, Rule, fields_of
from tracer.events import KINDS
from tracer.frame import length

_INFINITE = ("hit.pdf_bsdf", "hit.pdf_light", "light.distance")  # after a mirror, edge on, for ever away
_FIELDS = [(kind.name, f) for kind in KINDS for f in kind.fields if f.carried]


def finite(evidence):
    """I10: the events with a number that is none."""
    return _first(evidence, ((kind, f, _not_finite(evidence, kind, f)) for kind, f in _present(evidence)))


def _not_finite(evidence, kind, field):
    column = evidence(f"{kind}.{field.name}")
    if column.dtype.kind in "biu":
        return np.zeros(column.shape[-1], bool)
    name = f"{kind}.{field.name}"
    certain = name in _INFINITE or name in evidence.trace.assumed  # worked out edge on
    bad = np.isnan(column) if certain else ~np.isfinite(column)
    return bad.reshape(-1, column.shape[-1]).any(axis=0)


def without_number(evidence):
    """Which paths (P,) have a number that is none, or a sum that the trace's precision cannot hold."""
    found = np.zeros(evidence.trace.size, bool)
    brought = np.zeros(evidence.trace.size)
    for kind, f in _present(evidence):
        path = evidence.trace.tables[kind].path
        found[path[_not_finite(evidence, kind, f)]] = True
        if f.name == "contribution":
            size = np.abs(evidence(f"{kind}.contribution")).max(axis=0)
            brought += np.bincount(path, size, evidence.trace.size)
    largest = np.finfo(np.float32 if evidence.settings.precision == 32 else np.float64).max
    return found | ~(brought < 0.1 * largest)


def within_domain(evidence):
    """I10: the events with a number outside of its domain."""
    return _first(evidence, ((kind, f, _outside(evidence, kind, f)) for kind, f in _present(evidence)))


def _outside(evidence, kind, field):
    column = evidence(f"{kind}.{field.name}")
    room = 64.0 * evidence.eps
    low, high = {
        "non-negative": (0.0, np.inf),
        "density": (0.0, np.inf),
        "positive": (0.0, np.inf),
        "distance": (0.0, np.inf),
        "probability": (0.0, 1.0 + room),
        "cosine": (-1.0 - room, 1.0 + room),
        "index": (-1, evidence.scene.shape_of.size - 1),
        "light": (0, len(evidence.scene.light_names) - 1),
        "choice": (0, len(field.choices) - 1),
    }.get(field.domain, (-np.inf, np.inf))
    return ((column < low) | (column > high)).reshape(-1, column.shape[-1]).any(axis=0)


def _present(evidence):
    return [(kind, f) for kind, f in _FIELDS if evidence.has(f"{kind}.{f.name}") and evidence.count(kind)]


def _first(evidence, found):
    """An Outcome over all columns; the events shown are those of the column that fails first in a path."""
    checked, failed, shown = 0, 0, None
    fields = {}
    for kind, field, bad in found:
        checked += bad.size
        if bad.any():
            failed += int(np.count_nonzero(bad))
            place = f"{kind}.{field.name}"
            fields[place] = int(np.count_nonzero(bad))
            table = evidence.trace.tables[kind]
            rows = np.flatnonzero(bad)
            step = int(table.step[rows].min())
            if shown is None or step < shown[0]:
                shown = step, kind, field, rows
    if shown is None:
        none = np.zeros(checked, bool)
        return Outcome("camera", np.zeros(checked, np.intp), none, none)
    _, kind, field, rows = shown
    column = evidence(f"{kind}.{field.name}")
    wrong = np.zeros(checked, bool)
    wrong[: rows.size] = True
    order = np.concatenate((rows, np.zeros(checked - rows.size, np.intp)))
    recorded = np.full((*column.shape[:-1], checked), np.nan)
    recorded[..., : rows.size] = column[..., rows]
    return Outcome(
        kind,
        order,
        wrong,
        np.zeros(checked, bool),
        recorded,
        None,
        field.name,
        note="; ".join(f"{place}: {count}" for place, count in fields.items()),
        facts={"fields": fields, "domain": field.domain},
    )


def unit(*places):
    """I11 for some columns of vectors."""

    def judge(evidence):
        there = [place for place in places if evidence.has(place) and evidence.count(place.split(".")[0])]
        worst = [place for place in there if not evidence.is_unit(place).all()]
        place = worst[0] if worst else there[0]
        kind, name = place.split(".")
        size = length(evidence(place))
        rows = np.arange(size.size)
        bad = ~evidence.is_unit(place)
        return Outcome(
            kind, rows, bad, np.zeros_like(bad), size, np.ones_like(size), f"|{name}|", facts={"field": name}
        )

    return judge


_UNIT = fields_of("unit vector")
RULES = (
    Rule(
        "finite",
        "Numbers are finite",
        "Every recorded number is a number: no NaN, and infinite only where a density stands for certainty.",
        "x = x, |x| < inf",
        ("camera.d",),
        finite,
    ),
    Rule(
        "unit-normal",
        "Normals have length 1",
        "A normal is a direction; products with it are cosines only if its length is 1.",
        "|n| = 1",
        ("hit.n",),
        unit("hit.n", "hit.ng"),
    ),
    Rule(
        "unit-light",
        "Directions to lights have length 1",
        "The direction to a point on a light is that way divided by its length.",
        "|wi| = 1",
        ("light.wi",),
        unit("light.wi"),
    ),
    Rule(
        "unit-direction",
        "Directions have length 1",
        "Directions of rays have length 1; products with them are cosines, and t is a distance, only then.",
        "|w| = 1",
        ("camera.d",),
        unit("camera.d", "hit.wo", "bounce.wi", "escape.d"),
    ),
    Rule(
        "domain",
        "Numbers lie in their domains",
        "Radiance, throughput and densities are not negative; probabilities and weights lie between 0 and 1.",
        "x >= 0; 0 <= P <= 1",
        ("camera.d",),
        within_domain,
    ),
)
