"""A sky that shines alike from everywhere."""

from dataclasses import dataclass, replace

import numpy as np

from tracer import warp
from tracer.light.sample import SOLID_ANGLE, far_side


@dataclass(frozen=True)
class Constant:
    """Mitsuba's `constant`: the radiance of every direction."""

    name: str
    colour: np.ndarray  # (3,) W/m^2/sr
    ball: object = None

    technique = SOLID_ANGLE

    @property
    def light(self):
        """What it sends, (3,): its radiance."""
        return self.colour

    def power(self, ball):
        """What enters the scene's ball, (3,) in W."""
        return np.pi * self.colour * (4.0 * np.pi * ball.radius**2)

    def ready(self, dtype, ball):
        """The same in one precision, for a scene within `ball`."""
        return replace(self, colour=self.colour.astype(dtype), ball=ball.astype(dtype))

    def sample(self, p, u):
        """q, normal, wi (3, N), distance (N,), radiance (3, N), and the density of wi in sr^-1."""
        wi = warp.uniform_sphere(u)
        distance = far_side(p, self.ball)
        return p + wi * distance, -wi, wi, distance, self.radiance(wi), self.pdf(wi)

    def radiance(self, d):
        """Radiance (3, N) from directions d (3, N)."""
        return np.broadcast_to(self.colour[:, None], d.shape)

    def pdf(self, d):
        """1/(4 pi)."""
        return warp.uniform_sphere_pdf(d)
