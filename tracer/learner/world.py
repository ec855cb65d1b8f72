"""The scene as a learner's own tracer sees it: one ray, one point, one number at a time.

The names are the homework's. Directions follow castray's convention: wo and wi both leave the surface.
"""

import math
import random

import numpy as np

from tracer.bsdf.diffuse import Diffuse
from tracer.frame import Frame
from tracer.learner.value import Point, Value, Vector, cross, named, normalize, vector
from tracer.settings import TracerError

_START = 1e-6  # of the scene's size: nearer to the start of a ray that starts on no hit's p nothing is met
_SAME = 1e-9  # how far directions may be apart that are one, made unit again
_NEAR = 1e-3  # of the scene's size: a ray may start so far above the point that it leaves
_TURNED = 1e-3  # how far directions are apart at least where a path turns


class Ray:
    """Where a ray starts and its unit direction, both Vector (any three numbers become one)."""

    __slots__ = ("direction", "origin")

    def __init__(self, origin, direction):
        self.origin, self.direction = vector(origin), vector(direction)


class Hit:
    """Where a ray meets a surface: p, n (of its front, unit), t, material, emission (0 where it does not
    shine this way), front (whether the ray came from the side of n)."""

    __slots__ = ("emission", "front", "material", "n", "p", "primitive", "t")

    def __init__(self, p, n, t, material, emission, primitive, front):
        self.p, self.n, self.t, self.material = p, n, t, material
        self.emission, self.primitive, self.front = emission, primitive, front


class LightSample:
    """A point on a lamp: p, n, emission, pdf (per area), and the lamp's own material."""

    __slots__ = ("emission", "material", "n", "p", "pdf", "primitive")

    def __init__(self, p, n, emission, pdf, material, primitive):
        self.p, self.n, self.emission, self.pdf = p, n, emission, pdf
        self.material, self.primitive = material, primitive


class Material:
    """What a surface is made of."""

    __slots__ = ("_diffuse", "_number", "_world")

    def __init__(self, world, number):
        self._world, self._number = world, number
        material = tuple(world.scene.definition.bsdfs.values())[number]
        self._diffuse = None
        if isinstance(material, Diffuse):
            self._diffuse = np.asarray(material.reflectance, np.float64).reshape(3)

    @property
    def albedo(self):
        """Its colour."""
        return named("albedo", self._world.scene.bsdf.colour(np.array([self._number]))[:, 0])

    def eval(self, wi, wo, n):
        """The BSDF from wi to wo, a colour, without the cosine."""
        wi, wo, n = vector(wi), vector(wo), vector(n)
        if self._diffuse is not None:
            above = (wi.x * n.x + wi.y * n.y + wi.z * n.z > 0.0) and (
                wo.x * n.x + wo.y * n.y + wo.z * n.z > 0.0
            )
            f = self._diffuse / np.pi if above else np.zeros(3)
        else:
            local = self._local(n, wo, wi)
            f = self._world.scene.bsdf.eval(np.array([self._number]), *local)[:, 0]
        return named("f", f, material=self._number, wi=wi, wo=wo, n=n)

    def pdf(self, wi, wo, n):
        """Density per solid angle with which `sample` gives wi."""
        wi, wo, n = vector(wi), vector(wo), vector(n)
        if self._diffuse is not None:
            cos = wi.x * n.x + wi.y * n.y + wi.z * n.z
            above = cos > 0.0 and wo.x * n.x + wo.y * n.y + wo.z * n.z > 0.0
            pdf = (0.5 / np.pi if self._world.scene.hemisphere == "uniform" else cos / np.pi) * above
        else:
            local = self._local(n, wo, wi)
            pdf = self._world.scene.bsdf.pdf(np.array([self._number]), *local)[0]
        return named("pdf", float(pdf), material=self._number, wi=wi, wo=wo, n=n)

    def sample(self, wo, n):
        """A direction wi to go on in."""
        wo, n = vector(wo), vector(n)
        if self._diffuse is not None:
            return _hemisphere(n, self._world.draw(), self._world.draw(), self._world.scene.hemisphere)
        frame = Frame.around(n.plain[:, None])
        u = np.array([[self._world.draw()] for _ in range(3)])
        local = self._world.scene.bsdf.sample(np.array([self._number]), frame.to_local(wo.plain[:, None]), u)
        return Vector(*frame.to_world(local.wi)[:, 0])

    def _local(self, n, wo, wi):
        frame = Frame.around(n.plain[:, None])
        return frame.to_local(wo.plain[:, None]), frame.to_local(wi.plain[:, None])


