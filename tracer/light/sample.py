"""What a light hands to a receiver, whatever kind of light it is."""

from typing import NamedTuple

import numpy as np

from tracer.events import TECHNIQUES

# Codes of the event field `technique`.
AREA, SOLID_ANGLE, CONE, DELTA = (
    np.int8(TECHNIQUES.index(t)) for t in ("area", "solid_angle", "cone", "delta")
)


class LightSample(NamedTuple):
    """One point on a light per lane, as seen from the receiver."""

    light: np.ndarray  # (N,) number of the light
    primitive: np.ndarray  # (N,) number of the primitive q lies on
    pick: np.ndarray  # (N,) probability of choosing the light
    technique: np.ndarray  # (N,) index into events.TECHNIQUES
    q: np.ndarray  # (3, N) point on the light
    nq: np.ndarray  # (3, N) normal there
    wi: np.ndarray  # (3, N) unit direction to q
    distance: np.ndarray  # (N,)
    Le: np.ndarray  # (3, N) radiance back along wi, 0 behind the light
    pdf: np.ndarray  # (N,) density of wi in sr^-1, choice of the light included; 0 behind the light

    def take(self, lanes):
        """The samples of some lanes."""
        return LightSample(*(column.take(lanes, axis=-1) for column in self))
