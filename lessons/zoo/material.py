"""What a surface makes of the light: f and its density."""

import numpy as np

from lessons.zoo.bug import Bug
from lessons.zoo.where import explained, of_material
from tracer import warp
from tracer.bsdf.plastic import Plastic
from tracer.integrator.steps import bounce
from tracer.integrator.steps import eval as bsdf_value

ENERGY = "I17: what a surface sends on is never more than what arrives"


def without_pi(scene, hit, wo, wi):
    """f = rho."""
    return bsdf_value(scene, hit, wo, wi) * wi.dtype.type(np.pi)


def bounce_without_pi(scene, hit, wo, u):
    """The same for the bounce; Dirac lobes have no pi."""
    sample = bounce(scene, hit, wo, u)
    return sample._replace(f=sample.f * np.where(sample.delta, 1.0, np.pi).astype(wo.dtype))


def same_direction_twice(scene, hit, wo, wi):
    """f asked with wi in the place of both directions."""
    return bsdf_value(scene, hit, wi, wi)


def bounce_same_direction_twice(scene, hit, wo, u):
    """The same for the bounce, whose direction and density are right."""
    sample = bounce(scene, hit, wo, u)
    f = bsdf_value(scene, hit, sample.wi, sample.wi)
    return sample._replace(f=np.where(sample.delta, sample.f, f))


def density_without_shadowing(scene, hit, wo, u):
    """The density as if all facets were seen from wo."""
    sample = bounce(scene, hit, wo, u)
    seen = explained(scene, hit, "G1", wo, sample.wi)
    return sample._replace(pdf=np.where(seen > 0.0, sample.pdf / seen, sample.pdf).astype(wo.dtype))


def zero_over_zero(scene, hit, wo, wi):
    """D of a surface without roughness, as a plain formula gives it."""
    f = bsdf_value(scene, hit, wo, wi)
    rough = ~np.isnan(explained(scene, hit, "D", wo, wi))
    return np.where(rough, np.nan, f).astype(f.dtype)


def bounce_zero_over_zero(scene, hit, wo, u):
    """The mirror direction, with f and density 0/0."""
    sample = bounce(scene, hit, wo, u)
    rough = ~np.isnan(explained(scene, hit, "D", wo, sample.wi))
    nothing = np.where(rough, np.nan, 1.0).astype(wo.dtype)
    wi = np.where(rough, warp.reflect(wo), sample.wi)
    return sample._replace(wi=wi, f=sample.f * nothing, pdf=sample.pdf * nothing)


def coat_for_free(scene, hit, wo, wi):
    """The diffuse base keeps what the coat over it has reflected already."""
    f = bsdf_value(scene, hit, wo, wi)
    return f * _regained(scene, hit, wo, wi, of_material(scene, hit, Plastic))


def bounce_coat_for_free(scene, hit, wo, u):
    """The same for the bounce; the mirror lobe is right."""
    sample = bounce(scene, hit, wo, u)
    base = of_material(scene, hit, Plastic) & ~sample.delta
    return sample._replace(f=sample.f * _regained(scene, hit, wo, sample.wi, base))


def _regained(scene, hit, wo, wi, where):
    """1 / ((1 - F(wo)) (1 - F(wi))), (N,); 1 but `where` (N,), and where nothing gets through."""
    through = (1.0 - explained(scene, hit, "F", wo, wi)) * (1.0 - explained(scene, hit, "F", wi, wo))
    where = where & (through > 0.0)
    return np.where(where, 1.0 / np.where(where, through, 1.0), 1.0).astype(wo.dtype)


BUGS = (
    Bug(
        "B03",
        "1/pi missing in the BRDF",
        "The picture is burnt out: each bounce brings more light than it got.",
        "eval returns albedo, where albedo / pi belongs",
        ENERGY,
        {"eval": without_pi, "bounce": bounce_without_pi},
    ),
    Bug(
        "B14",
        "Arguments of eval mixed up",
        "Nothing on diffuse surfaces; highlights of glossy ones sit where the light is straight overhead.",
        "eval(wi, wi, n), where eval(wo, wi, n) belongs",
        "I2: f is that of the two directions of its vertex",
        {"eval": same_direction_twice, "bounce": bounce_same_direction_twice},
        scene="materials",
        settings={},
        note="In the homework eval(w, w, n) is harmless until a microfacet material is added.",
    ),
    Bug(
        "S07",
        "Density of visible normals without the masking",
        "Rough metals are too dark towards their edges.",
        "pdf = D dot(wo, h) / (4 cos_o dot(wo, h)), without G1(wo)",
        "I1: the density of a bounce is that of the sampler that made it",
        {"bounce": density_without_shadowing},
        scene="materials",
        settings={},
    ),
    Bug(
        "S08",
        "Roughness of zero",
        "Rough metals are black, or not numbers.",
        "alpha = 0 in D = alpha^2 / (pi (...)^2)",
        "I10: all that a path records is finite, and no density it goes on with is 0",
        {"eval": zero_over_zero, "bounce": bounce_zero_over_zero},
        scene="materials",
        settings={},
        note="Every rough material of the scene is taken to have roughness 0.",
    ),
    Bug(
        "S09",
        "Diffuse and specular add up to more than 1",
        "Varnished surfaces are too bright, most towards their edges.",
        "Kd / pi + F * specular, where (1 - F) Kd / pi belongs",
        ENERGY,
        {"eval": coat_for_free, "bounce": bounce_coat_for_free},
        scene="materials",
        settings={},
        note="Only smooth plastic.",
    ),
)
