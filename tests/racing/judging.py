"""Ratios with intervals, and the tables of the race."""

import math
import statistics
from typing import NamedTuple

import numpy as np
from benchmarks.scaling import fixed_and_each
from benchmarks.section import short, table
from scipy import stats

MEASURES = {"mse": "time x MSE", "rel_mse": "time x relMSE"}
# Ratios that castray asks of itself: (measure, program, spp) -> text.
ASKED = {
    ("paths", "scalar_rgb", None): "at least 1.8",
    ("mse", "llvm_ad_rgb", 16): "at most 2",
    ("mse", "llvm_ad_rgb", 64): "at most 1",
    ("mse", "llvm_ad_rgb", 256): "at most 1",
}


class Entry(NamedTuple):
    """One way of one program to render."""

    program: str  # castray, scalar_rgb or llvm_ad_rgb
    sampler: str
    adaptive: str = "off"  # castray's
    lamps: str = "area"  # castray's light_sampling

    @property
    def way(self):
        """How the program renders, in words."""
        more = [f"adaptive {self.adaptive}"] * self.is_adaptive
        more += ["solid angle"] * (self.lamps == "solid_angle")
        return ", ".join((self.sampler, *more))

    @property
    def name(self):
        return f"{self.program}, {self.way}"

    @property
    def is_adaptive(self):
        return self.adaptive != "off"


class Row(NamedTuple):
    """One picture of the race."""

    entry: Entry
    spp: int
    seed: int
    seconds: float
    kernel: float
    paths: int
    mse: float
    rel_mse: float


class Interval(NamedTuple):
    """A geometric mean and its 95 % interval."""

    middle: float
    low: float
    high: float

    def __str__(self):
        return f"{self.middle:.3g} [{self.low:.3g}, {self.high:.3g}]"


def geometric(values, level=0.95):
    """Geometric mean of positive values with Student's interval on their logarithms; NaN where one is not
    positive, or of fewer than two the interval."""
    values = np.asarray(values, float)
    if not (values > 0.0).all():
        return Interval(math.nan, math.nan, math.nan)
    logs = np.log(values)
    if logs.size < 2:
        return Interval(float(values.mean()), math.nan, math.nan)
    half = stats.t.ppf(0.5 + 0.5 * level, logs.size - 1) * logs.std(ddof=1) / math.sqrt(logs.size)
    return Interval(*(float(np.exp(logs.mean() + k * half)) for k in (0, -1, 1)))


def ratio(ours, theirs):
    """Interval of the ratio of two dicts {seed: value}, seed by seed."""
    return geometric([ours[k] / theirs[k] for k in sorted(ours.keys() & theirs.keys())])


class Race:
    """The Rows of a race, and what follows from them."""

    def __init__(self, rows):
        self.rows = rows
        programs = list(dict.fromkeys(row.entry.program for row in rows))
        self.entries = sorted(
            dict.fromkeys(row.entry for row in rows), key=lambda one: programs.index(one.program)
        )
        self.spps = sorted({row.spp for row in rows})

    def of(self, entry, spp):
        """The rows of one entry at one number of samples."""
        return [row for row in self.rows if row.entry == entry and row.spp == spp]

    def costs(self, entry, spp, measure):
        """{seed: time x error}, or for "paths" {seed: paths per second}."""
        if measure == "paths":
            return {row.seed: row.paths / row.seconds for row in self.of(entry, spp)}
        return {row.seed: row.seconds * getattr(row, measure) for row in self.of(entry, spp)}

    def best(self, entries, spp, measure):
        """The entry that costs least, or traces most paths; None if there is none."""
        found = {
            one: geometric(list(self.costs(one, spp, measure).values()))
            for one in entries
            if self.of(one, spp)
        }
        found = {one: value.middle for one, value in found.items() if value.middle > 0.0}
        choose = max if measure == "paths" else min
        return choose(found, key=found.__getitem__, default=None)

    def tables(self, least_spp=2):
        """Everything in Markdown."""
        return "\n\n".join(
            (
                "### Ratios, castray over Mitsuba",
                table(list(self._ratios(least_spp))),
                "### Speed",
                table(list(self._speeds())),
                "### Cost of an error",
                table([row for spp in self.spps if spp >= least_spp for row in self._errors(spp)]),
            )
        )

    def _ratios(self, least_spp):
        """A row for every figure, number of samples and opponent, with castray's samples spread and sent."""
        ours = [one for one in self.entries if one.program == "castray"]
        for program in dict.fromkeys(one.program for one in self.entries if one.program != "castray"):
            theirs = [one for one in self.entries if one.program == program]
            yield self._ratio("paths", self.spps[-1], [o for o in ours if not o.is_adaptive], theirs)
            for measure in MEASURES:
                for spp in self.spps:
                    for adaptive in (False, True):
                        some = [one for one in ours if one.is_adaptive == adaptive and self.of(one, spp)]
                        if spp >= least_spp and some:
                            yield self._ratio(measure, spp, some, theirs)

    def _ratio(self, measure, spp, ours, theirs):
        one, other = self.best(ours, spp, measure), self.best(theirs, spp, measure)
        said = "cannot be told: below the reference's own error"
        if one and other:
            said = str(ratio(self.costs(one, spp, measure), self.costs(other, spp, measure)))
        program = theirs[0].program
        asked = ASKED.get((measure, program, None if measure == "paths" else spp), "")
        return {
            "figure": MEASURES.get(measure, "paths/s"),
            "spp": spp,
            "castray": one.way if one else "",
            "against": f"{program}, {other.sampler}" if other else program,
            "ratio": said,
            "asked": asked,
        }

    def _speeds(self):
        """Paths per second at most samples, and the fixed part of the time."""
        for entry in self.entries:
            times = {
                spp: statistics.median(r.seconds for r in self.of(entry, spp))
                for spp in self.spps
                if self.of(entry, spp)
            }
            rows = self.of(entry, max(times))
            fixed = (
                f"{1e3 * fixed_and_each(list(times), list(times.values()))[0]:.1f}" if len(times) > 2 else ""
            )
            yield {
                "program": entry.name,
                "spp": max(times),
                "seconds": short(times[max(times)]),
                "kernel ms": f"{1e3 * statistics.median(r.kernel for r in rows):.2f}",
                "paths/s": short(statistics.median(r.paths / r.seconds for r in rows)),
                "fixed, ms": fixed,
            }

    def _errors(self, spp):
        for entry in self.entries:
            rows = self.of(entry, spp)
            if rows:
                yield {
                    "program": entry.name,
                    "spp": spp,
                    "seconds": short(statistics.median(r.seconds for r in rows)),
                    "kernel ms": f"{1e3 * statistics.median(r.kernel for r in rows):.2f}",
                    "MSE": f"{statistics.mean(r.mse for r in rows):.3g}",
                    "relMSE": f"{statistics.mean(r.rel_mse for r in rows):.3g}",
                } | {name: _cost(self.costs(entry, spp, measure)) for measure, name in MEASURES.items()}


def _cost(costs):
    middle = geometric(list(costs.values())).middle
    return "" if math.isnan(middle) else f"{middle:.3g}"
