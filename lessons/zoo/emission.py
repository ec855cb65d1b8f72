"""Light that counts twice, or not at all."""

import numpy as np

from lessons.zoo.bug import Bug
from lessons.zoo.light import behind_too
from tracer import warp
from tracer.integrator.steps import emission, mis_weight

COUNT_ONCE = "I7: over all ways to find it, the weights of one light path sum to 1"


def always(settings, strategy, pdf_bsdf, pdf_light):
    """Every lamp that a ray meets counts in full, at every depth."""
    return np.ones_like(pdf_light)


def never(settings, strategy, pdf_bsdf, pdf_light):
    """No lamp that a ray meets counts, not even the one that the camera sees."""
    return np.zeros_like(pdf_light)


def never_filled(scene, hit, vertex, lit):
    """The field of the hit that is read has never been written: every lamp is found dark."""
    Le, pdf_light = emission(scene, hit, vertex, lit)
    return np.zeros_like(Le), pdf_light


def always_the_first(settings, strategy, pdf_bsdf, pdf_light):
    """Every vertex takes itself for the camera's first."""
    return always(settings, strategy, pdf_bsdf, pdf_light)


def either_side(scene, hit):
    """A lamp shines whichever side of it is met."""
    return np.flatnonzero(hit.light >= 0)


def of_another_sampler(settings, strategy, pdf_light, pdf_bsdf):
    """The light sample is weighted as if bounces were uniform over the hemisphere."""
    return mis_weight(settings, pdf_light, np.full_like(pdf_light, warp.INV_2PI))


def dirac_as_one(settings, strategy, pdf_bsdf, pdf_light):
    """The camera and mirrors are given a density of 1, though no light sample could stand in for them."""
    return mis_weight(
        settings, np.where(np.isinf(pdf_bsdf), 1.0, pdf_bsdf).astype(pdf_light.dtype), pdf_light
    )


BUGS = (
    Bug(
        "E01",
        "Lamp emission returned at every depth",
        "Everything is twice too bright and full of white salt that more samples hardly thin out.",
        "return the lamp's emission on any hit, while every vertex also samples the lamp",
        COUNT_ONCE,
        {"emission_weight": always},
    ),
    Bug(
        "E02",
        "The lamp never shows its own emission",
        "The lamp is as dark as the ceiling; the rest of the picture is right.",
        "return 0 (or only the reflected light) when the ray meets a lamp",
        "I14: a path's radiance is the sum of its terms, and Le at the camera's vertex is one of them",
        {"emission_weight": never},
    ),
    Bug(
        "E03",
        "Emission read from a field that is never filled",
        "The lamp is black; the rest of the picture is right.",
        "return hit.emit, which only the light sample fills, where hit.material.emission belongs",
        COUNT_ONCE,
        {"emission": never_filled},
    ),
    Bug(
        "E04",
        "Depth reset in the recursive call",
        "Everything is twice too bright and full of white salt, though emission is guarded by the depth.",
        "return trace(Ray(p, wi), 0), so that `if depth == 0: return emission` holds at every vertex",
        COUNT_ONCE,
        {"emission_weight": always_the_first},
        note="Recorded depths stay right here: they name the random numbers.",
    ),
    Bug(
        "E06",
        "The lamp shines from both sides",
        "A lamp that hangs free lights the ceiling above it; the homework's, right below it, shows nothing.",
        "cos_light = abs(dot(n_lamp, -wi)), and emission returned for a hit from behind",
        "I5: a light sample brings beta Le f cos cos_light V / (r^2 pdf_area), and Le is 0 behind the lamp",
        {"shining": either_side, "light_point": behind_too},
        scene="glass_slab",
    ),
    Bug(
        "M01",
        "MIS weights that do not sum to 1",
        "Slightly too dark or too bright, most where bounces and light samples are equally good.",
        "take the other density from a sampler that is not used: 1/(2 pi) for a cosine-weighted bounce",
        COUNT_ONCE,
        {"light_weight": of_another_sampler},
        scene="furnace",
        integrator="path",
        settings={},
    ),
    Bug(
        "M02",
        "A Dirac lobe weighted against light samples",
        "The lamp is too dim where the camera sees it directly or in a mirror.",
        "use a weight below 1 after the camera or a mirror, where the other technique has density 0",
        COUNT_ONCE,
        {"emission_weight": dirac_as_one},
        scene="cornell_glass",
        integrator="path",
        settings={},
    ),
)
