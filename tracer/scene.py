"""Shapes, materials and lights as one thing that rays can be asked of."""

from functools import cached_property
from typing import NamedTuple

import numpy as np

from tracer.bsdf.table import BsdfTable
from tracer.frame import Frame, dot
from tracer.lanes import gather
from tracer.light.faces import shining_faces
from tracer.light.sample import DELTA, Ball, luminance
from tracer.light.table import Lights
from tracer.resolution import refusal
from tracer.settings import TracerError
from tracer.shape import end, start
from tracer.shape.arrange import arrange
from tracer.shape.chart import Charts
from tracer.shape.meeting import Meeting
from tracer.shape.rays import Rays, leave
from tracer.shape.surfaces import Surfaces


class Hit(NamedTuple):
    """Where rays meet surfaces, one column per lane."""

    p: np.ndarray  # (3, N) point, put onto its surface
    t: np.ndarray  # (N,) distance along the ray
    primitive: np.ndarray  # (N,) number of the flat face or sphere
    ng: np.ndarray  # (3, N) geometric normal
    n: np.ndarray  # (3, N) shading normal
    wo: np.ndarray  # (3, N) direction back along the ray
    front: np.ndarray  # (N,) whether the ray came from the side of ng
    bsdf: np.ndarray  # (N,) number of the material
    light: np.ndarray  # (N,) number of the light, -1 for none
    bound: np.ndarray  # (N,) how far p may be off its surface, along ng
    texture: np.ndarray | None = None  # (K, 3, N) what textures say there; None where no material has any

    def take(self, lanes):
        """The hits of some lanes."""
        return Hit(*(None if column is None else gather(column, lanes) for column in self))