def _hemisphere(n, u, v, how):
    """A direction above a surface with normal n, uniform or in proportion to the cosine."""
    z = u if how == "uniform" else math.sqrt(u)
    r, phi = math.sqrt(max(0.0, 1.0 - z * z)), 2.0 * math.pi * v
    side = Vector(0.0, 1.0, 0.0) if abs(n.x) > 0.7 else Vector(1.0, 0.0, 0.0)
    t = normalize(cross(n, side))
    return t * (r * math.cos(phi)) + cross(n, t) * (r * math.sin(phi)) + n * z


class World:
    """A scene, asked scalar by scalar. `log` is the record of the call of cast_ray under way, or None."""

    def __init__(self, scene):
        self.scene, self.log = scene, None
        if any(hasattr(s.shape, "radius") for s in scene.definition.surfaces):
            raise TracerError(f"{scene.name}: spheres are not among what cast_ray can be given; use cornell")
        if scene.definition.emitters or any(scene.definition.textures.values()) or scene.media is not None:
            raise TracerError(
                f"{scene.name}: cast_ray can be given area lights, plain materials and no media"
            )
        self._faces = _Faces(scene)
        self._materials = [Material(self, k) for k in range(len(scene.bsdf_names))]
        low, high = scene.bounds()
        self._size = float(np.linalg.norm(np.subtract(high, low)))
        self._least = _START * self._size
        self.lamp_area = self._faces.lamp_area
        self._random = random.Random(0)

    def start(self, pixel, sample, seed):
        """Begin a path: its random numbers depend on nothing else."""
        self._random = random.Random(f"{seed} {pixel} {sample}")

    def draw(self):
        """A plain random number in [0, 1)."""
        return self._random.random()

    def random(self):
        """A random number in [0, 1)."""
        u = named("random", self.draw())
        if self.log is not None:
            self.log.randoms.append(u.terms[0][1][0][0])
        return u

    def intersect(self, ray):
        """The nearest Hit, None where the ray meets nothing."""
        log, others = self.log, self.log is not None and not self._is_own(ray)
        if others:
            log.asked.append(ray.direction)
            log.loops = log.loops or self._goes_on(ray)
        own = getattr(ray.origin, "face", None)
        least = self._least if own is None else 0.0
        found = self._faces.nearest(ray.origin.plain, ray.direction.plain, least, own)
        if found is None:
            return None
        t, face = found
        primitive = int(self._faces.primitive[face])
        n, p = self._faces.n[:, face], Point(ray.origin + ray.direction * t, face)
        front = float(n @ ray.direction.plain) < 0.0
        Le = self._faces.Le[:, face] if front else np.zeros(3)
        emission = named("Le", Le, hit=True) if Le.any() else Value(np.zeros(3), ())
        material = self._materials[self.scene.bsdf_of[primitive]]
        hit = Hit(p, Vector(*n), t, material, emission, primitive, front)
        if others:
            log.met.append((ray, hit))
        elif log is not None and log.hit is None:
            log.hit = hit
        return hit

    def _is_own(self, ray):
        """Whether a ray is that of the call under way: itself, or the first made of the same numbers."""
        own = self.log.ray
        return ray is own or (
            self.log.hit is None
            and _apart(ray.origin, own.origin) == 0.0
            and _apart(ray.direction, own.direction) < _SAME
        )

    def _goes_on(self, ray):
        """Whether a ray leaves, in another direction, a point that another ray of the same call met."""
        log, near = self.log, _NEAR * self._size
        if log.hit is None:
            return False
        near = min(near, _apart(ray.origin, log.hit.p))
        return any(
            _apart(ray.origin, hit.p) < near and _apart(ray.direction, before.direction) > _TURNED
            for before, hit in log.met
        )

    def sample_light(self):
        """A LightSample, uniform over the area of all lamps together."""
        face, p = self._faces.lamp_point(self.draw(), self.draw(), self.draw())
        primitive = int(self._faces.primitive[face])
        sample = LightSample(Vector(*p), Vector(*self._faces.n[:, face]), None, None, None, primitive)
        sample.emission = named("Le", self._faces.Le[:, face], light=sample)
        sample.pdf = named("pdf_area", 1.0 / self._faces.lamp_area, light=sample)
        sample.material = self._materials[self.scene.bsdf_of[primitive]]
        if self.log is not None:
            self.log.lights.append(sample)
        return sample


