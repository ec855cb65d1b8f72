"""Mistakes of castray's own loop: replaced steps, in scenes where they show."""

from functools import partial

import numpy as np

import tracer
from lessons import zoo
from outside.mistake import Mistake
from tracer.doctor import examine
from tracer.frame import dot
from tracer.integrator import steps
from tracer.trace import gather

HOMEWORK = {"integrator": "direct", "hemisphere": "uniform", "roulette": "0.8", "light_sampling": "area"}
SMALL = {"width": 32, "height": 32, "spp": 8, "seed": 71}


def diagnosed(scene, settings, changes):
    """What the doctor says of the loop with some steps replaced."""
    loaded = tracer.load(scene)
    return examine(gather(loaded, tracer.Settings(**SMALL | settings), zoo.changed(**changes)))


def f_squared(beta, sample, cos):
    """The albedo is taken twice."""
    return steps.throughput(beta, sample, cos) * np.where(sample.delta, 1.0, np.pi * sample.f).astype(
        cos.dtype
    )


def material_of_the_next(scene, hit, wo, wi):
    """The materials are off by one."""
    number = (hit.bsdf + 1) % len(scene.bsdf_names)
    return scene.bsdf.eval(number, wo, wi, hit.texture)


def survivors_divided_by_the_dead(beta, probability, u):
    """beta / (1 - q)."""
    return u < probability, beta / (1 - probability)


def a_bounce_too_early(settings, beta, depth):
    """Roulette begins one bounce before it should."""
    return steps.survival(settings, beta, depth + 1)


def another_heuristic(settings, strategy, pdf_light, pdf_bsdf):
    """One technique by the balance heuristic, the other by the power heuristic."""
    return 1.0 / (1.0 + np.fmax(pdf_bsdf / pdf_light, 0.0)) * (pdf_light > 0.0)


def from_half_way(scene, hit, vertex, lit):
    """The density at a lamp is that of a point half way to it."""
    return steps.emission(scene, hit, 0.5 * (vertex + hit.p).astype(vertex.dtype), lit)


def chance_of_another_lamp(scene, hit, u):
    """The probability in the density is that of the lamp before."""
    light = scene.sample_light(hit.p, u)
    pick = np.roll(light.pick, 1)
    return light._replace(pdf=light.pdf / light.pick * pick)


def point_of_the_neighbour(scene, hit, u):
    """The direction leads to the light point of another path."""
    light = scene.sample_light(hit.p, u)
    return light._replace(wi=np.roll(light.wi, 1, axis=1))


def half_and_half(scene, hit, wo, u):
    """Mirrored or let through with one half each, it says; it is Fresnel that chooses."""
    sample = steps.bounce(scene, hit, wo, u)
    return sample._replace(pdf=np.where(sample.delta, 0.5, sample.pdf).astype(sample.pdf.dtype))


def straight_through(scene, hit, wo, u):
    """What is let through is not bent."""
    sample = steps.bounce(scene, hit, wo, u)
    through = sample.delta & (sample.wi[2] * wo[2] < 0.0)
    return sample._replace(wi=np.where(through, -wo, sample.wi))


def half_absorbed(scene, medium, distance):
    """The way is taken for half as long."""
    return steps.transmittance(scene, medium, 0.5 * distance.astype(distance.dtype))


def numbers_of_the_light(draw, pixel, sample, depth, use):
    """The bounce uses the numbers of the light sample again."""
    return draw(pixel, sample, depth, "light" if use == "bsdf" else use)


def too_near_the_normal(scene, hit, wo, u):
    """Directions that crowd at the normal or at the horizon, with the density of those that do not."""
    return steps.bounce(scene, hit, wo, np.stack((u[0], u[1] ** u.dtype.type(0.6), u[2])))


def wider(scene, settings, film, lens):
    """Pixels are a tenth wider than they are."""
    middle = np.array([[settings.width / 2], [settings.height / 2]], film.dtype)
    away = film - middle
    bent = middle + away * (1 + 0.02 * np.sqrt((away * away).sum(axis=0)) / settings.width)
    return steps.camera(scene, settings, bent.astype(film.dtype), lens)


def neighbours_shadow(scene, hit, light):
    """Whether the neighbour's light point is seen."""
    return np.roll(steps.visibility(scene, hit, light), 1)


def bent_by_the_root(radiance, wave, lane):
    """The root of each sample."""
    return np.sqrt(radiance)


def by_the_cosine(scene, hit, vertex, lit):
    """Lamps that are met shine by the cosine."""
    Le, pdf = steps.emission(scene, hit, vertex, lit)
    cos = np.abs(dot(hit.ng, hit.wo))[lit]
    return Le * cos, pdf


def without_throughput(beta, f, cos, light, w):
    """f cos Le w / pdf, at any depth."""
    return steps.light_term(np.ones_like(beta), f, cos, light, w)


def cosine_of_the_lamp(beta, f, cos, light, w):
    """The lamp's cosine in the place of the surface's."""
    return steps.light_term(beta, f, np.abs(dot(light.nq, light.wi)), light, w)


def towards_the_ray(scene, o, d, t, primitive):
    """Normals are turned to where the ray comes from, in glass as well."""
    hit = steps.hit(scene, o, d, t, primitive)
    turn = np.where(dot(hit.n, hit.wo) < 0.0, -1, 1).astype(hit.n.dtype)
    return hit._replace(n=hit.n * turn, ng=hit.ng * turn)


