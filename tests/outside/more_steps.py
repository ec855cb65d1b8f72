"""More mistakes of castray's own loop, written when those of steps.py had been mended."""

from functools import partial

import numpy as np

from outside.mistake import Mistake
from outside.steps import HOMEWORK, diagnosed
from tracer.frame import dot, normalize
from tracer.integrator import steps


def cosine_at_mirrors(beta, sample, cos):
    """beta f cos / pdf at mirrors and glass, too, where the cosine cancels."""
    return beta * sample.f * (cos / sample.pdf)


def without_four_h(scene, hit, wo, u):
    """The density of the half vector where that of the direction belongs."""
    sample = steps.bounce(scene, hit, wo, u)
    half = normalize(wo + sample.wi)
    rough = (scene.bsdf.pdf(hit.bsdf, wo, sample.wi, hit.texture) > 0.0) & (sample.lobe == 2)
    factor = np.where(rough & (sample.wi[2] * wo[2] > 0.0), 4.0 * np.abs(dot(wo, half)), 1.0)
    return sample._replace(pdf=(sample.pdf * factor).astype(sample.pdf.dtype))


def of_both(settings, strategy, pdf_light, pdf_bsdf):
    """The square of a sum in the denominator, where a sum of squares belongs."""
    return (pdf_light / np.maximum(pdf_light + pdf_bsdf, 1e-30)) ** 2


def exchanged(settings, strategy, pdf_bsdf, pdf_light):
    """The weight of the other technique."""
    finite = np.where(np.isinf(pdf_bsdf), 1.0, pdf_bsdf)
    weight = steps.mis_weight(settings, pdf_light, finite)
    return np.where(np.isinf(pdf_bsdf), 1.0, weight).astype(pdf_light.dtype)


def other_side_of_the_lamp(scene, hit, u):
    """The lamp's normal points to its back."""
    light = scene.sample_light(hit.p, u)
    return light._replace(nq=-light.nq)


def only_red_is_paid(beta, probability, u):
    """Red alone is divided by the probability."""
    return u < probability, np.stack((beta[0] / probability, beta[1], beta[2]))


def a_little_aside(scene, hit, wi):
    """The ray leaves in a direction that is a little off the one that was chosen."""
    o, d = steps.next_ray(scene, hit, wi)
    return o, normalize(d + np.array([[0.03], [0.0], [0.0]], d.dtype))


def texture_of_the_neighbour(scene, hit, wo, wi):
    """The colour is looked up for another path's point."""
    return scene.bsdf.eval(hit.bsdf, wo, wi, np.roll(hit.texture, 1, axis=2))


def as_red_is(scene, medium, distance):
    """All colours are absorbed as red is."""
    left = steps.transmittance(scene, medium, distance)
    return np.repeat(left[:1], 3, axis=0)


