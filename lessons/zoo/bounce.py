"""Where the path goes on, and what it is worth there."""

import numpy as np

from lessons.zoo.bug import Bug
from tracer import warp
from tracer.integrator.steps import bounce, next_ray

MATCHED_PDF = "I1: the density of a bounce is that of the sampler that made it"
THROUGHPUT = "I8: throughput grows by f cos / (pdf q) at every bounce"
CHAIN = "I13: the next vertex lies on the ray from this one"


def cosine_taken_for_uniform(scene, hit, wo, u):
    """Cosine-weighted directions, with the density of uniform ones."""
    sample = bounce(scene, hit, wo, u)
    return sample._replace(pdf=np.where(sample.delta, sample.pdf, warp.INV_2PI).astype(sample.pdf.dtype))


def one_quarter(scene, hit, wo, u):
    """Two coordinates of the direction are never negative."""
    sample = bounce(scene, hit, wo, u)
    x, y, z = sample.wi
    turned = np.where(sample.delta, sample.wi, np.stack((np.abs(x), np.abs(y), z)))
    return sample._replace(wi=turned)


def towards_the_surface(scene, hit, wo, u):
    """The BSDF is asked with the ray's own direction, which points into the surface."""
    return bounce(scene, hit, -wo, u)


def without_pdf(beta, sample, cos):
    """beta f cos."""
    return beta * sample.f * np.where(sample.delta, 1.0, cos).astype(cos.dtype)


def unchanged(beta, sample, cos):
    """beta: the surface takes nothing."""
    return beta


def local_as_world(scene, hit, wi):
    """The direction's local coordinates are used as if they were the world's."""
    return next_ray(scene, hit, scene.frame(hit.n, hit.p, hit.primitive).to_local(wi))


def from_the_next_hit(scene, hit, wi):
    """The path goes on from the point that this ray meets, in this ray's direction.

    In the homework rounding puts half of such starts behind that surface. Here all are, by a thousandth of
    the way: our rays know what they start on, and one that starts just at a wall would meet it as it should.
    """
    o, d = next_ray(scene, hit, wi)
    t, primitive = scene.intersect(o, d, hit.primitive)
    return o + np.where(primitive >= 0, 1.001 * t, 0.0).astype(t.dtype) * d, d


BUGS = (
    Bug(
        "B01",
        "Sampler and density do not match",
        "Indirect light is up to twice too bright, most of all on the ceiling.",
        "cosine-weighted directions, divided by 1/(2 pi)",
        MATCHED_PDF,
        {"bounce": cosine_taken_for_uniform},
    ),
    Bug(
        "B02",
        "Density of the bounce forgotten",
        "Hardly more than direct light is left; the ceiling is black.",
        "beta *= f * cos",
        THROUGHPUT,
        {"throughput": without_pdf},
    ),
    Bug(
        "B05",
        "Local direction not turned into world space",
        "Surfaces that do not face z get half of their indirect light, or none.",
        "use (x, y, z) of the hemisphere as the ray's direction",
        "I11: a reflected direction lies above the surface, dot(n, wi) > 0",
        {"next_ray": local_as_world},
    ),
    Bug(
        "B09",
        "Directions from one part of the hemisphere",
        "Light seems to come from one side only.",
        "normalize((rand, rand, rand)) with rand in [0, 1)",
        MATCHED_PDF,
        {"bounce": one_quarter},
    ),
    Bug(
        "B10",
        "The path goes on from the wrong point",
        "Specks, and the colours of the wrong wall: a surface is met twice or skipped.",
        "trace(Ray(next_hit.p, wi)), where Ray(p, wi) belongs",
        CHAIN,
        {"next_ray": from_the_next_hit},
    ),
    Bug(
        "B12",
        "Albedo not multiplied on the bounce",
        "All is washed out, without the walls' colours in the indirect light.",
        "L += trace(next), without f cos / pdf",
        THROUGHPUT,
        {"throughput": unchanged},
    ),
    Bug(
        "W01",
        "wo not negated",
        "There is no indirect light at all.",
        "sample(ray.direction), which points into the surface, where -ray.direction belongs",
        "I2: a BSDF is asked with directions that leave the surface",
        {"bounce": towards_the_surface},
    ),
)