class Scene:
    """A definition made ready for one precision and one way of sampling.

    `at` gives the scene for other settings.
    """

    def __init__(
        self, definition, dtype=np.float32, hemisphere="cosine", light_sampling="solid_angle", accel="bvh"
    ):
        self.definition, self.dtype = definition, dtype
        self.hemisphere, self.light_sampling, self.accel = hemisphere, light_sampling, accel
        self.name, self.camera = definition.name, definition.camera
        self.width, self.height = definition.width, definition.height
        self.shapes = tuple(s.shape for s in definition.surfaces)
        counts = [shape.primitives for shape in self.shapes]
        self.first = np.concatenate(([0], np.cumsum(counts)[:-1])).astype(np.int32)
        self.shape_of = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
        self.bsdf_names = tuple(definition.bsdfs)
        of_shape = np.array([self.bsdf_names.index(s.bsdf) for s in definition.surfaces], np.int32)
        self.bsdf_of = of_shape[self.shape_of]
        painted = [definition.textures.get(name, {}) for name in self.bsdf_names]
        self.bsdf = BsdfTable(tuple(definition.bsdfs.values()), dtype, hemisphere, painted)
        media = definition.media
        self.media = media and media.of_primitives(self.shape_of, dtype)  # None: light loses nothing anywhere
        self._prepare_surfaces()
        self._prepare_lights()
        self._others = {}

    def at(self, settings):
        """The same scene for these settings' precision and ways of sampling.

        TracerError if that precision cannot hold it: where it is too far from the origin for its size.
        """
        wanted = settings.dtype, settings.hemisphere, settings.light_sampling, settings.accel
        ready = self
        if wanted != (self.dtype, self.hemisphere, self.light_sampling, self.accel):
            if wanted not in self._others:
                self._others[wanted] = Scene(self.definition, *wanted)
            ready = self._others[wanted]
        if ready._refusal:
            raise TracerError(ready._refusal)
        return ready

    @cached_property
    def _refusal(self):
        return refusal(self.definition, self.dtype)

    def _prepare_surfaces(self):
        self.faces = start.Faces.of(self.shapes, self.dtype)  # what the definition says of every primitive
        self._surfaces = Surfaces(self.shapes, self.first, self.faces, self.dtype)
        self.extent = max(  # the largest coordinate a ray starts at
            np.abs(self.bounds()).max(), np.abs(self.camera.origin).max() + self.camera.aperture_radius
        )
        materials = [self.definition.bsdfs[surface.bsdf] for surface in self.definition.surfaces]
        self.arrangement = arrange(
            self.shapes,
            self.first,
            [material.one_sided and not material.see_through for material in materials],
            [surface.radiance is not None for surface in self.definition.surfaces],
            bool(self.definition.emitters),
            self.extent,
            self.faces,
            self.dtype,
            self.accel,
        )

    def _prepare_lights(self):
        shining = [
            k for k, s in enumerate(self.definition.surfaces) if s.radiance is not None and s.radiance.any()
        ]
        ball = Ball.around(*self.bounds())
        others = tuple(e for e in self.definition.emitters if luminance(e.power(ball)) > 0.0)
        self.light_names = tuple(self.shapes[k].name for k in shining) + tuple(e.name for e in others)
        self.unmeetable = tuple(e.name for e in others if e.technique == DELTA)
        light_of_shape = np.full(len(self.shapes), -1, np.int32)
        light_of_shape[shining] = np.arange(len(shining))
        self.light_of = light_of_shape[self.shape_of]
        self.lights = None
        if self.light_names:
            faces = [
                face
                for light, k in enumerate(shining)
                for face in shining_faces(light, self.shapes[k], int(self.first[k]))
            ]
            radiance = np.zeros((3, len(shining)))
            for light, k in enumerate(shining):
                radiance[:, light] = self.definition.surfaces[k].radiance
            self.lights = Lights(faces, radiance, others, ball, self.dtype, self.light_sampling)
        beside = end.beside(self.faces, self.shape_of, shining)
        self._meeting = Meeting(self.arrangement, self.faces, beside, self.dtype)

    def intersect(self, o, d, source):
        """Nearest hit of rays from o (3, N) along unit d (3, N), which start on primitive `source` (N,).

        Returns (t (N,), inf where nothing is hit; primitive (N,), -1 there).
        """
        return self._meeting.closest(Rays.towards(o, d, source, touched=[]))

    def started(self, o, d, source):
        """Where rays that `intersect` is asked of start in the end, (3, N): off other faces they touch."""
        return self._meeting.started(o, d, source)

    def hit(self, o, d, t, primitive):
        """Everything about the points o + t d, all of which lie on a primitive."""
        p, ng, bound = self._surfaces.project(o + t * d, primitive)
        wo = -d
        n = self._surfaces.shading_normals(p, ng, wo, primitive)
        bsdf, light = gather(self.bsdf_of, primitive), gather(self.light_of, primitive)
        texture = self.painted(p, primitive)
        return Hit(p, t, primitive, ng, n, wo, dot(ng, wo) > 0.0, bsdf, light, bound, texture)

    @property
    def has_smooth_normals(self):
        """Whether any shape is shaded by other normals than its own."""
        return self._surfaces.smooth

    def bound(self, p, n, primitive):
        """How far points (3, N) may lie off their primitives, along normals n (3, N), in metres, (N,)."""
        return self._surfaces.bound(p, n, primitive)

    def spawn(self, hit, wi):
        """Where a ray that leaves a hit along wi (3, N) starts, (3, N)."""
        return leave(hit.p, hit.ng, hit.bound, wi)

    def shining(self, hit):
        """Which of the hits are on the bright side of a lamp: their places (K,)."""
        return np.flatnonzero((hit.light >= 0) & hit.front)

    def emission(self, hit, vertex, lit):
        """Radiance (3, K) that the hits at places `lit` (K,), all on lamps, send along wo, and the density
        (K,) in sr^-1 with which light sampling from the vertices (3, N) where the rays came from would have
        found it."""
        if not lit.size:
            return hit.p[:, lit], hit.t[lit]
        area = self.lights.area
        Le = gather(area.radiance, gather(hit.light, lit))
        return Le, area.pdf(gather(hit.primitive, lit), *(gather(v, lit) for v in (vertex, hit.p, hit.ng)))

    def environment(self, d):
        """Radiance (3, N) that comes from outside the scene against d (3, N), and the density (N,) in sr^-1
        with which light sampling would have given d; None if nothing does."""
        return self.lights.environment(d) if self.lights is not None and self.lights.surround else None

    def sample_light(self, p, u):
        """A point on a light for each receiver p (3, N), from u (3, N), as a LightSample."""
        return self.lights.sample(p, u)

    def occluded(self, hit, light):
        """Whether anything lies between each hit and its point on a light, (N,)."""
        rays, distance, hidden = self._between(
            hit.p, hit.ng, hit.bound, hit.primitive, light.q, light.nq, light.primitive, light.wi
        )
        blocked = self._meeting.blocked(rays, distance)
        return blocked if hidden is False else blocked | hidden

    def blocker(self, vertex, event):
        """First shape (N,) between the hits and light points of recorded events, -1 for none, and its
        distance, inf for none. vertex, event: columns of a HIT and a LIGHT."""
        p, n, source = (vertex[name] for name in ("p", "ng", "primitive"))
        light = (event[name] for name in ("q", "nq", "primitive", "wi"))
        rays, distance, hidden = self._between(p, n, self.bound(p, n, source), source, *light)
        t, primitive = self._meeting.closest(rays, distance)
        t, primitive = np.where(hidden, 0.0, t), np.where(hidden, rays.source, primitive)
        could_shine = (event["f"].max(axis=0) > 0.0) & (event["Le"].max(axis=0) > 0.0)
        blocked = (t < distance) & (primitive >= 0) & could_shine & ~event["visible"]
        return np.where(blocked, self.shape_of[primitive], -1), np.where(blocked, t, np.inf)

    def _between(self, p, n, bound, source, q, nq, target, wi):
        """Rays from p to q, both moved off their surfaces towards each other, their lengths (N,), and whether
        the face they start on hides an end that had to be moved, (N,)."""
        o, goal = leave(p, n, bound, wi), leave(q, nq, self.bound(q, nq, target), -wi)
        return self._meeting.between(o, goal, n, source, target, wi)

    def frame(self, n, p, primitive):
        """The local frames at points (3, N) with shading normals n: the surface's u runs along s where the
        material can tell, and any frame will do where not."""
        frame = Frame.around(n)
        if not self.bsdf.any_anisotropic:
            return frame
        lanes = np.flatnonzero(self.bsdf.is_anisotropic(gather(self.bsdf_of, primitive)))
        tangent = self._charts.tangent(gather(p, lanes), primitive[lanes])
        return frame.with_lanes(lanes, lambda n: Frame.along(n, tangent))

    def painted(self, p, primitive):
        """What the textures say at points (3, N), as BsdfTable takes it; None where there are none."""
        if not self.bsdf.any_textured:
            return None
        return self.bsdf.painted(gather(self.bsdf_of, primitive), p, primitive, self.uv)

    def uv(self, p, primitive):
        """Coordinates (2, N) of points on their primitives."""
        return self._charts.uv(p, primitive)

    @cached_property
    def _charts(self):
        return Charts(self.shapes, self.first, self.dtype)

    @cached_property
    def has_lights(self):
        """Whether anything in the scene shines."""
        return self.lights is not None

    def bounds(self):
        """Corners (low (3,), high (3,)) of the box that holds everything."""
        vertices = np.concatenate([shape.triangles()[0] for shape in self.shapes])
        return vertices.min(axis=0), vertices.max(axis=0)

    def display_colour(self, shape):
        """Linear colour (3,) that stands for a shape in drawings; what fills it counts with its thickness."""
        surface = self.definition.surfaces[shape]
        colour = np.clip(self.definition.bsdfs[surface.bsdf].display_colour()[:, 0], 0.0, 1.0)
        if surface.interior is None:
            return colour
        return colour * np.exp(-surface.interior * np.ptp(surface.shape.triangles()[0], axis=0).min())

    def is_light(self, shape):
        """Whether a shape shines."""
        return self.shapes[shape].name in self.light_names

    def is_see_through(self, shape):
        """Whether light passes through a shape."""
        return self.definition.bsdfs[self.definition.surfaces[shape].bsdf].see_through
