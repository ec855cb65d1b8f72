"""Smooth metal: a mirror whose reflectance depends on colour and angle."""

from dataclasses import dataclass

import numpy as np

from tracer import warp
from tracer.bsdf.metal import Metal
from tracer.bsdf.sample import Dirac, Sample
from tracer.events import LOBES


@dataclass(frozen=True)
class Conductor(Dirac, Metal):
    """A Dirac lobe in the mirror direction with the Fresnel reflectance of eta + i k.

    A perfect mirror is written as k = inf.
    """

    eta: np.ndarray  # (3, M) real part of the index
    k: np.ndarray  # (3, M) imaginary part; inf for a perfect mirror
    specular_reflectance: np.ndarray  # (3, M) factor on top, 1 for a real metal
    fresnel: str = "exact"  # or "schlick"

    def explain(self, wo, wi):
        """F (3, N)."""
        return {"F": self.reflectance_at(np.clip(wo[2], 0.0, 1.0))}

    def sample(self, wo, u):
        """The mirror direction, with probability 1."""
        n = wo.shape[1]
        above = wo[2] > 0.0
        f = self.reflectance_at(np.clip(wo[2], 0.0, 1.0)) * above
        lobe = np.broadcast_to(np.int8(LOBES.index("reflection")), n)
        pdf = above.astype(wo.dtype)
        return Sample(warp.reflect(wo), f, pdf, np.broadcast_to(True, n), lobe)
