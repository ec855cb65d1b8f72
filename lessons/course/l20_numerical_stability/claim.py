"""Digits that are lost by subtracting, by adding, and by dividing: measured beside ways that keep them."""

import numpy as np

from tracer import film
from tracer.shape.rays import Rays
from tracer.shape.sphere import Sphere

FAR, AIMS = 1e4, 500  # radii to the ball, and rays sent to it
SAMPLES, VALUE = 200_000, 0.1
SMALL = 1e-4  # an angle in radians


def experiment(run):
    """Lengths in radii or metres; relative errors as numbers."""
    naive, kept = ball_far_away()
    assert kept < 1e-6 * FAR and naive > 0.1
    single, double = sums()
    assert double < 1e-12 and single > 1e-3
    one = np.float32(2.0**24)
    assert one + np.float32(1.0) == one > one - np.float32(1.0)

    angle = np.float32(SMALL)
    bad, good = np.float32(1.0) - np.cos(angle), 2.0 * np.sin(angle / 2.0) ** 2
    assert abs(good / (SMALL**2 / 2.0) - 1.0) < 1e-3 and bad != good
    acne, behind = run.event("acne"), run.event("behind")
    assert acne["t"] < 1e-5 and behind["t"] < 0.0
    return {
        "far": FAR,
        "naive": naive,
        "kept": kept,
        "samples": SAMPLES,
        "value": VALUE,
        "single": 100.0 * single,
        "double": double,
        "stop": float(one),
        "half": 2.0**23,
        "whole": 2.0**32,
        "seven": 1e7,
        "small": SMALL,
        "bad": float(bad),
        "good": float(good),
        "town": float(np.spacing(np.float32(1e7))),
        "stuck": acne["t"],
    }


def ball_far_away():
    """The largest error in radii of the distance to a ball of radius 1: by the schoolbook's formula, and by
    the tracer's."""
    rng = np.random.default_rng(5)
    o = np.array([[0.0], [0.0], [FAR]]).repeat(AIMS, axis=1).astype(np.float32)
    d = rng.uniform(-0.5, 0.5, (3, AIMS)) - o
    d = (d / np.linalg.norm(d, axis=0)).astype(np.float32)
    b, size = (o * d).sum(axis=0), (d * d).sum(axis=0)
    with np.errstate(invalid="ignore"):
        schoolbook = (-b - np.sqrt(b * b - size * ((o * o).sum(axis=0) - np.float32(1.0)))) / size
    ours, _ = (
        Sphere("ball", np.zeros(3), 1.0)
        .kernel(0, 1.0, np.float32)
        .closest(Rays.towards(o, d, np.full(AIMS, -1)))
    )
    o, d = o.astype(np.longdouble), d.astype(np.longdouble)
    b, size = (o * d).sum(axis=0), (d * d).sum(axis=0)
    truth = (-b - np.sqrt(b * b - size * ((o * o).sum(axis=0) - 1))) / size
    return tuple(float(np.nanmax(np.abs(t - truth))) for t in (schoolbook, ours))


def sums():
    """Relative errors of the mean of many equal samples: added one by one in float32, and by the film."""
    naive = np.cumsum(np.full(SAMPLES, VALUE, np.float32), dtype=np.float32)[-1]
    part = film.block(np.full((3, 1, film.BLOCK), np.float32(VALUE)))
    total = np.zeros((3, 1))
    for _ in range(SAMPLES // film.BLOCK):
        total = total + part.total
    exact = SAMPLES * float(np.float32(VALUE))
    return abs(float(naive) / exact - 1.0), float(np.abs(total / exact - 1.0).max())
