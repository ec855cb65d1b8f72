"""Whole pictures: rooms whose radiance is known, two loops against one another, error bars."""

import numpy as np
from cases import loaded

import tracer
from figures.figure import Figure
from tracer import Settings, tails
from tracer.testing import calibration, z_test

TITLE = "Pictures"
SIDE = 32  # pixels of the pictures here
FULL_DEPTH = 8
TRUTH = 2.0 * (1.0 - 0.5**FULL_DEPTH)  # of the furnace, see test_furnace
NOISY = "pbrt: means within 2.5 %; we know of no global test"


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


def figures():
    """Furnaces without and with noise, calibration, and the loops' agreement."""
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
    bars = "share of 95 % error bars that hold the truth, furnace with roulette"
    between = "bias Z of path against walk, cornell_unit"
    for key, what, bar, anchors, n, measure, judge in (
        ("furnace-bias", "bias Z of a furnace, roulette", "< 4", NOISY, 64 * paths, _noisy_furnace, _judge_Z),
        ("calibration", bars, "94.5 to 95.5 %", "we know of none", paths, _intervals, _judge_intervals),
        ("path-walk", between, "< 4", NOISY, 160 * paths, _path_against_walk, _judge_Z),
    ):
        yield Figure(key, what, bar, anchors, "float32", 100, n, measure, judge)
