"""The light sample: its point, its visibility, its geometry."""

import numpy as np

from lessons.zoo.bug import CENTRES, Bug
from lessons.zoo.rounding import shadow_distances
from lessons.zoo.where import of_shape
from tracer import warp
from tracer.frame import dot
from tracer.integrator.steps import eval as bsdf_value
from tracer.integrator.steps import light_term
from tracer.light.sample import AREA
from tracer.shape.sphere import Sphere

HOMEWORK_LAMP = 0.65  # albedo of the homework's lamp, which a right tracer never uses
HOMEWORK_Q = 0.8  # its survival probability
EPSILON = 1e-5  # its tolerance; neighbouring float32 numbers are six times as far apart at the lamp's height

VISIBILITY = "I6: a point on a light is seen unless something lies strictly between"
MEASURE = "I4: pdf_w cos_light = pdf_area r^2"
LIGHT_TERM = "I5: a light sample brings beta Le f cos cos_light V / (r^2 pdf_area)"


def without_tolerance(scene, hit, light):
    """Rounding decides whether the lamp lies in front of itself."""
    t, r = shadow_distances(scene, hit, light)
    return t >= r


def tolerance_below_an_ulp(scene, hit, light):
    """A tolerance that is lost where it is less than the gap between neighbouring numbers."""
    t, r = shadow_distances(scene, hit, light)
    return t >= r - np.where(np.spacing(r) > EPSILON, 0.0, EPSILON)


def reversed_comparison(scene, hit, light):
    """Visible if something is met up to the lamp: the lamp itself always is."""
    t, _ = scene.intersect(hit.p, light.wi, hit.primitive)
    return t <= light.distance * (1.0 + 1e-3)


def anything_blocks(scene, hit, light):
    """Blocked if the shadow ray meets anything at all, the lamp included."""
    t, _ = scene.intersect(hit.p, light.wi, hit.primitive)
    return np.isinf(t)


def lamp_cosine_turned(beta, f, cos, light, w):
    """The lamp's cosine is taken with the direction to the lamp, not from it."""
    return light_term(beta, f, cos, light, w) * np.sign(dot(light.wi, light.nq))


def without_cosine(beta, f, cos, light, w):
    """beta f Le w / pdf."""
    return light_term(beta, f, np.ones_like(cos), light, w)


def distance_not_squared(beta, f, cos, light, w):
    """Divided by r where r^2 belongs."""
    return light_term(beta, f, cos, light, w) * light.distance


def area_density(beta, f, cos, light, w):
    """The density per area is used as if it were per solid angle."""
    pdf_area = light.pdf * -dot(light.wi, light.nq) / (light.distance * light.distance)
    return light_term(beta, f, cos, light._replace(pdf=pdf_area), w)


def same_number_twice(scene, hit, u):
    """One random number chooses both coordinates of the point: all lie on the lamp's diagonal."""
    return scene.sample_light(hit.p, u[[0, 1, 1]])


def lamp_material(scene, hit, wo, wi):
    """The lamp's own BSDF, asked at the surface: grey, whatever the surface's colour."""
    f = bsdf_value(scene, hit, wo, wi)
    return np.where(f > 0.0, HOMEWORK_LAMP * warp.INV_PI, 0.0).astype(f.dtype)


def behind_too(scene, hit, u):
    """A point on a lamp counts for receivers behind it as well."""
    light = scene.sample_light(hit.p, u)
    cos = -dot(light.wi, light.nq)
    behind = (cos < 0.0) & (light.technique == AREA)
    if not behind.any():  # as where no shape shines
        return light
    per_angle = light.distance * light.distance / np.where(behind, -cos, 1.0)
    pdf = np.where(behind, _area_density(scene, light) * per_angle, light.pdf).astype(light.pdf.dtype)
    radiance = scene.lights.area.radiance.take(light.light, axis=1, mode="clip")
    return light._replace(pdf=pdf, Le=np.where(behind, radiance, light.Le))


def _area_density(scene, light):
    """Density (N,) per area of points on shapes that shine, choice of the lamp included; of no meaning for
    other lights."""
    area = np.concatenate([shape.area() for shape in scene.shapes])
    lamps = scene.light_of >= 0
    total = np.bincount(scene.light_of[lamps], area[lamps])
    return light.pick / total.take(light.light, mode="clip")


def lamp_cosine_signed(beta, f, cos, light, w):
    """Whoever is behind the lamp gets light below zero."""
    return light_term(beta, f, cos, light, w) * np.sign(-dot(light.wi, light.nq))


def choice_for_free(scene, hit, u):
    """The density as if the lamp that was chosen were the only one."""
    light = scene.sample_light(hit.p, u)
    return light._replace(pdf=light.pdf / light.pick)


def root_of_the_choice(scene, hit, u):
    """Points that one half of the lamp gets three times as many of."""
    return scene.sample_light(hit.p, rooted(u))


def rooted(u):
    """Numbers (3, N) that lead to points of one of the two triangles that a lamp is cut into; the root of the
    first chooses, so that one triangle gets a quarter of the points."""
    first = np.sqrt(u[0]) < 0.5
    s, t = warp.uniform_triangle(u[1:])
    s, t = np.where(first, s, 1.0 - s), np.where(first, t, 1.0 - t)
    return np.stack((u[0], s, t)).astype(u.dtype)


def uniform_in_angles(scene, hit, u):
    """Points of a sphere with both angles uniform: they crowd at the poles."""
    light = scene.sample_light(hit.p, u)
    crowded = u.copy()
    crowded[1] = np.where(of_shape(scene, light.primitive, Sphere), 0.5 - 0.5 * np.cos(np.pi * u[1]), u[1])
    return scene.sample_light(hit.p, crowded)


