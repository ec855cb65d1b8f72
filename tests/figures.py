"""The figures of ACCURACY.md: each is many independent chunks, and what they add up to."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from cases import loaded
from escapes import AIMS, PLACES, escapes

import tracer
from tracer import Settings, tails
from tracer.engine import waves
from tracer.testing import calibration, z_test

SIDE = 32  # pixels of the pictures here
FULL_DEPTH = 8
FINE = 5  # subdivisions of the mesh: 20480 triangles
BARS = "share of 95 % error bars that hold the truth, furnace with roulette"
PATHS = "bias Z of path against walk, cornell_unit"
WAVES = "pixels that change with the size of waves"
TRUTH = 2.0 * (1.0 - 0.5**FULL_DEPTH)  # of the furnace, see test_furnace


@dataclass(frozen=True)
class Figure:
    """One line of ACCURACY.md.

    measure(chunk's seed) gives a dict of numbers; those of all chunks are added up, or the largest taken if
    the name starts with "most". judge(sums, chunks) gives (what is printed, whether it is good enough).
    """

    key: str
    what: str
    bar: str  # what castray asks of itself
    anchors: str  # what trusted renderers ask of themselves
    precision: str
    chunks: int
    n: int  # rays, paths or intervals in a chunk
    measure: Callable
    judge: Callable


def _escapes(aim, place, dtype, n):
    return lambda seed: {"escaped": escapes(place, aim, dtype, n, seed, fine=FINE)}


def _none_escaped(n):
    def judge(sums, chunks):
        bound = 3.0e8 / (n * chunks)  # 95 % confidence where none was seen
        seen = sums["escaped"] / (n * chunks) * 1e8
        return (f"{seen:.3g}" if seen else f"0 (< {bound:.3g})") + " per 1e8", sums["escaped"] == 0

    return judge


def escape_figures():
    """Rays aimed at random, at edges and at vertices of a closed mesh, at the origin and far from it."""
    n = 50_000
    bars = {
        "anywhere": "Embree allows 2000 per 1e8; Vulkan 0",
        "edges": "Vulkan 0; Embree never aims there",
        "corners": "Vulkan 0; Embree never aims there",
    }
    for place, where in zip(PLACES, ("origin", "far"), strict=True):
        for aim in AIMS:
            for dtype in (np.float32, np.float64):
                bits = np.dtype(dtype).itemsize * 8
                yield Figure(
                    f"escapes-{aim}-{where}-{bits}",
                    f"escapes of rays aimed at {aim}, {where}, 20480 triangles",
                    "0",
                    bars[aim],
                    f"float{bits}",
                    200,
                    n,
                    _escapes(aim, place, dtype, n),
                    _none_escaped(n),
                )


def _furnace(seed, precision=32, spp=64, **options):
    settings = Settings(
        width=SIDE, height=SIDE, spp=spp, seed=seed, max_depth=FULL_DEPTH, precision=precision, **options
    )
    return tracer.render(loaded("furnace"), settings)


def _still_furnace(precision):
    def measure(seed):
        rgb = _furnace(seed, precision, 2, integrator="walk", roulette="off").rgb
        return {"most_off": float(np.abs(rgb / TRUTH - 1.0).max())}

    return measure


def _noisy_furnace(seed):
    room = _furnace(seed, integrator="walk", roulette="0.8")
    return {"Z": float(z_test(room, TRUTH).Z[0]), "dropped": room.dropped}


def _intervals(seed):
    room = _furnace(seed, spp=256, integrator="walk", roulette="0.8")
    found = calibration(room, np.array([TRUTH, np.nan, np.nan]))  # grey: its channels are one
    return {"inside": found.inside, "intervals": found.intervals}


def _judge_intervals(sums, chunks):
    share = sums["inside"] / sums["intervals"]
    half = tails.normal_z(1e-3) * np.sqrt(0.95 * 0.05 / sums["intervals"])
    return f"{100 * share:.2f} %", abs(share - 0.95) <= max(half, 0.005)


def _judge_Z(sums, chunks):
    Z = sums["Z"] / np.sqrt(chunks)
    return f"Z = {Z:+.2f}", abs(Z) < 4.0 and sums.get("dropped", 0) == 0


def _path_against_walk(seed):
    scene = loaded("cornell_unit")
    pictures = [
        tracer.render(scene, Settings(width=SIDE, height=SIDE, spp=spp, seed=seed + k, integrator=name))
        for k, (name, spp) in enumerate((("path", 32), ("walk", 128)))
    ]
    return {"Z": float(z_test(*pictures).Z[0]), "dropped": sum(p.dropped for p in pictures)}


def _reproduced(seed):
    """Pictures with waves of other sizes; the pixels that differ in any bit."""
    scene, settings = loaded("cornell_unit"), Settings(width=SIDE, height=SIDE, spp=18, seed=seed)
    usual, usual_tasks = tracer.render(scene, settings).rgb, waves.tasks
    differ = 0
    try:
        for lanes in (700, 5000):
            waves.tasks = lambda settings, lanes=lanes: usual_tasks(settings, lanes)
            other = tracer.render(scene, settings).rgb
            differ += int((other.view(np.uint32) != usual.view(np.uint32)).any(axis=2).sum())
    finally:
        waves.tasks = usual_tasks
    return {"differ": differ}


def _judge_waves(sums, chunks):
    return str(sums["differ"]), sums["differ"] == 0


def figures():
    """Every figure that is measured."""
    yield from escape_figures()
    paths = SIDE * SIDE
    for precision, bar in ((32, 1e-5), (64, 1e-7)):  # pixels are rounded to float32 in both
        yield Figure(
            f"furnace-exact-{precision}",
            "largest relative error of a furnace without noise, depth 8",
            f"{bar:g}",
            "pbrt 2.5e-2",
            f"float{precision}",
            50,
            2 * paths,
            _still_furnace(precision),
            lambda sums, chunks, bar=bar: (f"{sums['most_off']:.2g}", sums["most_off"] <= bar),
        )
    noisy = "pbrt: means within 2.5 %; we know of no global test"
    for key, what, bar, anchors, n, measure, judge in (
        ("furnace-bias", "bias Z of a furnace, roulette", "< 4", noisy, 64 * paths, _noisy_furnace, _judge_Z),
        (
            "calibration",
            BARS,
            "94.5 to 95.5 %",
            "we know of none published",
            paths,
            _intervals,
            _judge_intervals,
        ),
        ("path-walk", PATHS, "< 4", noisy, 160 * paths, _path_against_walk, _judge_Z),
        ("waves", WAVES, "0", "Falcor: tolerance 0.0", paths, _reproduced, _judge_waves),
    ):
        yield Figure(key, what, bar, anchors, "float32", 100, n, measure, judge)
