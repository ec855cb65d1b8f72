"""Where the path goes on, and what it is worth there."""

import numpy as np

from lessons.zoo.bug import HOMEWORK, Bug
from lessons.zoo.where import mixed
from tracer import warp
from tracer.bsdf.sample import Sample
from tracer.events import LOBES
from tracer.frame import Frame, normalize
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


def around_the_position(scene, hit, wo, u):
    """The hemisphere stands on the point's position vector, as if that were the normal."""
    sample = bounce(scene, hit, wo, u)
    world = Frame.around(normalize(hit.p)).to_world(sample.wi)
    wi = scene.frame(hit.n, hit.p, hit.primitive).to_local(world)
    f, pdf = (ask(hit.bsdf, wo, wi, hit.texture) for ask in (scene.bsdf.eval, scene.bsdf.pdf))
    return mixed(sample.delta, sample, Sample(wi, f, pdf, sample.delta, sample.lobe))


def whole_sphere(scene, hit, wo, u):
    """Half of the directions go into the surface, where nothing comes back; the density is right."""
    sample = bounce(scene, hit, wo, u)
    diffuse = sample.lobe == LOBES.index("diffuse")
    below = diffuse & (u[0] < 0.5)
    x, y, z = sample.wi
    wi = np.stack((x, y, np.where(below, -z, z)))
    half = sample.pdf.dtype.type(0.5)
    return sample._replace(wi=wi, f=sample.f * ~below, pdf=np.where(diffuse, half * sample.pdf, sample.pdf))


def without_guard(sample):
    """Whatever the density, the path goes on."""
    return np.ones(sample.pdf.shape, bool)


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
        settings=HOMEWORK | {"hemisphere": "cosine"},
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
        "B04",
        "Position passed where the normal belongs",
        "The ceiling is black and walls lose indirect light.",
        "material.sample(wo, hit.p), where material.sample(wo, hit.n) belongs",
        "I11: a reflected direction lies above the surface, dot(n, wi) > 0",
        {"bounce": around_the_position},
        note="The position is made a unit vector first.",
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
        "B08",
        "Whole sphere sampled for an opaque surface",
        "Right on average, but much noisier: half of the paths end inside the walls.",
        "a direction of the whole sphere with density 1/(4 pi), not flipped to the side of the normal",
        "I11: a reflected direction lies above the surface, dot(n, wi) > 0",
        {"bounce": whole_sphere},
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
        "B15",
        "Division by a zero density",
        "Single samples are not numbers; in the homework they make pixels white, here they are counted.",
        "L += f * cos * trace(next) / pdf, without `if pdf > 0`",
        "I10: all that a path records is finite, and no density it goes on with is 0",
        {"carries": without_guard},
        scene="materials",
        note="With diffuse walls a density of 0 takes a direction within rounding of the surface, once in "
        "millions of paths; a rough metal gives one whenever it mirrors below itself.",
    ),
)
