"""The ends of a ray under the microscope: how far it starts from its own surface, and how near it comes to q.

Heights are those over the own surface as the scene defines it, worked out in float64, to the side that the
ray leaves to.
"""

from dataclasses import dataclass

import numpy as np

from tracer.frame import dot, length
from tracer.shape.rays import leave
from tracer.shape.sphere import Sphere


@dataclass(frozen=True)
class Start:
    """Where a ray leaves a surface; lengths in metres.

    ulp: from one number of the scene's precision to the next at the point's largest coordinate. point:
    height of the recorded point. offset: the error bound by which it is moved off its surface. start: height
    of where the ray starts in the end. aside: how far that was moved off other faces that it touches. own: t
    at which a ray from the recorded point itself meets its own surface, NaN where it never does.
    """

    ulp: float
    point: float
    offset: float
    start: float
    aside: float
    own: float


@dataclass(frozen=True)
class Aim:
    """What a ray from the recorded point, not moved at all, meets on its way to a point at a distance.

    shape: number of what it meets first, -1 for nothing, at t. distance: as recorded. ulp: there.
    """

    shape: int
    t: float
    distance: float
    ulp: float

    @property
    def ulps(self):
        """By how many ulps t is beyond the distance: below 0 a comparison without tolerance says blocked."""
        return (self.t - self.distance) / self.ulp


def start(scene, hit, w):
    """The Start of a ray along w (3,) from a recorded HIT's values. scene: at the record's settings."""
    p, ng, w = (np.reshape(v, (3, 1)).astype(scene.dtype) for v in (hit["p"], hit["ng"], w))
    primitive = np.array([hit["primitive"]])
    bound = scene.bound(p, ng, primitive)
    left = leave(p, ng, bound, w)
    began = scene.started(left, w, primitive)
    away = float(np.copysign(1.0, dot(ng.astype(float), w.astype(float))[0]))
    heights = [away * _height(scene, primitive[0], x[:, 0].astype(float)) for x in (p, began)]
    return Start(
        float(np.spacing(np.abs(p).max())),
        heights[0],
        float(bound[0]),
        heights[1],
        float(length(began - left)[0]),
        _own(scene, primitive[0], p[:, 0], w[:, 0]),
    )


def aim(scene, hit, wi, distance):
    """The Aim of a ray from a recorded HIT's values along wi (3,) at what is so far away."""
    p, wi = (np.reshape(v, (3, 1)).astype(scene.dtype) for v in (hit["p"], wi))
    t, primitive = scene.intersect(p, wi, np.array([hit["primitive"]], np.int32))
    shape = int(scene.shape_of[primitive[0]]) if primitive[0] >= 0 else -1
    return Aim(shape, float(t[0]), float(distance), float(np.spacing(scene.dtype(distance))))


def _face(scene, primitive):
    """(sphere or None, normal (3,), offset) of a primitive, in float64."""
    number = int(scene.shape_of[primitive])
    shape = scene.shapes[number]
    if isinstance(shape, Sphere):
        return shape, None, None
    n, c = shape.planes()
    k = int(primitive - scene.first[number])
    return None, np.asarray(n, float)[:, k], float(c[k])


def _height(scene, primitive, x):
    """Height of a point (3,) over a primitive's surface, on the side of its normal."""
    ball, n, c = _face(scene, primitive)
    if ball is None:
        return float(np.dot(n, x) - c)
    out = float(np.linalg.norm(x - np.ravel(ball.center)) - ball.radius)
    return -out if ball.flip_normals else out


def _own(scene, primitive, p, w):
    """t of a primitive's surface along w from p (3,), nearest to 0, in the scene's precision."""
    ball, n, c = _face(scene, primitive)
    with np.errstate(all="ignore"):
        if ball is None:
            n = n.astype(p.dtype)
            t = (p.dtype.type(c) - np.dot(n, p)) / np.dot(n, w)
        else:
            out = p - np.ravel(ball.center).astype(p.dtype)
            b = np.dot(out, w)
            root = np.sqrt(b * b - (np.dot(out, out) - p.dtype.type(ball.radius) ** 2))
            t = min(-b - root, -b + root, key=abs)
    return float(t) if np.isfinite(t) else float("nan")
