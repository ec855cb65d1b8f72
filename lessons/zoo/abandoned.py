"""A whole castRay that was given up: three mistakes that hide each other, and smaller ones beside them."""

import numpy as np

from lessons.zoo.bounce import without_guard
from lessons.zoo.bug import CENTRES, Bug
from lessons.zoo.emission import COUNT_ONCE, always
from lessons.zoo.film import centres
from lessons.zoo.light import (
    HOMEWORK_LAMP,
    VISIBILITY,
    behind_too,
    lamp_cosine_signed,
    rooted,
    without_tolerance,
)
from tracer import warp


def lamp_material_of_one_direction(scene, hit, wo, wi):
    """The lamp's albedo over pi; only the direction to the lamp is asked whether it is above the surface."""
    grey = wi.dtype.type(HOMEWORK_LAMP * warp.INV_PI)
    return np.where(wi[2] > 0.0, grey, wi.dtype.type(0.0)) * np.ones_like(wi)


def lamp_with_two_sides(scene, hit, u):
    """Points chosen by a root, on a lamp that counts for receivers behind it."""
    return behind_too(scene, hit, rooted(u))


BUGS = (
    Bug(
        "castray",
        "The abandoned castRay, whole",
        "Walls are pink and greenish grey and up to twice too bright, with stripes, and all is full of salt.",
        "emission at every depth (E01), a shadow test without tolerance of a float against a double (D01), "
        "the lamp's material for the light sample (D06), and D08, D15, B14, B15 beside them",
        f"{COUNT_ONCE}; {VISIBILITY[:2]}, I2, I10 and I16 as well",
        {
            "random": centres,
            "emission_weight": always,
            "light_point": lamp_with_two_sides,
            "eval": lamp_material_of_one_direction,
            "visibility": without_tolerance,
            "light_term": lamp_cosine_signed,
            "carries": without_guard,
        },
        settings=CENTRES,
        note="Emulated: vectors in float32 with the shadow distance in float64, pixel centres, uniform "
        "hemisphere, roulette 0.8 (give --roulette 0.2 for its last run). Not emulated: the engine built for "
        "each number (P01) and the build without optimisation (P07), which only cost time; triangles that "
        "cannot be seen from behind; a density of 0 (B15), which our diffuse directions never have.",
    ),
)