def every_second_depth(draw, pixel, sample, depth, use):
    """Two depths share their numbers."""
    return draw(pixel, sample, depth // 2 * 2 if use == "light" else depth, use)


def turned_over(draw, pixel, sample, depth, use):
    """The bounce uses 1 - u of the light sample."""
    if use != "bsdf":
        return draw(pixel, sample, depth, use)
    u = draw(pixel, sample, depth, "light")
    return np.minimum(1 - u, np.nextafter(u.dtype.type(1), u.dtype.type(0)))


def half_a_pixel_up(scene, settings, film, lens):
    """Rows are counted from the middle of the pixels twice."""
    return steps.camera(scene, settings, film + np.array([[0.0], [0.5]], film.dtype), lens)


def one_sample_less(radiance, wave, lane):
    """Divided by spp - 1."""
    spp = wave.settings.spp
    return radiance * radiance.dtype.type(spp / (spp - 1))


def weight_twice(beta, f, cos, light, w):
    """The weight is multiplied in twice."""
    return steps.light_term(beta, f, cos, light, w * w)


def cosine_of_the_eye(scene, hit, wo, wi):
    """The BSDF with wo's cosine in it."""
    return steps.eval(scene, hit, wo, wi) * np.abs(wo[2])


def first_shape_only(scene, hit, light):
    """What blocks is asked of the last shape alone."""
    blocked = scene.occluded(hit, light)
    t, primitive = scene.intersect(hit.p, light.wi, hit.primitive)
    last = scene.shape_of[np.maximum(primitive, 0)] == scene.shape_of.max()
    return ~(blocked & last & (primitive >= 0))


def half_flat(scene, o, d, t, primitive):
    """Interpolated normals half way to the flat ones."""
    hit = steps.hit(scene, o, d, t, primitive)
    return hit._replace(n=normalize(hit.n + hit.ng))


def bright_lamps_more(scene, hit, u):
    """Lamps are chosen by the square of a random number, the probability stays as it was."""
    return scene.sample_light(hit.p, np.stack((u[0] * u[0], u[1], u[2])))


def radiosity(scene, hit, u):
    """The lamp's power where its radiance belongs."""
    light = scene.sample_light(hit.p, u)
    return light._replace(Le=light.Le * light.Le.dtype.type(np.pi))


def one_lobe_for_all(scene, hit, wo, wi):
    """The density forgets that each of two lobes is chosen by half."""
    return steps.pdf(scene, hit, wo, wi) * 2


def sky_as_seen_twice(settings, strategy, pdf_bsdf, pdf_light):
    """Bounces count against twice the density of the light sample."""
    return steps.emission_weight(settings, strategy, pdf_bsdf, 2 * pdf_light)


def fresnel_twice(scene, hit, wo, u):
    """What a mirror sends on is multiplied by its reflectance twice."""
    sample = steps.bounce(scene, hit, wo, u)
    return sample._replace(f=np.where(sample.delta, sample.f * sample.f, sample.f))


def greyed(beta, sample, cos):
    """All colours by the mean of the three."""
    after = steps.throughput(beta, sample, cos)
    return np.repeat(after.mean(axis=0, keepdims=True), 3, axis=0)


def by_the_old_throughput(settings, beta, depth):
    """The survival probability is worked out for the square of the throughput."""
    return steps.survival(settings, beta * beta, depth)


def _of(id, words, laws, scene, settings, fair=(), **changes):
    return Mistake(id, words, laws, partial(diagnosed, scene, settings, changes), fair, "fresh")


MISTAKES = (
    _of(
        "cosine-at-mirrors",
        "f cos / pdf at mirrors and glass, too",
        ("throughput",),
        "cornell_glass",
        {},
        throughput=cosine_at_mirrors,
    ),
    _of(
        "density-of-half-vectors",
        "the Jacobian 1 / (4 wo . h) is missing",
        ("bounce-pdf",),
        "plates",
        {},
        bounce=without_four_h,
    ),
    _of(
        "square-of-the-sum",
        "w = (p / (p + q))^2",
        ("light-weight",),
        "cornell",
        {},
        ("M01",),
        light_weight=of_both,
    ),
    _of(
        "weights-exchanged",
        "a met lamp has the light sample's weight",
        ("emission-weight",),
        "cornell_unit",
        {},
        ("M01",),
        emission_weight=exchanged,
    ),
    _of(
        "lamp-from-behind",
        "the normal of the lamp is that of its back",
        ("light-normal",),
        "mirror_corridor",
        {},
        light_point=other_side_of_the_lamp,
    ),
    _of(
        "red-is-paid",
        "red alone is divided by q",
        ("roulette-weight",),
        "cornell",
        HOMEWORK,
        roulette=only_red_is_paid,
    ),
    _of(
        "a-little-aside",
        "the ray leaves two degrees off",
        ("chain", "escape-direction"),
        "cornell",
        HOMEWORK,
        next_ray=a_little_aside,
    ),
    _of(
        "texture-of-the-neighbour",
        "colour of another path's point",
        ("light-f",),
        "textures",
        {},
        eval=texture_of_the_neighbour,
    ),
    _of(
        "all-as-red",
        "all colours are absorbed as red is",
        ("transmittance",),
        "coloured_glass",
        {},
        transmittance=as_red_is,
    ),
    _of(
        "depths-share",
        "two depths share the light sample's numbers",
        ("numbers-once",),
        "cornell",
        HOMEWORK,
        random=every_second_depth,
    ),
    _of(
        "numbers-turned-over",
        "the bounce uses 1 - u of the light sample",
        ("numbers-independent",),
        "cornell",
        HOMEWORK,
        random=turned_over,
    ),
    _of(
        "half-a-pixel-up",
        "rays go half a pixel too low",
        ("camera-ray",),
        "cornell_unit",
        {},
        camera=half_a_pixel_up,
    ),
    _of(
        "one-sample-less",
        "divided by spp - 1",
        ("ledger",),
        "cornell",
        HOMEWORK,
        ("F04",),
        film=one_sample_less,
    ),
    _of("weight-twice", "w^2", ("light-term",), "cornell_unit", {}, light_term=weight_twice),
    _of("cosine-of-the-eye", "f n . wo", ("light-f",), "cornell", HOMEWORK, eval=cosine_of_the_eye),
    _of(
        "last-shape-blocks",
        "only the last shape throws a shadow",
        ("light-visible",),
        "cornell_unit",
        {},
        visibility=first_shape_only,
    ),
    _of(
        "half-flat",
        "normals half way between the smooth and the flat ones",
        ("shading-normal",),
        "smooth_ball",
        {},
        hit=half_flat,
    ),
    _of(
        "lamp-by-a-square",
        "lamps chosen by the square of a number",
        ("lamp-choice",),
        "many_lights",
        {},
        ("D15",),
        light_point=bright_lamps_more,
    ),
    _of("pi-at-the-lamp", "pi Le", ("light-radiance",), "cornell", HOMEWORK, light_point=radiosity),
    _of("one-lobe", "density of two lobes twice", ("light-pdf-bsdf",), "materials", {}, pdf=one_lobe_for_all),
    _of(
        "sky-twice",
        "bounces are weighted against twice the light sampler's density",
        ("environment-weight", "emission-weight"),
        "sky",
        {},
        ("M01",),
        emission_weight=sky_as_seen_twice,
    ),
    _of("fresnel-twice", "F^2 at mirrors", ("bounce-mirror-f",), "materials", {}, bounce=fresnel_twice),
    _of("greyed", "all colours by their mean", ("throughput",), "cornell", HOMEWORK, throughput=greyed),
    _of(
        "survival-of-squares",
        "roulette by the square of the throughput",
        ("roulette-probability",),
        "cornell_unit",
        {},
        survival=by_the_old_throughput,
    ),
)  # fmt: skip
