"""A lamp without size: it shines alike in all directions."""

from dataclasses import dataclass, replace

import numpy as np

from tracer.frame import dot
from tracer.light.sample import DELTA


@dataclass(frozen=True)
class Point:
    """Mitsuba's `point`: position in metres, intensity in W/sr."""

    name: str
    position: np.ndarray  # (3,)
    intensity: np.ndarray  # (3,)

    technique = DELTA

    @property
    def light(self):
        """What it sends, (3,): its intensity."""
        return self.intensity

    def power(self, ball):
        """4 pi I, (3,) in W."""
        return 4.0 * np.pi * self.intensity

    def ready(self, dtype, ball):
        """The same in one precision."""
        return replace(self, position=self.position.astype(dtype), intensity=self.intensity.astype(dtype))

    def sample(self, p, u):
        """q, normal, wi (3, N), distance (N,), I / distance^2 (3, N), and 1: there is no choice."""
        to_light = self.position[:, None] - p
        square = dot(to_light, to_light)
        distance = np.sqrt(square)
        wi = to_light / distance
        q = np.broadcast_to(self.position[:, None], p.shape)
        brought = np.where(square > 0.0, self.intensity[:, None] / square, 0.0)
        return q, -wi, wi, distance, brought, np.ones_like(distance)
