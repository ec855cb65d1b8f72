"""The named steps of the loop, in one frozen record: replace one to ask what a mistake there would do."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tracer.frame import dot

AUTO_DEPTH = 4  # first bounce at which automatic roulette is played: before it, paths are worth their cost
AUTO_MOST = 0.95  # its highest survival probability, so that a path in a white room still ends


def random(draw, pixel, sample, depth, use):
    """Numbers (k, N) in [0, 1) for one use; draw: the sampler, asked with the other arguments."""
    return draw(pixel, sample, depth, use)


def camera(scene, settings, film, lens):
    """Origins and unit directions, both (3, N), of rays through film positions (2, N) in pixels."""
    return scene.camera.rays(film, settings.width, settings.height, settings.dtype, lens)


def intersect(scene, o, d, source):
    """What rays meet first: distance (N,), inf for nothing, and primitive (N,), -1 for nothing; source: (N,)
    the primitives they start on."""
    return scene.intersect(o, d, source)


def hit(scene, o, d, t, primitive):
    """Everything about the points that rays meet, as a Hit: normals, side, material."""
    return scene.hit(o, d, t, primitive)


def shining(scene, hit):
    """Places (K,) of the hits that lie on the bright side of a lamp."""
    return scene.shining(hit)


def emission(scene, hit, vertex, lit):
    """Radiance (3, K) of the hits at places lit, and the density (K,) of a light sample for them."""
    return scene.emission(hit, vertex, lit)


def frame(scene, hit):
    """The local frame of each hit, in which BSDFs are asked."""
    return scene.frame(hit.n, hit.p, hit.primitive)


def emission_weight(settings, strategy, pdf_bsdf, pdf_light):
    """Weight (N,) of light found by bouncing into it.

    pdf_bsdf: density of the bounce, inf after the camera or a Dirac lobe. pdf_light: density with which
    light sampling would have found it. MIS by the power or balance heuristic (Veach 1997, 9.2).
    """
    if strategy == "bsdf":
        return np.ones_like(pdf_light)
    if strategy == "light":
        return np.isinf(pdf_bsdf).astype(pdf_light.dtype)
    return mis_weight(settings, pdf_bsdf, pdf_light)


def light_weight(settings, strategy, pdf_light, pdf_bsdf):
    """Weight (N,) of light found by sampling it; pdf_bsdf: density of a bounce in the same direction."""
    if strategy == "light":
        return np.ones_like(pdf_light)
    return mis_weight(settings, pdf_light, pdf_bsdf)


def mis_weight(settings, mine, other):
    """Weight (N,) of the technique with density `mine` against the one with density `other`; 0 where the
    first cannot give the direction at all."""
    ratio = other / mine
    if settings.heuristic == "power":
        ratio = ratio * ratio
    return (mine > 0.0) / (1.0 + np.fmax(ratio, 0.0))  # fmax: 0/0 where neither can


def light_point(scene, hit, u):
    """A point on a light for each hit, as a LightSample."""
    return scene.sample_light(hit.p, u)


def visibility(scene, hit, light):
    """Whether each point on a light is seen from its hit, (N,)."""
    return ~scene.occluded(hit, light)


def transmittance(scene, medium, distance):
    """Share (3, N) of the light that is left after a distance (N,) in metres through media, by number:
    exp(-sigma_t t). Asked only in scenes where something is filled."""
    return scene.media.transmittance(medium, distance)


def light_term(beta, f, cos, light, w):
    """beta f cos Le w / pdf, (3, N), for what is visible; 0 where the density is 0."""
    safe = np.maximum(light.pdf, np.finfo(light.pdf.dtype).tiny)
    return beta * f * light.Le * (cos * w / safe * (light.pdf > 0.0))


def eval(scene, hit, wo, wi):
    """f (3, N) of each hit's BSDF for a light sample in direction wi; both directions (3, N) are local."""
    return scene.bsdf.eval(hit.bsdf, wo, wi, hit.texture)


def pdf(scene, hit, wo, wi):
    """Density (N,) in sr^-1 with which a bounce would have gone to a light sample in direction wi."""
    return scene.bsdf.pdf(hit.bsdf, wo, wi, hit.texture)


def sides_agree(hit, wi):
    """Whether wi (3, N) is on the same side of the surface by its shading and by its true normal, (N,).
    Asked only in scenes where the two differ.

    Light that only the shading normal lets through would leak through the surface (Veach 1997, 5.3).
    """
    return dot(hit.n, wi) * dot(hit.ng, wi) > 0.0


def bounce(scene, hit, wo, u):
    """A direction from each hit's BSDF, as a Sample in the local frame; wo (3, N) is local too."""
    return scene.bsdf.sample(hit.bsdf, wo, u, hit.texture)


def carries(sample):
    """Whether each bounce brings anything, (N,): where it does not, the path is over."""
    return (sample.pdf > 0.0) & any_channel(sample.f)


def throughput(beta, sample, cos):
    """beta f cos / pdf, (3, N); at a Dirac lobe the cosine cancels and it is beta f / pdf."""
    if sample.delta.any():
        cos = np.where(sample.delta, cos.dtype.type(1.0), cos)
    return beta * sample.f * (cos / sample.pdf)


def survival(settings, beta, depth):
    """Probability (N,) with which Russian roulette lets each path go on; 1 where it is not played."""
    if settings.roulette == "off":
        return np.ones_like(beta[0])
    if settings.roulette != "auto":
        return np.full_like(beta[0], float(settings.roulette))
    early = depth < AUTO_DEPTH
    if early.all():
        return np.ones_like(beta[0])
    brightest = np.maximum(np.maximum(beta[0], beta[1]), beta[2])
    return np.maximum(np.minimum(brightest, beta.dtype.type(AUTO_MOST)), early)


def roulette(beta, probability, u):
    """Who survives (N,), and the throughput (3, N) of those who do: beta / probability."""
    return u < probability, beta / probability


def next_ray(scene, hit, wi):
    """Where the path goes on: origin and unit direction, both (3, N)."""
    return scene.spawn(hit, wi), wi


def film(radiance, wave, lane):
    """What a finished path's radiance (3, N) counts for in its pixel: itself. lane: (N,) places in the wave,
    which knows pixels and settings."""
    return radiance


def any_channel(colour):
    """Whether any channel of colours (3, N) is not 0, (N,)."""
    return (colour[0] != 0.0) | (colour[1] != 0.0) | (colour[2] != 0.0)


@dataclass(frozen=True)
class Steps:
    """The steps the loops call. The bug zoo, what-if and twin runs replace one of them."""

    random: Callable = random
    camera: Callable = camera
    intersect: Callable = intersect
    hit: Callable = hit
    shining: Callable = shining
    emission: Callable = emission
    emission_weight: Callable = emission_weight
    frame: Callable = frame
    light_weight: Callable = light_weight
    light_point: Callable = light_point
    eval: Callable = eval
    pdf: Callable = pdf
    sides_agree: Callable = sides_agree
    visibility: Callable = visibility
    transmittance: Callable = transmittance
    light_term: Callable = light_term
    bounce: Callable = bounce
    carries: Callable = carries
    throughput: Callable = throughput
    survival: Callable = survival
    roulette: Callable = roulette
    next_ray: Callable = next_ray
    film: Callable = film


RIGHT = Steps()
