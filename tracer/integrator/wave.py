"""A wave of paths: where they begin, what each carries along, and what they leave behind."""

from functools import partial
from typing import NamedTuple

import numpy as np

from tracer import sampler as samplers
from tracer.events import CAMERA, END, END_REASONS, ESCAPE
from tracer.integrator.steps import RIGHT
from tracer.lanes import gather, put

_REASON = {reason: np.int8(code) for code, reason in enumerate(END_REASONS)}


# Up to this share of a wave, paths that are over are carried along: to pick out the others costs more.
CARRIED = 0.1


class Paths(NamedTuple):
    """The paths still under way, one column per lane. Never written to: each stage makes new ones.

    A few may be over already (lane -1): nothing that happens to those is seen or counted.
    """

    lane: np.ndarray  # (N,) place in the wave
    pixel: np.ndarray  # (N,) packed pixel, for the sampler
    sample: np.ndarray  # (N,) number of the sample within its pixel
    depth: np.ndarray  # (N,) bounces so far: 0 until the first hit is left
    o: np.ndarray  # (3, N) origin of the ray
    d: np.ndarray  # (3, N) its unit direction
    vertex: np.ndarray  # (3, N) where it left from: o is that, moved off the surface
    source: np.ndarray  # (N,) primitive the ray starts on, -1 at the camera
    beta: np.ndarray  # (3, N) throughput
    pdf_bsdf: np.ndarray  # (N,) density of d in sr^-1; inf from the camera and after a Dirac lobe
    L: np.ndarray  # (3, N) radiance gathered so far
    # Only in scenes where something is filled:
    medium: np.ndarray | None = None  # (N,) number of the medium the ray travels in
    transmittance: np.ndarray | None = None  # (3, N) share of the light left after the last way

    def take(self, lanes):
        """The paths of some lanes."""
        return Paths(*(None if column is None else gather(column, lanes) for column in self))

    def gain(self, contribution, lanes=slice(None)):
        """The paths with radiance (3, K) added to those at places `lanes`, all of them unless said."""
        if isinstance(lanes, slice):
            return self._replace(L=self.L + contribution)
        if not lanes.size:
            return self
        L = self.L.copy()
        for channel, more in zip(L, contribution, strict=True):
            channel[lanes] += more
        return self._replace(L=L)


