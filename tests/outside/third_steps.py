"""Mistakes of castray's own loop that had a wrong name, or none was found, in the third batch."""

from functools import partial

import numpy as np

from lessons.zoo.light import behind_too
from outside.mistake import Mistake
from outside.steps import diagnosed
from tracer.frame import dot, normalize
from tracer.integrator import steps


def from_the_camera(scene, hit, light):
    """The shadow ray starts at the camera."""
    eye = np.broadcast_to(scene.camera.origin[:, None], hit.p.shape).astype(hit.p.dtype)
    gap = hit.p + light.wi * light.distance - eye
    distance = np.sqrt(dot(gap, gap))
    t, _ = scene.intersect(eye, gap / distance, np.full(hit.primitive.shape, -1))
    return t >= distance * (1 - 1e-3)


def both_sides(scene, hit):
    """A lamp shines whichever side is met."""
    return np.flatnonzero(hit.light >= 0)


def density_from_both(scene, hit, vertex, lit):
    """The density of a light sample at a lamp that is met, whichever side it is."""
    Le = scene.lights.area.radiance[:, hit.light[lit]]
    away = vertex[:, lit] - hit.p[:, lit]
    ng = hit.ng[:, lit] * np.sign(dot(hit.ng[:, lit], away))
    return Le, scene.lights.area.pdf(hit.primitive[lit], vertex[:, lit], hit.p[:, lit], ng)


def without_sign(scene, hit, wo, wi):
    """f is asked above the surface wherever the light is: cosines have lost their signs."""
    up = np.stack((wi[0], wi[1], np.abs(wi[2])))
    return steps.eval(scene, hit, np.stack((wo[0], wo[1], np.abs(wo[2]))), up)


def density_without_sign(scene, hit, wo, wi):
    """The density, likewise."""
    up = np.stack((wi[0], wi[1], np.abs(wi[2])))
    return steps.pdf(scene, hit, np.stack((wo[0], wo[1], np.abs(wo[2]))), up)


def choice_again(scene, hit, u):
    """The number that chooses the lamp is the point's first coordinate, too."""
    return scene.sample_light(hit.p, np.stack((u[0], u[0], u[2])))


ROUGH = 0.3  # of the rough plate


def whole_disk(scene, hit, wo, u):
    """Visible normals from the whole disk, whose far half is not pressed together: some face away."""
    sample = steps.bounce(scene, hit, wo, u)
    v = normalize(np.stack((ROUGH * wo[0], ROUGH * wo[1], wo[2])))
    across = normalize(np.stack((-v[1], v[0], np.full_like(v[0], 1e-12))))
    other = np.cross(v, across, axis=0)
    r, phi = np.sqrt(u[1]), 2.0 * np.pi * u[2]
    m = r * np.cos(phi) * across + r * np.sin(phi) * other + np.sqrt(1.0 - r * r) * v
    m = normalize(np.stack((ROUGH * m[0], ROUGH * m[1], np.maximum(m[2], 1e-6))))
    wi = (2.0 * dot(wo, m) * m - wo).astype(wo.dtype)
    f, pdf = (getattr(scene.bsdf, what)(hit.bsdf, wo, wi, hit.texture) for what in ("eval", "pdf"))
    rough = hit.bsdf == scene.bsdf_names.index("rough")
    return sample._replace(
        wi=np.where(rough, wi, sample.wi),
        f=np.where(rough, f, sample.f),
        pdf=np.where(rough, pdf, sample.pdf),
    )


def _of(id, words, laws, scene, settings, fair=(), **changes):
    return Mistake(id, words, laws, partial(diagnosed, scene, settings, changes), fair, "third")


_BY_AREA = {"light_sampling": "area"}
MISTAKES = (
    _of(
        "shadow-from-the-camera",
        "shadow rays start at the camera",
        ("light-visible",),
        "many_lights",
        {},
        visibility=from_the_camera,
    ),
    _of(
        "lamps-from-both-sides",
        "lamps shine from both sides, and are weighted so",
        ("emission", "light-pdf", "light-radiance"),
        "many_lights",
        _BY_AREA,
        ("E06", "D08"),
        shining=both_sides,
        light_point=behind_too,
        emission=density_from_both,
    ),
    _of(
        "cosines-without-sign",
        "f and density of light from below the surface",
        ("light-f", "light-pdf-bsdf"),
        "many_lights",
        {},
        eval=without_sign,
        pdf=density_without_sign,
    ),
    _of(
        "choice-again",
        "the number that chooses the lamp is the point's first coordinate, too",
        ("lamp-points",),
        "plates",
        _BY_AREA,
        ("D17",),
        light_point=choice_again,
    ),
    _of(
        "whole-disk",
        "visible normals from the whole disk, whose far half is not pressed together",
        ("directions-beside",),
        "plates",
        {"width": 64, "height": 64},
        bounce=whole_disk,
    ),
)