def divided_by_survival(beta, f, cos, light, w):
    """Direct light is divided by the probability of the roulette, which it never played."""
    return light_term(beta, f, cos, light, w) / beta.dtype.type(HOMEWORK_Q)


def not_normalised(scene, hit, u):
    """The direction to the lamp keeps its length."""
    light = scene.sample_light(hit.p, u)
    return light._replace(wi=light.wi * light.distance)


BUGS = (
    Bug(
        "D01",
        "Shadow test without tolerance",
        "Dark specks, or stripes without jitter: half of the free light samples count as blocked.",
        "visible = distance of the first hit >= |lamp point - surface point|",
        VISIBILITY,
        {"visibility": without_tolerance},
        settings=CENTRES,
    ),
    Bug(
        "D02",
        "Shadow tolerance smaller than the rounding",
        "Dark specks or stripes as without any tolerance: half of the free light samples count as blocked.",
        "visible = distance of the first hit >= r - 0.00001, in a scene of 560 units in float32",
        VISIBILITY,
        {"visibility": tolerance_below_an_ulp},
        settings=CENTRES,
    ),
    Bug(
        "D03",
        "Shadow comparison reversed",
        "There are no shadows: everything that blocks the lamp lets its light through.",
        "visible = distance of the first hit <= r + tolerance",
        VISIBILITY,
        {"visibility": reversed_comparison},
    ),
    Bug(
        "D04",
        "The lamp counts as its own occluder",
        "All is black but the lamp.",
        "visible = the shadow ray hits nothing",
        VISIBILITY,
        {"visibility": anything_blocks},
    ),
    Bug(
        "D06",
        "Light sample shaded with the lamp's material",
        "Walls lose their colour in direct light: red turns pink and too bright, white hardly changes.",
        "Le * lamp_hit.material.eval(...), where surface_hit.material.eval(...) belongs",
        "I2: f is that of the material of the vertex it stands at",
        {"eval": lamp_material},
        note="The lamp has the homework's albedo of 0.65; in the scene it is black.",
    ),
    Bug(
        "D07",
        "Lamp cosine with the wrong sign",
        "All is black but the lamp: every light sample is negative.",
        "cos_light = dot(w, n_lamp) with w pointing to the lamp",
        LIGHT_TERM,
        {"light_term": lamp_cosine_turned},
    ),
    Bug(
        "D08",
        "Lamp cosine not clamped",
        "Isolated black dots on the ceiling round the lamp, which is too dark there.",
        "Le f cos dot(n_lamp, -wi) / r^2 / pdf, without `if dot(n_lamp, -wi) > 0`",
        "I10: no contribution is negative",
        {"light_point": behind_too, "light_term": lamp_cosine_signed},
    ),
    Bug(
        "D10",
        "Surface cosine missing in the light sample",
        "Walls that the light grazes are far too bright.",
        "f * Le / pdf, without dot(n, wi)",
        "I3: each vertex has exactly one cosine, dot(n, wi)",
        {"light_term": without_cosine},
    ),
    Bug(
        "D11",
        "Divided by the distance, not by its square",
        "The picture is burnt out, the more the larger the unit of length.",
        "divide by norm(x - p), taking it for the squared length",
        LIGHT_TERM,
        {"light_term": distance_not_squared},
    ),
    Bug(
        "D13",
        "Area density used as solid-angle density",
        "Brightness depends wrongly on the distance from the lamp.",
        "Le f cos / pdf_area, without cos_light / r^2",
        MEASURE,
        {"light_term": area_density},
    ),
    Bug(
        "D14",
        "Probability of choosing the lamp left out",
        "Direct light is too dark, the more so the more lamps there are.",
        "pdf = 1 / area of the chosen lamp, though it was chosen among several",
        "I16: the density of lamp points integrates to 1 over all lamps",
        {"light_point": choice_for_free},
        scene="many_lights",
    ),
    Bug(
        "D15",
        "Root of a random number where the number belongs",
        "Light and penumbrae are a little lopsided: one half of the lamp shines three times as often.",
        "p = sqrt(rand()) * total_area, to choose a triangle of the lamp; the density stays 1 / total_area",
        "I16: lamp points are uniform over the lamp's area",
        {"light_point": root_of_the_choice},
    ),
    Bug(
        "D17",
        "The same random number used twice",
        "Soft shadows show bands; walls are a few percent off.",
        "x = u, y = u: all points lie on the lamp's diagonal",
        "I16: lamp points are uniform over the lamp's area",
        {"light_point": same_number_twice},
    ),
    Bug(
        "D18",
        "Sphere lamp sampled uniformly in its angles",
        "A sphere lamp seems brighter from the directions of its poles.",
        "theta = 2 pi rand(), phi = pi rand(), with density 1 / area",
        "I16: lamp points are uniform over the lamp's area",
        {"light_point": uniform_in_angles},
        scene="mirror_corridor",
    ),
    Bug(
        "D20",
        "Direction to the lamp not normalised",
        "Walls far from the lamp are too bright: the cosine carries a factor r.",
        "dot(x - p, n) where dot(normalize(x - p), n) belongs",
        "I11: directions have length 1",
        {"light_point": not_normalised},
    ),
    Bug(
        "D21",
        "Direct light divided by the roulette",
        "The picture is a quarter too bright, the lamp itself is right.",
        "(L_dir + L_indir) / q, though only L_indir depends on the roulette",
        LIGHT_TERM,
        {"light_term": divided_by_survival},
    ),
)
