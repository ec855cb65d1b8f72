"""A few examples of every material."""

import numpy as np

from tracer.bsdf import (
    Conductor,
    Dielectric,
    Diffuse,
    Plastic,
    RoughConductor,
    RoughDielectric,
    RoughPlastic,
    ThinDielectric,
    TwoSided,
)


def column(*values):
    return np.array(values, np.float64).reshape(3, 1)


def rough(alpha_u, alpha_v):
    return np.array([alpha_u]), np.array([alpha_v])


GOLD = column(0.2, 0.92, 1.1), column(3.9, 2.45, 2.14)
EXAMPLES = {
    Diffuse: [
        Diffuse(column(0.9, 0.5, 0.1)),
        Diffuse(column(0.9, 0.5, 0.1), hemisphere="uniform"),
    ],
    Conductor: [
        Conductor(column(0.2, 0.92, 1.1), column(3.9, 2.45, 2.14), column(1, 1, 1)),
        Conductor(column(1, 1, 1), column(np.inf, np.inf, np.inf), column(1, 0.8, 0.5)),
    ],
    Dielectric: [
        Dielectric(np.array([1.5]), column(1, 1, 1), column(1, 1, 1)),
        Dielectric(np.array([1 / 1.33]), column(1, 0.9, 0.8), column(0.7, 1, 1)),
        Dielectric(np.array([1.0]), column(1, 1, 1), column(1, 1, 1)),
        Dielectric(np.array([1.5]), column(1, 1, 1), column(1, 1, 1), "schlick"),
    ],
    RoughConductor: [
        RoughConductor(*rough(0.3, 0.3), *GOLD, column(1, 1, 1)),
        RoughConductor(*rough(0.4, 0.15), *GOLD, column(1, 1, 1), "beckmann"),
        RoughConductor(*rough(0.2, 0.7), *GOLD, column(1, 0.8, 0.5), "ggx", "schlick"),
    ],
    RoughDielectric: [
        RoughDielectric(*rough(0.5, 0.5), np.array([1.5]), column(1, 1, 1), column(1, 1, 1)),
        RoughDielectric(
            *rough(0.3, 0.6), np.array([1.33]), column(1, 0.9, 0.8), column(0.7, 1, 1), "beckmann"
        ),
        RoughDielectric(
            *rough(0.4, 0.4), np.array([1 / 1.5]), column(1, 1, 1), column(1, 1, 1), "ggx", "schlick"
        ),
    ],
    ThinDielectric: [ThinDielectric(np.array([1.5]), column(1, 0.9, 0.8), column(0.7, 1, 1))],
    Plastic: [
        Plastic.coated(np.array([1.5]), column(0.9, 0.5, 0.1), column(1, 1, 1)),
        Plastic.coated(np.array([1.9]), column(1, 1, 1), column(1, 0.8, 0.5), True, "schlick"),
        Plastic.coated(np.array([1 / 1.3]), column(0.9, 0.5, 0.1), column(1, 1, 1)),
    ],
    RoughPlastic: [
        RoughPlastic.coated(np.array([0.3]), np.array([1.5]), column(1, 0.5, 0.1), column(1, 1, 1)),
        RoughPlastic.coated(
            np.array([0.5]), np.array([1.9]), column(1, 1, 1), column(1, 0.8, 0), True, "beckmann"
        ),
    ],
}
EXAMPLES[TwoSided] = [
    TwoSided(EXAMPLES[Diffuse][0]),
    TwoSided(EXAMPLES[Conductor][0]),
    TwoSided(EXAMPLES[RoughConductor][1]),
    TwoSided(EXAMPLES[Plastic][0]),
]
EVERY = [material for family in EXAMPLES.values() for material in family]
SMOOTH = [material for material in EVERY if not material.delta]  # with lobes that are not Dirac ones
DIRAC = [material for material in EVERY if material.delta]


def names(materials):
    """A name for each."""
    return [f"{type(m).__name__}{k}" for k, m in enumerate(materials)]
