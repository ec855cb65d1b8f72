"""All lights of a scene as one: which is sampled is decided by power."""

import numpy as np

from tracer.light.area import AreaLights

_LUMINANCE = np.array([0.212671, 0.715160, 0.072169])  # of linear sRGB primaries (ITU-R BT.709)


class Lights:
    """Lights by number: the shining shapes in the order of their `faces`.

    faces: tuple of area.ShiningFace. radiance: (3, L) of each shining shape. The probability of a light is
    proportional to the luminance of its power, that of its faces to their areas.
    """

    def __init__(self, faces, radiance, dtype, light_sampling):
        light, area = (np.array([getattr(f, name) for f in faces]) for name in ("light", "area"))
        total = np.bincount(light, area, radiance.shape[1])
        power = _LUMINANCE @ radiance * total
        pick = power / power.sum()
        chance = pick[light] * area / total[light]
        cdf = np.cumsum(chance)
        self._cdf = (cdf / cdf[-1])[:-1].astype(dtype)
        self.area = AreaLights(faces, chance, radiance, pick, dtype, light_sampling)

    def sample(self, p, u):
        """A point on a light for each receiver p (3, N), from u (3, N), as a LightSample."""
        if self._cdf.size == 0:
            entry = np.zeros(p.shape[1], np.int32)
        else:
            entry = np.searchsorted(self._cdf, u[0], side="right").astype(np.int32)
        return self.area.sample(p, u[1:], entry)
