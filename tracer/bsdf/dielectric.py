"""Smooth glass or water: reflects and refracts, chosen by the Fresnel reflectance."""

from dataclasses import dataclass

import numpy as np

from tracer.bsdf import fresnel
from tracer.bsdf.glass import Refracting
from tracer.bsdf.sample import Dirac, Sample
from tracer.events import LOBES


@dataclass(frozen=True)
class Dielectric(Dirac, Refracting):
    """Two Dirac lobes: F in the mirror direction, 1 - F in Snell's.

    What is transmitted is radiance, which grows by the square of the index it enters: seen along the path
    from the camera, f is (1 - F) divided by the square of the relative index.
    """

    eta: np.ndarray  # (M,) index behind the surface over index on the side of the normal
    specular_reflectance: np.ndarray  # (3, M) factor on the reflected light, 1 for real glass
    specular_transmittance: np.ndarray  # (3, M) factor on the transmitted light, 1 for clear glass
    fresnel: str = "exact"  # or "schlick"

    @property
    def vanishes(self):
        """Whether both sides have the same index and nothing is coloured: a surface nobody can see."""
        return bool((self.eta == 1.0).all() and (self.specular_transmittance == 1.0).all())

    def reflectance_at(self, cos):
        """Unpolarised reflectance (3, N) for the (signed) cosine of wo."""
        mean, _ = fresnel.dielectric_mean(np.minimum(np.abs(cos), 1.0), self.relative_eta(cos), self.fresnel)
        return mean * np.ones_like(self.specular_reflectance)

    def explain(self, wo, wi):
        """F (3, N), and the index across the surface as eta."""
        return {"F": self.reflectance_at(wo[2]), "eta": self.relative_eta(wo[2])}

    def sample(self, wo, u):
        """The mirror direction with probability F, Snell's with 1 - F."""
        eta = self.relative_eta(wo[2])
        reflectance, cos_t = fresnel.dielectric_mean(np.minimum(np.abs(wo[2]), 1.0), eta, self.fresnel)
        mirrored = u[0] < reflectance
        across = np.where(mirrored, -1.0, -1.0 / eta)
        up = np.where(mirrored, wo[2], -np.copysign(cos_t, wo[2]))
        wi = np.stack((across * wo[0], across * wo[1], up)).astype(wo.dtype)
        pdf = np.where(mirrored, reflectance, 1.0 - reflectance).astype(wo.dtype)
        f = np.where(
            mirrored,
            reflectance * self.specular_reflectance,
            (1.0 - reflectance) / (eta * eta) * self.specular_transmittance,
        ).astype(wo.dtype)
        lobe = np.where(mirrored, np.int8(LOBES.index("reflection")), np.int8(LOBES.index("transmission")))
        return Sample(wi, f, pdf, np.broadcast_to(True, wo.shape[1]), lobe)
