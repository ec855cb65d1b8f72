"""Mistakes of a flat loop in NumPy that writes the log itself, with MIS and two lamps: changed lines of
programs/shed.py."""

import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

import tracer
from outside.mistake import Mistake
from outside.python import with_changes
from tracer.doctor import examine
from tracer.trace.jsonl import read_log

PROGRAMS = Path(__file__).parent / "programs"


def diagnosed(changes, precision="float64", digits=12):
    """What the doctor says of the program with some of its text changed, {old: new}."""
    text = with_changes((PROGRAMS / "shed.py").read_text(encoding="utf-8"), changes)
    with tempfile.TemporaryDirectory() as folder:
        source, log = Path(folder) / "own.py", Path(folder) / "own.jsonl"
        source.write_text(text, encoding="utf-8")
        words = [sys.executable, source, log, precision, str(digits)]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
        return examine(read_log(log, tracer.load(PROGRAMS / "shed.toml")).trace)


def _of(id, words, laws, changes, fair=(), **how):
    return Mistake(f"shed {id}", words, laws, partial(diagnosed, changes, **how), fair, "fourth")


_ROULETTE = """\
            if depth >= FREE:
                number = rng.random()
                beta = beta / KEEP if number < KEEP else beta
                log("roulette", depth=depth, probability=KEEP, u=number, survived=number < KEEP, beta=beta)
                if number >= KEEP:
                    reason = "roulette"
                    break
"""
_WEIGHT = "w = power_weight(pdf, pdf_bsdf) if"
_MET = "w = 1.0 if depth == 0 else power_weight(density, pdf_light)"
MISTAKES = (
    _of("right", "no mistake; 64 bits, 12 digits", (), {}),
    _of("right-32", "no mistake; 32 bits, 7 digits", (), {}, precision="float32", digits=7),
    _of(
        "right-nothing-0",
        "no mistake; the weight is logged as 0 where nothing can arrive from the lamp",
        (),
        {"if pdf > 0 else 0.0": "if pdf > 0 and cos > 0 else 0.0"},
    ),
    _of(
        "right-before",
        "no mistake; roulette is played and logged before the bounce, not after it",
        (),
        {
            _ROULETTE: "",
            "            # the next direction\n": _ROULETTE + "\n            # the next direction\n",
        },
    ),
    _of("right-late", "no mistake; roulette from the fourth vertex on", (), {"8, 0, 0.75": "8, 3, 0.75"}),
    _of(
        "weight-of-areas",
        "both weights compare a density per area with one per solid angle",
        ("light-weight", "emission-weight"),
        {
            _WEIGHT: "w = power_weight(PICKS[i] * pdf_area, pdf_bsdf) if",
            _MET: "w = 1.0 if depth == 0 else power_weight(density, PICKS[which] / lamp.area)",
        },
        ("M01",),
    ),
    _of(
        "axes-exchanged",
        "the second lamp's half-lengths are exchanged where points are chosen",
        ("light-point", "lamp-points"),
        {
            "q = lamp.middle + (2 * u[1] - 1) * lamp.across + (2 * u[2] - 1) * lamp.up": "turned = [(1, 1), "
            "(2 / 3, 1.5)][i]\n            q = lamp.middle + turned[0] * (2 * u[1] - 1) * lamp.across"
            " + turned[1] * (2 * u[2] - 1) * lamp.up"
        },
    ),
    _of(
        "albedo-before-light",
        "the throughput of the light sample has the albedo of this vertex already, which f brings again",
        ("light-throughput", "light-term"),
        {
            "term = beta * f * lamp.radiance * cos * w / pdf if": "term = "
            "beta * colour * f * lamp.radiance * cos * w / pdf if"
        },
    ),
    _of(
        "density-of-the-first",
        "the density of the first bounce is kept for all that follow",
        ("pdf-of-last-bounce", "emission-weight"),
        {
            "density = cos / REAL(math.pi)\n            before = beta\n"
            "            beta = beta * f * cos / density": (
                "density = cos / REAL(math.pi) if depth == 0 else density\n            before = beta\n"
                "            beta = beta * f * math.pi"
            ),
            "pdf=density, beta_before": "pdf=cos / REAL(math.pi), beta_before",
        },
        ("M01",),
    ),
    _of(
        "numbers-of-the-lamp",
        "the next direction is made of the numbers that chose the lamp's point",
        ("numbers-once", "numbers-independent"),
        {"v = rng.random(3)": "v = u"},
    ),
    _of(
        "lamps-by-halves",
        "each lamp is chosen half of the time, the probability is said to go by power",
        ("lamp-choice",),
        {"i = 0 if u[0] < PICKS[0] else 1": "i = int(2 * u[0])"},
    ),
    _of(
        "shadow-to-the-middle",
        "the shadow ray goes to the lamp's middle, the light comes from a point on it",
        ("light-visible",),
        {
            "visible = nearest(p, wi)[0] > r - BACK": "heart = lamp.middle - p\n"
            "                visible = nearest(p, unit(heart))[0] > np.sqrt(heart @ heart) - BACK"
        },
    ),
    _of(
        "normal-of-the-other",
        "the first lamp's normal for both",
        ("light-normal",),
        {"nq = lamp.n\n": "nq = LAMPS[0].n\n"},
    ),
)
