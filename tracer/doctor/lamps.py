"""What light sampling has to be: the chance of each lamp, and the density of each direction."""

from dataclasses import replace
from functools import cached_property

import numpy as np

from tracer.doctor.compare import judged
from tracer.frame import dot
from tracer.light import choice
from tracer.light.sample import DELTA, Ball, luminance

_SMALL = 1e-4  # sr: seen so small a lamp may be sampled by its area where it should be by its solid angle


class Lamps:
    """The lights of a scene in float64, by both ways of sampling."""

    def __init__(self, scene, settings, brute):
        self.scene, self.settings, self.brute = scene, settings, brute
        self.said = None  # the program's own probability of each light, (L,)
        self.by_area = scene.at(replace(settings, precision=64, light_sampling="area", accel="bvh"))

    @property
    def pick(self):
        """Probability of each light, (L,)."""
        return self.by_power if self.said is None else self.said

    @cached_property
    def by_power(self):
        """Probability of each light, (L,): by the luminance of its power."""
        definition = self.scene.definition
        power = {}
        for surface in definition.surfaces:
            if surface.radiance is not None:
                power[surface.shape.name] = luminance(surface.radiance) * surface.shape.area().sum() * np.pi
        ball = Ball.around(*self.scene.bounds())
        for emitter in definition.emitters:
            power[emitter.name] = luminance(emitter.power(ball))
        found = np.array([power[name] for name in self.scene.light_names])
        return found / found.sum()

    def listen(self, light, pick, eps):
        """Take over the probabilities with which light samples (E,) say that lamps were chosen: by power, by
        area or all alike, any of it is in order."""
        self.said = choice.said(light, pick, self.by_power, eps)

    @cached_property
    def is_delta(self):
        """Whether each light has no extent, (L,)."""
        without = [e.name for e in self.scene.definition.emitters if e.technique == DELTA]
        return np.array([name in without for name in self.scene.light_names])

    def delta(self, light, p):
        """What a light without extent sends to points p (3, N): (wi, distance, irradiance)."""
        (emitter,) = [e for e in self.scene.definition.emitters if e.name == self.scene.light_names[light]]
        ready = emitter.ready(np.float64, Ball.around(*self.scene.bounds()))
        _, _, wi, distance, brought, _ = ready.sample(p, np.zeros((2, p.shape[1])))
        return wi, distance, brought

    def density(self, p, q, primitive, area=False):
        """Density (N,) in sr^-1, choice of the lamp included, with which light sampling at p (3, N) gives the
        direction to q (3, N) on lamps' primitives (N,); area: by area whatever the settings say."""
        scene = self.by_area if area else self.scene
        found = scene.lights.area.pdf(primitive, p, q, self.brute.normals(q, primitive))
        return self._as_said(found, self.scene.light_of.take(primitive))

    def surrounding(self, d):
        """Density (N,) in sr^-1, choice of the light included, with which light samples go in directions
        d (3, N) of the environment."""
        return self._as_said(self.scene.environment(d)[1], self.scene.lights.surrounding)

    def _as_said(self, density, light):
        """Densities (N,) of light samples with the program's own probabilities of the lights (N,)."""
        return density if self.said is None else density * (self.said / self.by_power)[light]

    def hidden(self, p, primitive, room):
        """Whether lamps are spheres that are dark from p (3, N): an outward one from inside, an inward one
        from outside; and whether p is within `room` of it, (N,) both."""
        brute = self.brute
        if not brute.sphere.size:
            return np.zeros(primitive.shape, bool), np.zeros(primitive.shape, bool)
        k = np.where(brute.is_sphere.take(primitive), brute.column.take(primitive), 0)
        out = p - brute.center[:, k]
        height = np.sqrt(dot(out, out)) - brute.radius[k]
        ball = brute.is_sphere.take(primitive)
        return ball & ((brute.side[k] > 0.0) == (height <= 0.0)), ball & (np.abs(height) <= room)

    def either(self, evidence, kind, rows, recorded, value, inputs, what="pdf_light", sound=None):
        """The Outcome of a density: where a lamp looks so small that either way of sampling is in order, of
        that which is nearer."""
        o, p, primitive = (inputs[name][0] for name in ("o", "p", "primitive"))
        # What lies in a lamp's plane but for rounding sees nothing of it: there rounding decides.
        height = np.abs(dot(self.brute.normals(p, primitive), o - p))
        clear = height > 4.0 * evidence.off_point + 64.0 * evidence.eps * self.brute.reach.take(primitive)
        sound = clear if sound is None else sound & clear
        outcome = judged(evidence, kind, rows, recorded, value, inputs, what, sound)
        if evidence.settings.light_sampling == "area" or not outcome.wrong.any():
            return outcome
        lanes = np.flatnonzero(outcome.wrong)
        some = {name: array[..., lanes] for name, (array, _) in inputs.items()}
        other = self.density(some["o"], some["p"], some["primitive"], area=True)
        pick = self.pick.take(evidence.scene.light_of.take(some["primitive"]))
        tiny = pick / other < _SMALL
        good = tiny & (np.abs(recorded[lanes] - other) <= 0.02 * other)
        wrong = outcome.wrong.copy()
        wrong[lanes[good]] = False
        return replace(outcome, wrong=wrong)
