"""All lights of a scene as one: which is sampled is decided by power."""

import numpy as np

from tracer.lanes import gather
from tracer.light.area import AreaLights, scattered
from tracer.light.sample import DELTA, LightSample, luminance


class Lights:
    """Lights by number: the shining shapes, then the others.

    faces: tuple of area.ShiningFace. radiance: (3, L) of each shining shape. others: emitters that are no
    shapes, none of them without power. ball: the scene's. The probability of a light is proportional to the
    luminance of its power, that of its faces to their areas. surrounding: the number of the environment, None
    where there is none.
    """

    def __init__(self, faces, radiance, others, ball, dtype, light_sampling):
        light, area = (np.array([getattr(f, name) for f in faces]) for name in ("light", "area"))
        shapes = radiance.shape[1]
        total = np.bincount(light.astype(np.intp), area, shapes)
        elsewhere = [luminance(other.power(ball)) / np.pi for other in others]
        power = np.concatenate((luminance(radiance) * total, elsewhere))
        pick = power / power.sum()
        chance = pick[light.astype(np.intp)] * area / total[light.astype(np.intp)]
        cdf = np.cumsum(np.concatenate((chance, pick[shapes:])))
        self._cdf = (cdf / cdf[-1])[:-1].astype(dtype)
        self._faces, self._shapes, self._pick = len(faces), shapes, pick.astype(dtype)
        self.area = None
        if faces:
            self.area = AreaLights(faces, chance, radiance, pick[:shapes], dtype, light_sampling)
        self._others = [other.ready(dtype, ball) for other in others]
        self.any_delta = any(other.technique == DELTA for other in others)
        surrounding = [k for k, other in enumerate(others) if hasattr(other, "radiance")]
        self.surrounding = shapes + surrounding[0] if surrounding else None

    def sample(self, p, u):
        """A point on a light for each receiver p (3, N), from u (3, N), as a LightSample."""
        if self._cdf.size == 0:
            entry = np.zeros(p.shape[1], np.int32)
        else:
            entry = np.searchsorted(self._cdf, u[0], side="right").astype(np.int32)
        if not self._others:
            return self.area.sample(p, u[1:], entry)
        parts = []
        if self.area is not None:
            lanes = np.flatnonzero(entry < self._faces)
            parts.append((lanes, self.area.sample(gather(p, lanes), gather(u[1:], lanes), entry[lanes])))
        for k in range(len(self._others)):
            lanes = np.flatnonzero(entry == self._faces + k)
            if lanes.size or not parts:
                parts.append((lanes, self._elsewhere(k, gather(p, lanes), gather(u[1:], lanes))))
        return LightSample(*scattered(parts, entry.size))

    def _elsewhere(self, k, p, u):
        """A LightSample of one light that is no shape."""
        n, number, light = p.shape[1], self._shapes + k, self._others[k]
        q, nq, wi, distance, Le, pdf = light.sample(p, u)
        pick = self._pick[number]
        columns = (np.int32(number), np.int32(-1), pick, light.technique)
        return LightSample(*(np.broadcast_to(c, n) for c in columns), q, nq, wi, distance, Le, pdf * pick)

    @property
    def pick(self):
        """Probability of each light, (L,)."""
        return self._pick

    @property
    def cdf(self):
        """Where in [0, 1] one face or other light ends and the next begins, ascending."""
        return self._cdf

    def elsewhere(self):
        """The lights that are no shapes, each with its probability."""
        return list(zip(self._others, self._pick[self._shapes :], strict=True))

    @property
    def surround(self):
        """Whether rays that leave the scene find light."""
        return self.surrounding is not None

    def environment(self, d):
        """Radiance (3, N) of the environment in directions d (3, N), and the density (N,) in sr^-1 with which
        sample gives them, choice of the light included."""
        light = self._others[self.surrounding - self._shapes]
        return light.radiance(d), light.pdf(d) * self._pick[self.surrounding]
