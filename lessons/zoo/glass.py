"""What is lost inside coloured glass."""

import numpy as np

from lessons.zoo.bug import Bug

BEER_LAMBERT = "I8: throughput grows by f cos / (pdf q) at every bounce, and by exp(-sigma_t t) on the way"


def all_of_it(scene, medium, distance):
    """Nothing is lost, however long the way."""
    return np.ones((3, distance.size), distance.dtype)


BUGS = (
    Bug(
        "A01",
        "Absorption forgotten",
        "Coloured glass is as clear as any other.",
        "beta *= f * cos / pdf; without beta *= exp(-sigma_t * t) on the way to the next surface",
        BEER_LAMBERT,
        {"transmittance": all_of_it},
        scene="coloured_glass",
        integrator="path",
    ),
)
