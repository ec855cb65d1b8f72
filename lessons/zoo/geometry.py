"""Rays and what they meet."""

import numpy as np

from lessons.zoo.bug import Bug
from lessons.zoo.where import of_shape
from tracer.integrator.steps import intersect, next_ray
from tracer.shape.mesh import Mesh
from tracer.shape.sphere import Sphere

NEAREST = "I12: a hit is the nearest one ahead, on the primitive it names"
LAYERS = 16  # walls in a row that a ray is followed through


def through_thin_boxes(scene, o, d, source):
    """What lies in a plane across an axis has a bounding box without thickness, and is never met."""
    outline = np.concatenate([shape.outline() for shape in scene.shapes], axis=2)
    thin = (np.ptp(outline, axis=1) == 0.0).any(axis=0) & ~np.isin(
        scene.shape_of, [k for k, shape in enumerate(scene.shapes) if isinstance(shape, Sphere)]
    )
    t, primitive = intersect(scene, o, d, source)
    for _ in range(LAYERS):
        lanes = np.flatnonzero((primitive >= 0) & thin.take(primitive))
        if not lanes.size:
            return t, primitive
        way, at = d.take(lanes, axis=1), primitive[lanes]
        further, primitive[lanes] = intersect(scene, o.take(lanes, axis=1) + t[lanes] * way, way, at)
        t[lanes] += further
    return t, primitive


def behind_as_well(scene, o, d, source):
    """A triangle behind the start has the smallest distance, a negative one, and wins."""
    t, primitive = intersect(scene, o, d, source)
    back, other = intersect(scene, o, -d, source)
    wins = of_shape(scene, other, Mesh)
    return np.where(wins, -back, t), np.where(wins, other, primitive)


def own_surface_too(scene, o, d, source):
    """A ray may meet what it starts on."""
    return intersect(scene, o, d, np.full_like(source, -1))


def from_the_surface(scene, hit, wi):
    """The ray starts at the hit as it was rounded, not moved off the surface."""
    return hit.p, wi


def own_sphere_too(scene, o, d, source):
    """A ray may meet the sphere that it starts on."""
    return intersect(scene, o, d, np.where(of_shape(scene, source, Sphere), -1, source).astype(source.dtype))


def from_the_sphere(scene, hit, wi):
    """A ray from a sphere starts at the hit as it was rounded."""
    o, d = next_ray(scene, hit, wi)
    return np.where(of_shape(scene, hit.primitive, Sphere), hit.p, o), d


BUGS = (
    Bug(
        "G01",
        "Slab test that refuses boxes without thickness",
        "Floor, ceiling, back wall and lamp are gone: only what is tilted against the axes is left.",
        "hit = t_enter < t_exit, where t_enter <= t_exit belongs",
        NEAREST,
        {"intersect": through_thin_boxes},
    ),
    Bug(
        "G02",
        "Hits behind the start accepted",
        "Indirect light comes from the wrong places: a ray that leaves a box goes on at its far side.",
        "return the hit with the smallest t, without t > 0",
        NEAREST,
        {"intersect": behind_as_well},
        note="Only for triangles, not for shadow rays, and for the nearest one behind the start. Bounding "
        "boxes, as the homework has them, hide most of it.",
    ),
    Bug(
        "G03",
        "Surface met by its own rays",
        "Acne: indirect light is lost wherever rounding put the start of a ray behind its surface.",
        "hit = t > 0, without an offset of the start and without a least distance",
        NEAREST,
        {"next_ray": from_the_surface, "intersect": own_surface_too},
        note="Only for bounces; shadow rays start as they should.",
    ),
    Bug(
        "G08",
        "Sphere met by its own rays",
        "A diffuse sphere is dotted: rays that leave it meet it at once.",
        "if t0 < 0: t0 = t1, where t0 < epsilon belongs",
        NEAREST,
        {"next_ray": from_the_sphere, "intersect": own_sphere_too},
        scene="sky",
        integrator="path",
        settings={},
    ),
)
