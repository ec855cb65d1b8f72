"""The three mistakes of the abandoned castRay, alone and on top of each other, as the homework measured them.

A row is traced with the random numbers of what it is compared with, so that most of the noise cancels.
"""

from functools import partial

import numpy as np
from cases import loaded
from checks import SIGMAS, region, samples

from figures.figure import Figure
from lessons import zoo
from lessons.zoo.bug import CENTRES
from tracer import Settings
from tracer.light.sample import luminance

TITLE = "The abandoned castRay"
REGIONS = ("left wall", "right wall", "ceiling", "floor", "back wall")
SIDE, SPP = 196, 8
# Luminance over that of the correct picture, region by region, in the homework's own framework (C++).
MEASURED = {
    "D01": (0.49, 0.49, 0.50, 0.37, 0.49),
    "D06": (2.60, 1.68, 1.23, 1.04, 1.05),
    "D01,D06": (1.30, 0.85, 0.62, 0.39, 0.51),
}
ROWS = ("E01", *MEASURED, "E01,D01", "E01,D06", "E01,D01,D06")
EXACT, ROUNDED = 0.05, 0.15  # allowed without D01, and with it: there float arithmetic decides


def notes():
    """What the table shows."""
    return """
Each line plants some of the zoo's bugs in the homework's box (196 x 196, uniform hemisphere, roulette 0.8,
samples through the pixels' centres) and gives the luminance of left wall, right wall, ceiling, floor and back
wall over that of the right tracer with the same random numbers. E01 adds the correct picture once more,
whatever else is wrong: z is how far, in standard errors, a region is from the same without E01 plus 1.
"""


def _settings(seed):
    return Settings(width=SIDE, height=SIDE, spp=SPP, seed=seed, integrator="direct", **CENTRES)


def measure(seed, bugs):
    """Sums of samples in each region: of the right tracer, of the wrong one, and of what E01 adds beyond the
    correct picture, with its squares."""
    others = ",".join(bug for bug in bugs.split(",") if bug != "E01")
    found = {}
    for name in REGIONS:
        light = partial(_luminance, name, _settings(seed))
        right, wrong = light(""), light(bugs)
        found[f"right {name}"], found[f"wrong {name}"] = float(right.sum()), float(wrong.sum())
        found[f"samples {name}"] = right.size
        if others != bugs:
            beyond = wrong - (light(others) if others else right) - right
            found[f"beyond {name}"], found[f"square {name}"] = float(beyond.sum()), float(beyond @ beyond)
    return found


def _luminance(name, settings, bugs):
    """Luminance of every sample in a region, (N,)."""
    pixels = region(name, SIDE, SIDE)
    steps = zoo.steps(bugs) if bugs else zoo.RIGHT
    return luminance(samples(loaded("cornell"), settings, steps, pixels).reshape(3, -1))


def judge(sums, chunks, bugs):
    """The ratios, and how far the worst is off."""
    ratios = [sums[f"wrong {name}"] / sums[f"right {name}"] for name in REGIONS]
    text = " / ".join(f"{ratio:.2f}" for ratio in ratios)
    if bugs in MEASURED:
        off = max(abs(ratio / told - 1.0) for ratio, told in zip(ratios, MEASURED[bugs], strict=True))
        return f"{text}; {100 * off:.1f} % off at most", off < _allowed(bugs)
    z = max(_z(*(sums[f"{what} {name}"] for what in ("samples", "beyond", "square"))) for name in REGIONS)
    return f"{text}; z = {z:.2f} at most", z < SIGMAS


def _z(n, total, squares):
    """How many standard errors a mean is from 0."""
    mean = total / n
    return abs(mean) / np.sqrt((squares / n - mean * mean) / n)


def _allowed(bugs):
    return ROUNDED if "D01" in bugs else EXACT


def figures():
    """One for each combination of the three, but none of them."""
    n = SPP * sum(region(name, SIDE, SIDE).size for name in REGIONS)
    for bugs in ROWS:
        bar = f"homework's within {100 * _allowed(bugs):g} %" if bugs in MEASURED else f"z below {SIGMAS:g}"
        yield Figure(
            f"abandoned-{bugs.replace(',', '-')}",
            f"{bugs}: luminance over the right one's, five regions",
            bar,
            "homework: " + " / ".join(f"{told:g}" for told in MEASURED[bugs]) if bugs in MEASURED else "-",
            "float32",
            80,
            n,
            partial(measure, bugs=bugs),
            partial(judge, bugs=bugs),
        )