class Wave:
    """Pixels and samples to trace together, and the radiance they bring back.

    x, y: (N,) pixel; sample: (N,). steps: the named steps, right ones unless replaced.
    After the loop is exhausted: radiance (3, N) as it counts in the film, dropped (number of samples that
    were not finite and count as 0), rays (number of rays traced).
    """

    def __init__(self, x, y, sample, settings, steps=RIGHT):
        self.x, self.y = np.asarray(x), np.asarray(y)
        self.sample = np.asarray(sample).astype(np.uint32)
        self.settings, self.steps = settings, steps
        self.random = samplers.of(settings)
        if steps.random is not RIGHT.random:
            self.random = partial(steps.random, self.random)
        self.radiance = np.zeros((3, self.x.size), settings.dtype)
        self.dropped = 0
        self.rays = 0
        self._over = 0  # paths that are over and still carried along

    def begin(self, scene):
        """Yield the event of leaving the camera; return the paths there."""
        n, dtype = self.x.size, self.settings.dtype
        pixel, depth = samplers.pack_pixel(self.x, self.y), np.zeros(n, np.int32)
        jitter = dtype(0.5)
        if self.settings.jitter:
            jitter = self.random(pixel, self.sample, depth, "film")
        film = np.stack((self.x, self.y)).astype(dtype) + jitter
        lens = self.random(pixel, self.sample, depth, "lens") if scene.camera.aperture_radius else None
        o, d = self.steps.camera(scene, self.settings, film, lens)
        beta = np.ones((3, n), dtype)
        lane = np.arange(n, dtype=np.int32)
        yield CAMERA(lane, depth, film=film, o=o, d=d, beta=beta)
        paths = Paths(
            lane, pixel, self.sample, depth, o, d, o,
            np.full(n, -1, np.int32), beta, np.full(n, np.inf, dtype), np.zeros((3, n), dtype),
        )  # fmt: skip
        if scene.media is not None:
            paths = paths._replace(medium=np.full(n, scene.media.camera, np.int32))
        if self.settings.max_depth == 0:
            yield self.end(paths, lane, "max_depth")
            return paths.take(np.empty(0, np.intp))
        return paths

    def meet(self, scene, paths, strategy):
        """Yield the events of rays that meet nothing, with what the environment sends along them; return the
        other paths and their hits. strategy: how lights are found, for the weight."""
        t, primitive = self.steps.intersect(scene, paths.o, paths.d, paths.source)
        self.rays += self.count(paths.lane)
        met = primitive >= 0
        if self._over or not met.all():
            alive = paths.lane >= 0
            lost = np.flatnonzero(~met & alive)
            if lost.size:
                yield from self._escape(scene, paths, lost, strategy)
            lanes, self._over = np.flatnonzero(met & alive), 0
            paths, t, primitive = paths.take(lanes), gather(t, lanes), gather(primitive, lanes)
        if paths.medium is not None:
            left = self.steps.transmittance(scene, paths.medium, t)
            paths = paths._replace(beta=paths.beta * left, transmittance=left)
        return paths, self.steps.hit(scene, paths.o, paths.d, t, primitive)

    def _escape(self, scene, paths, lanes, strategy):
        """Yield the events of those paths (their places: lanes) that leave the scene, with the environment's
        light, and of their end."""
        lane, depth, d, L = (gather(column, lanes) for column in (paths.lane, paths.depth, paths.d, paths.L))
        w = pdf = np.zeros(lane.shape, L.dtype)
        Le = contribution = np.zeros_like(L)
        around = scene.environment(d)
        if around is not None:
            Le, pdf = around
            w = self.steps.emission_weight(self.settings, strategy, gather(paths.pdf_bsdf, lanes), pdf)
            contribution = gather(paths.beta, lanes) * Le * w
            L = L + contribution
        yield ESCAPE(lane, depth, d=d, Le=Le, pdf_light=pdf, w=w, contribution=contribution)
        yield self._end(lane, depth, L, "escaped")

    def stop(self, paths, over, reason, *columns):
        """Yield the end of the paths that are over, (N,) bool; return the others, and their columns."""
        if not over.any():
            return paths, *columns
        if self._over:
            over = over & (paths.lane >= 0)
        lanes = np.flatnonzero(over)
        if not lanes.size:
            return paths, *columns
        yield self.end(paths, lanes, reason)
        self._over += lanes.size
        if self._over <= CARRIED * over.size:
            lane = paths.lane.copy()
            lane[lanes] = -1
            return paths._replace(lane=lane), *columns
        going = np.flatnonzero(~over & (paths.lane >= 0))
        self._over = 0
        return paths.take(going), *(_take(column, going) for column in columns)

    def count(self, lane):
        """How many of the paths with these lanes are under way."""
        return int(np.count_nonzero(lane >= 0)) if self._over else lane.size

    def end(self, paths, lanes, reason):
        """The paths at these places are over: the event of their end."""
        return self._end(
            gather(paths.lane, lanes), gather(paths.depth, lanes), gather(paths.L, lanes), reason
        )

    def _end(self, lane, depth, L, reason):
        """Paths leave their radiance L (3, N); the event of their end.

        A path whose radiance is not finite counts as 0, is counted, and ends as "invalid".
        """
        counted = self.steps.film(L, self, lane)
        finite = np.isfinite(counted[0]) & np.isfinite(counted[1]) & np.isfinite(counted[2])
        reasons = np.full(lane.size, _REASON[reason])
        if not finite.all():
            self.dropped += int(np.count_nonzero(~finite))
            reasons[~finite] = _REASON["invalid"]
            counted = np.where(finite, counted, 0.0).astype(counted.dtype)
        put(self.radiance, lane, counted)
        return END(lane, depth, reason=reasons, radiance=counted)


def _take(column, lanes):
    """Some lanes of an array, or of a record of arrays."""
    return gather(column, lanes) if isinstance(column, np.ndarray) else column.take(lanes)
