"""A closed room with lamps around it: none of their light may come in."""

import numpy as np
from bare_scenes import placed, scene_of
from continuation import PLACES, room, rooms, starts

from tracer.shape import Rectangle, Sphere


def lit_from_outside(dtype, n, seed, spoil=lambda scene: None):
    """Of n shadow rays how many reach one of four lamps around a closed room."""
    made, rng = room("fine", PLACES[0], dtype), np.random.default_rng(seed)
    lamps = [Rectangle(f"lamp{k}", placed(0.5, 4.0 * axis, frame(-axis))) for k, axis in enumerate(np.eye(3))]
    lamps.append(Sphere("sun", np.array([-3.0, -3.0, -3.0]), 0.5))
    scene = scene_of([*rooms(PLACES[0])["fine"](), *lamps], dtype, {k: np.ones(3) for k in range(1, 5)})
    spoil(scene)
    face, p = starts(made, ("corners", "edges")[seed % 2], n, rng)
    inner = (made.corners[:, :, face] * rng.dirichlet(np.ones(4), n).T).sum(axis=1)
    p = np.where(rng.random(n) < 0.5, inner, p).astype(dtype)
    with np.errstate(all="ignore"):
        hit = scene.hit(p, -made.n[:, face].astype(dtype), np.zeros(n, dtype), face)
        light = scene.sample_light(hit.p, rng.random((3, n)).astype(dtype))
        inside = (hit.ng * light.wi).sum(axis=0) > 0.0
        return int(np.count_nonzero(~scene.occluded(hit, light) & inside & (light.pdf > 0.0)))


def frame(axis):
    """A rotation whose third column is a unit axis."""
    first = np.roll(np.abs(axis), 1)
    return np.stack((first, np.cross(axis, first), axis), axis=1)
