"""wi and wo, inwards and outwards, world and local: directions that are taken for one another."""

import numpy as np

from lessons.zoo.bug import Bug
from lessons.zoo.glass import with_index
from tracer.integrator.steps import bounce
from tracer.integrator.steps import eval as bsdf_value
from tracer.integrator.steps import pdf as bsdf_density

OUTWARDS = "I2: a BSDF is asked with directions that leave the surface"


def towards_the_surface(scene, hit, wo, u):
    """The BSDF is asked with the ray's own direction, which points into the surface."""
    return bounce(scene, hit, -wo, u)


def density_of_the_way_back(scene, hit, wo, u):
    """The density with which wi would have led to wo."""
    sample = bounce(scene, hit, wo, u)
    back = bsdf_density(scene, hit, sample.wi, wo)
    return sample._replace(pdf=np.where(sample.delta, sample.pdf, back))


def light_density_of_the_way_back(scene, hit, wo, wi):
    """The same mistake where a light sample is weighted."""
    return bsdf_density(scene, hit, wi, wo)


def side_of_the_wrong_direction(scene, hit, wo, u):
    """Glass takes inside for outside: its index is that of the other way through."""
    return with_index(scene, hit, wo, u, lambda index: 1.0 / index)


def world_for_local(scene, hit, wo, wi):
    """wo is local, wi is left in world space: the horizon is the world's xy plane, not the surface."""
    world = scene.frame(hit.n, hit.p, hit.primitive).to_world(wi)
    return bsdf_value(scene, hit, wo, world)


BUGS = (
    Bug(
        "W01",
        "wo not negated",
        "There is no indirect light at all.",
        "sample(ray.direction), which points into the surface, where -ray.direction belongs",
        OUTWARDS,
        {"bounce": towards_the_surface},
        note="Direct light still gets the right wo: asked with the wrong one, all would be black.",
    ),
    Bug(
        "W02",
        "Density of the opposite way",
        "Glossy surfaces are off, most at grazing angles; diffuse ones are right.",
        "pdf(wi, wo), where pdf(wo, wi) belongs: the sampler knew wo and chose wi",
        "I1: the density of a bounce is that of the sampler that made it",
        {"bounce": density_of_the_way_back, "pdf": light_density_of_the_way_back},
        scene="materials",
        settings={},
    ),
    Bug(
        "W03",
        "Side of the glass decided by the wrong direction",
        "Glass shows no lens: rays that enter are bent away from the normal, and many never get in.",
        "entering = dot(wi, n) > 0, where dot(wo, n) > 0 belongs",
        "I2: f and direction are those of the side that the ray is on",
        {"bounce": side_of_the_wrong_direction},
        scene="cornell_glass",
        integrator="path",
        settings={},
        note="Only smooth clear glass.",
    ),
    Bug(
        "W04",
        "World and local directions mixed",
        "Direct light depends on how a surface is turned: one that faces away from +z has none.",
        "material.eval(frame.to_local(wo), wi), where frame.to_local(wi) belongs",
        OUTWARDS,
        {"eval": world_for_local},
    ),
)
