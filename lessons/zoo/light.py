"""The light sample: its point, its visibility, its geometry."""

import numpy as np

from lessons.zoo.bug import Bug
from tracer.frame import dot
from tracer.integrator.steps import light_term

VISIBILITY = "I6: a point on a light is seen unless something lies strictly between"
MEASURE = "I4: pdf_w cos_light = pdf_area r^2"
LIGHT_TERM = "I5: a light sample brings beta Le f cos cos_light V / (r^2 pdf_area)"


def without_tolerance(scene, hit, light):
    """Rounding decides whether the lamp lies in front of itself."""
    t, _ = scene.intersect(hit.p, light.wi, hit.primitive)
    return t >= light.distance


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


def not_normalised(scene, hit, u):
    """The direction to the lamp keeps its length."""
    light = scene.sample_light(hit.p, u)
    return light._replace(wi=light.wi * light.distance)


BUGS = (
    Bug(
        "D01",
        "Shadow test without tolerance",
        "Dark specks, or stripes without jitter: some of the free light samples count as blocked.",
        "visible = distance of the first hit >= |lamp point - surface point|",
        VISIBILITY,
        {"visibility": without_tolerance},
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
        "D07",
        "Lamp cosine with the wrong sign",
        "All is black but the lamp: every light sample is negative.",
        "cos_light = dot(w, n_lamp) with w pointing to the lamp",
        LIGHT_TERM,
        {"light_term": lamp_cosine_turned},
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
        "D17",
        "The same random number used twice",
        "Soft shadows show bands; walls are a few percent off.",
        "x = u, y = u: all points lie on the lamp's diagonal",
        "I16: lamp points are uniform over the lamp's area",
        {"light_point": same_number_twice},
    ),
    Bug(
        "D20",
        "Direction to the lamp not normalised",
        "Walls far from the lamp are too bright: the cosine carries a factor r.",
        "dot(x - p, n) where dot(normalize(x - p), n) belongs",
        "I11: directions have length 1",
        {"light_point": not_normalised},
    ),
)
