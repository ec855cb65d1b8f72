"""Scenes of shapes alone, without files, and rays that go on from their points."""

import numpy as np

from tracer.bsdf.diffuse import Diffuse
from tracer.camera import Camera
from tracer.definition import Definition, Surface
from tracer.scene import Scene

DTYPES = (np.float32, np.float64)
TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])  # orthogonal, no zero but one


def scene_of(shapes, dtype, radiance=()):
    """Shapes, white, in one precision; radiance: of those that shine, by their number."""
    camera = Camera(np.zeros(3), np.array([0.0, 0.0, -1.0]), np.array([0.0, 1.0, 0.0]), 40.0)
    radiance = dict(radiance)
    surfaces = tuple(Surface(shape, "white", radiance.get(k)) for k, shape in enumerate(shapes))
    white = {"white": Diffuse(np.full((3, 1), 0.5))}
    return Scene(Definition("stress", surfaces, white, camera, 8, 8), dtype)


def placed(scale, shift=(0.0, 0.0, 0.0), turn=TURN):
    """The (4, 4) map that scales, turns and then moves."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn * scale, shift
    return matrix


def unit(rng, n, dtype):
    """Unit vectors (3, n), all directions alike."""
    d = rng.normal(size=(3, n))
    return (d / np.linalg.norm(d, axis=0)).astype(dtype)


def going_on(scene, p, d, primitive):
    """Rays that leave points p of primitives along d: their hits, starts, and what they meet."""
    with np.errstate(all="ignore"):
        hit = scene.hit(p, -d, np.zeros(primitive.size, scene.dtype), primitive)
        o = scene.spawn(hit, d)
        return hit, o, *scene.intersect(o, d, primitive)
