"""Glass and mirrors: how rays go through them, and what is lost inside."""

import numpy as np

from lessons.zoo.bug import Bug
from lessons.zoo.where import explained, mixed, of_material
from tracer.bsdf.dielectric import Dielectric
from tracer.bsdf.sample import Sample
from tracer.events import LOBES
from tracer.integrator.steps import bounce
from tracer.integrator.steps import eval as bsdf_value
from tracer.integrator.steps import pdf as bsdf_density

REFLECTION, TRANSMISSION = (np.int8(LOBES.index(name)) for name in ("reflection", "transmission"))

BEER_LAMBERT = "I8: throughput grows by f cos / (pdf q) at every bounce, and by exp(-sigma_t t) on the way"


def all_of_it(scene, medium, distance):
    """Nothing is lost, however long the way."""
    return np.ones((3, distance.size), distance.dtype)


def with_index(scene, hit, wo, u, wrong):
    """Bounces in which clear glass has the relative index wrong(index), index across over index at wo."""
    sample = bounce(scene, hit, wo, u)
    glass = of_material(scene, hit, Dielectric)
    index = wrong(np.where(glass, explained(scene, hit, "eta", wo, sample.wi), 1.0).astype(wo.dtype))
    clear = np.ones((3, 1), wo.dtype)
    other = Dielectric(np.where(wo[2] > 0.0, index, 1.0 / index), clear, clear).sample(wo, u)
    return mixed(glass, other, sample)


def never_swapped(scene, hit, wo, u):
    """The glass is entered each time, even from inside."""
    return with_index(scene, hit, wo, u, lambda index: np.maximum(index, 1.0 / index))


def no_total_reflection(scene, hit, wo, u):
    """Beyond the critical angle the refracted cosine is the root of a negative number."""
    sample = bounce(scene, hit, wo, u)
    index = explained(scene, hit, "eta", wo, sample.wi)
    total = of_material(scene, hit, Dielectric) & (1.0 - wo[2] * wo[2] >= index * index)
    one = np.ones_like(sample.pdf)
    nowhere = Sample(
        np.full_like(sample.wi, np.nan),
        np.stack((one, one, one)),
        one,
        sample.delta,
        np.full_like(sample.lobe, TRANSMISSION),
    )
    return mixed(total, nowhere, sample)


def turned(w):
    """A direction turned half round the normal."""
    return np.stack((-w[0], -w[1], w[2]))


def mirrored_to_the_wrong_side(scene, hit, wo, u):
    """Reflected light goes back to the side that it came from."""
    sample = bounce(scene, hit, wo, u)
    return sample._replace(wi=np.where(sample.lobe == REFLECTION, turned(sample.wi), sample.wi))


def highlight_on_the_wrong_side(scene, hit, wo, wi):
    """The half vector of wo and of the light's direction, turned."""
    return bsdf_value(scene, hit, wo, turned(wi))


def density_on_the_wrong_side(scene, hit, wo, wi):
    """And the density that belongs to it."""
    return bsdf_density(scene, hit, wo, turned(wi))


def radiance_not_scaled(scene, hit, wo, u):
    """The same radiance before and behind the surface, as if rays were not gathered into a smaller cone."""
    sample = bounce(scene, hit, wo, u)
    crossing = of_material(scene, hit, Dielectric) & (sample.lobe == TRANSMISSION)
    index = np.where(crossing, explained(scene, hit, "eta", wo, sample.wi), 1.0).astype(wo.dtype)
    return sample._replace(f=sample.f * (index * index))


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
        settings={},
    ),
    Bug(
        "S01",
        "Index of refraction not swapped on the way out",
        "What is seen through a glass ball is bent wrongly, and is never turned upside down.",
        "eta = 1 / 1.5 at every refraction, from inside as well",
        "I2: f and direction are those of the side that the ray is on",
        {"bounce": never_swapped},
        scene="cornell_glass",
        integrator="path",
        settings={},
        note="Only smooth clear glass.",
    ),
    Bug(
        "S02",
        "Total internal reflection not handled",
        "A glass block has black faces, a ball a black rim: paths end in a direction that is no number.",
        "cos_t = sqrt(1 - sin_t^2) without asking whether sin_t is above 1",
        "I10: all that a path records is finite, and no density it goes on with is 0",
        {"bounce": no_total_reflection},
        scene="glass_slab",
        integrator="path",
        settings={},
    ),
    Bug(
        "S04",
        "Sign of the half vector",
        "Mirrors show what lies behind the eye, and highlights sit on the wrong side.",
        "h = normalize(wi - wo), where normalize(wi + wo) belongs",
        "I2: f and direction are those of the angle between h and n",
        {
            "bounce": mirrored_to_the_wrong_side,
            "eval": highlight_on_the_wrong_side,
            "pdf": density_on_the_wrong_side,
        },
        scene="cornell_glass",
        integrator="path",
        settings={},
        note="Sampled directions and values agree with each other: both are turned half round the normal.",
    ),
    Bug(
        "S06",
        "Radiance not scaled by the square of the index",
        "Paths carry 2.25 times too much inside glass; outside it cancels, and the picture stays right.",
        "f = 1 - F for refraction, without 1 / eta^2",
        "I17: what a surface sends on is never more than what arrives",
        {"bounce": radiance_not_scaled},
        scene="cornell_glass",
        integrator="path",
        settings={},
    ),
)