def off_the_surface(scene, hit, wi):
    """The next ray starts a hundredth of the scene above the surface."""
    o, d = steps.next_ray(scene, hit, wi)
    low, high = scene.bounds()
    return o + hit.ng * o.dtype.type(0.02 * (high - low).max()), d


def normal_of_before(scene, hit):
    """The local frame is that of another path's hit."""
    return steps.frame(scene, hit._replace(n=np.roll(hit.n, 1, axis=1)))


def f_with_half_cosine(scene, hit, wo, wi):
    """f times the cosine between normal and half vector."""
    f = steps.eval(scene, hit, wo, wi)
    half = wo + wi
    half = half / np.maximum(np.sqrt(dot(half, half)), 1e-6)
    return f * np.abs(half[2])


_MIRROR = ("bounce-mirror", "bounce-mirror-f", "bounce-mirror-pdf")
_WAY = ("chain", "first-surface", "own-surface", "wo")


def _of(id, words, laws, scene, settings, fair=(), **changes):
    return Mistake(id, words, laws, partial(diagnosed, scene, settings, changes), fair)


MISTAKES = (
    _of("f-twice", "beta f f cos / pdf", ("throughput",), "cornell", HOMEWORK, throughput=f_squared),
    _of(
        "material-off-by-one",
        "f of the next material in the list",
        ("light-f",),
        "cornell",
        HOMEWORK,
        eval=material_of_the_next,
    ),
    _of(
        "divided-by-the-dead",
        "beta / (1 - q)",
        ("roulette-weight",),
        "cornell",
        HOMEWORK,
        roulette=survivors_divided_by_the_dead,
    ),
    _of(
        "roulette-early",
        "roulette begins a bounce too early",
        ("roulette-probability", "roulette-played"),
        "furnace",
        {"max_depth": 8},
        survival=a_bounce_too_early,
    ),
    _of(
        "two-heuristics",
        "balance heuristic here, power heuristic there",
        ("light-weight",),
        "cornell_unit",
        {},
        ("M01",),
        light_weight=another_heuristic,
    ),
    _of(
        "density-from-half-way",
        "density at a met lamp from the wrong vertex",
        ("pdf-of-light",),
        "cornell_unit",
        {},
        emission=from_half_way,
    ),
    _of(
        "chance-of-another-lamp",
        "density with the probability of another lamp",
        ("light-pdf", "light-pick"),
        "many_lights",
        {},
        light_point=chance_of_another_lamp,
    ),
    _of(
        "point-of-the-neighbour",
        "direction to another path's light point",
        ("light-direction",),
        "cornell",
        HOMEWORK,
        light_point=point_of_the_neighbour,
    ),
    _of(
        "half-and-half",
        "density 1/2 of a mirrored ray that Fresnel chose",
        ("bounce-mirror-pdf",),
        "cornell_glass",
        {},
        bounce=half_and_half,
    ),
    _of("not-bent", "glass does not bend", _MIRROR[:1], "cornell_glass", {}, bounce=straight_through),
    _of(
        "half-absorbed",
        "exp(-sigma t / 2)",
        ("transmittance",),
        "coloured_glass",
        {},
        transmittance=half_absorbed,
    ),
    _of(
        "numbers-of-the-light",
        "bounce and light sample use the same numbers",
        ("numbers-independent",),
        "cornell",
        HOMEWORK,
        random=numbers_of_the_light,
    ),
    _of(
        "too-near-the-normal",
        "directions that do not follow their density",
        ("numbers-uniform", "directions"),
        "cornell_unit",
        {},
        bounce=too_near_the_normal,
    ),
    _of("barrel", "the camera bends lines", ("camera-ray",), "cornell_unit", {}, camera=wider),
    _of(
        "neighbours-shadow",
        "shadow ray of another path",
        ("light-visible",),
        "cornell",
        HOMEWORK,
        visibility=neighbours_shadow,
    ),
    _of("root", "the root of each sample", ("ledger",), "cornell", HOMEWORK, ("F03",), film=bent_by_the_root),
    _of(
        "lamp-by-cosine",
        "Le cos at lamps that are met",
        ("emission",),
        "cornell",
        HOMEWORK,
        emission=by_the_cosine,
    ),
    _of(
        "without-throughput",
        "direct light without what the path carries",
        ("light-term",),
        "cornell",
        HOMEWORK,
        light_term=without_throughput,
    ),
    _of(
        "cosine-of-the-lamp",
        "one cosine in the place of the other",
        ("light-term",),
        "cornell_unit",
        {},
        light_term=cosine_of_the_lamp,
    ),
    _of(
        "towards-the-ray",
        "normals turned towards the ray, in glass, too",
        ("normal", "shading-normal", "side"),
        "cornell_glass",
        {},
        hit=towards_the_ray,
    ),
    _of(
        "off-the-surface",
        "rays start above the surface",
        _WAY,
        "cornell",
        HOMEWORK,
        ("B10",),
        next_ray=off_the_surface,
    ),
    _of(
        "frame-of-another",
        "local frame of another path's normal",
        ("bounce-side", "bounce-f", "light-f", "light-cos"),
        "cornell",
        HOMEWORK,
        frame=normal_of_before,
    ),
    _of("f-with-half-cosine", "f times n . h", ("light-f",), "materials", {}, eval=f_with_half_cosine),
)