def _apart(a, b):
    """How far two vectors are apart."""
    return math.dist((a.x, a.y, a.z), (b.x, b.y, b.z))


class _Faces:
    """All parallelograms and triangles of a scene in one table."""

    def __init__(self, scene):
        corners, one, two, whole, primitive, Le = [], [], [], [], [], []
        for first, surface in zip(scene.first, scene.definition.surfaces, strict=True):
            shape = surface.shape
            if hasattr(shape, "parallelograms"):
                corner, e1, e2 = shape.parallelograms()
                whole.append(np.ones(shape.primitives, bool))
            else:
                vertices, faces = shape.triangles()
                corner, b, c = (vertices[faces[:, k]].T for k in range(3))
                e1, e2 = b - corner, c - corner
                whole.append(np.zeros(shape.primitives, bool))
            for column, part in zip((corners, one, two), (corner, e1, e2), strict=True):
                column.append(part)
            primitive.append(first + np.arange(shape.primitives))
            radiance = np.zeros(3) if surface.radiance is None else surface.radiance
            Le.append(np.tile(np.asarray(radiance, np.float64)[:, None], shape.primitives))
        self.corner, self.e1, self.e2, self.Le = (np.concatenate(a, axis=1) for a in (corners, one, two, Le))
        self.whole, self.primitive = np.concatenate(whole), np.concatenate(primitive)
        planes = np.concatenate([s.shape.planes()[0] for s in scene.definition.surfaces], axis=1)
        self.n = planes / np.linalg.norm(planes, axis=0)
        self.c = (self.n * self.corner).sum(axis=0)
        across = np.cross(self.e1.T, self.e2.T).T
        size = (across * across).sum(axis=0)
        self.dual1 = np.cross(self.e2.T, across.T).T / size
        self.dual2 = np.cross(across.T, self.e1.T).T / size
        self._three = np.concatenate((self.n, self.dual1, self.dual2), axis=1)
        self._begin1, self._begin2 = (
            (self.corner * self.dual1).sum(axis=0),
            (self.corner * self.dual2).sum(axis=0),
        )
        area = np.sqrt(size) * np.where(self.whole, 1.0, 0.5) * self.Le.any(axis=0)
        self.lamp_area = float(area.sum())
        self._share = np.cumsum(area) / max(self.lamp_area, np.finfo(float).tiny)

    def nearest(self, o, d, least, own=None):
        """Distance to the nearest face beyond `least`, and its number; None if there is none. own: the face
        that the ray starts on, which it does not meet."""
        with np.errstate(all="ignore"):
            along, across = o @ self._three, d @ self._three  # products with n, dual1 and dual2, (3 F,)
            f = self.c.size
            t = (self.c - along[:f]) / across[:f]
            a = along[f : 2 * f] + t * across[f : 2 * f] - self._begin1
            b = along[2 * f :] + t * across[2 * f :] - self._begin2
            within = np.where(self.whole, np.maximum(a, b), a + b) <= 1.0
        t[~((np.minimum(a, b) >= 0.0) & within & (t > least))] = np.inf
        if own is not None:
            t[own] = np.inf
        face = int(np.argmin(t))
        return None if np.isinf(t[face]) else (float(t[face]), face)

    def lamp_point(self, pick, u, v):
        """A face among the lamps', and a point on it, uniform over their area."""
        face = min(int(np.searchsorted(self._share, pick, side="right")), self._share.size - 1)
        if not self.whole[face] and u + v > 1.0:
            u, v = 1.0 - u, 1.0 - v
        return face, self.corner[:, face] + u * self.e1[:, face] + v * self.e2[:, face]
