"""A lamp so far away that its light falls in from one direction everywhere, like the sun's."""

from dataclasses import dataclass, replace

import numpy as np

from tracer.light.sample import DELTA, far_side


@dataclass(frozen=True)
class Directional:
    """Mitsuba's `directional`: where its light travels to, and the irradiance on a surface that faces it."""

    name: str
    direction: np.ndarray  # (3,) unit
    irradiance: np.ndarray  # (3,) W/m^2
    ball: object = None

    technique = DELTA

    @property
    def light(self):
        """What it sends, (3,): its irradiance."""
        return self.irradiance

    def power(self, ball):
        """What falls onto the disk that the scene's ball shows it, (3,) in W."""
        return np.pi * ball.radius**2 * self.irradiance

    def ready(self, dtype, ball):
        """The same in one precision, for a scene within `ball`."""
        direction, irradiance = self.direction.astype(dtype), self.irradiance.astype(dtype)
        return replace(self, direction=direction, irradiance=irradiance, ball=ball.astype(dtype))

    def sample(self, p, u):
        """q, normal, wi (3, N), distance (N,), irradiance (3, N), and 1: there is no choice."""
        wi = np.broadcast_to(-self.direction[:, None], p.shape)
        distance = far_side(p, self.ball)
        brought = np.broadcast_to(self.irradiance[:, None], p.shape)
        return p + wi * distance, -wi, wi, distance, brought, np.ones_like(distance)
