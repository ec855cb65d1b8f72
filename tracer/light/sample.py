"""What a light hands to a receiver, whatever kind of light it is."""

from typing import NamedTuple

import numpy as np

from tracer.events import TECHNIQUES
from tracer.frame import dot
from tracer.lanes import gather

# Codes of the event field `technique`.
AREA, SOLID_ANGLE, CONE, DELTA, IMAGE = (
    np.int8(TECHNIQUES.index(t)) for t in ("area", "solid_angle", "cone", "delta", "image")
)
_LUMINANCE = np.array([0.212671, 0.715160, 0.072169])  # of linear sRGB primaries (ITU-R BT.709)


def luminance(rgb):
    """Luminance (...) of linear colours (3, ...)."""
    return _LUMINANCE[0] * rgb[0] + _LUMINANCE[1] * rgb[1] + _LUMINANCE[2] * rgb[2]


class Ball(NamedTuple):
    """A sphere that holds the whole scene."""

    center: np.ndarray  # (3,)
    radius: float

    @classmethod
    def around(cls, low, high):
        """The ball around a box from low (3,) to high (3,)."""
        return cls(0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low)))

    def astype(self, dtype):
        """The same in one precision."""
        return Ball(self.center.astype(dtype), dtype(self.radius))


def far_side(p, ball):
    """A distance (N,) from points p (3, N) at which every direction has left the scene's ball."""
    out = p - ball.center[:, None]
    return 2.0 * np.maximum(ball.radius, np.sqrt(dot(out, out)))


class LightSample(NamedTuple):
    """One point on a light per lane, as seen from the receiver."""

    light: np.ndarray  # (N,) number of the light
    primitive: np.ndarray  # (N,) number of the primitive q lies on, -1 if on none
    pick: np.ndarray  # (N,) probability of choosing the light
    technique: np.ndarray  # (N,) index into events.TECHNIQUES
    q: np.ndarray  # (3, N) point on the light
    nq: np.ndarray  # (3, N) normal there
    wi: np.ndarray  # (3, N) unit direction to q
    distance: np.ndarray  # (N,)
    Le: np.ndarray  # (3, N) radiance back along wi, 0 behind the light; of a DELTA light the irradiance
    pdf: np.ndarray  # (N,) density of wi in sr^-1, choice of the light included, 0 behind the light; of a
    # DELTA light only the probability of the choice

    def take(self, lanes):
        """The samples of some lanes."""
        return LightSample(*(gather(column, lanes) for column in self))
