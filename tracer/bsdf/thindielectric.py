"""A pane so thin that both its faces are one surface: light goes straight through or is mirrored."""

from dataclasses import dataclass

import numpy as np

from tracer import warp
from tracer.bsdf import fresnel
from tracer.bsdf.glass import Glass
from tracer.bsdf.sample import Dirac, Sample
from tracer.events import LOBES


@dataclass(frozen=True)
class ThinDielectric(Dirac, Glass):
    """Two Dirac lobes: the sum over all bounces between the faces is R' = 2 R / (1 + R), T' = 1 - R'.

    R is Fresnel's reflectance of one face. Nothing changes its speed for good, so no radiance is scaled.
    """

    eta: np.ndarray  # (M,) index of the pane over index around it
    specular_reflectance: np.ndarray  # (3, M) factor on the reflected light, 1 for real glass
    specular_transmittance: np.ndarray  # (3, M) factor on the transmitted light, 1 for clear glass
    fresnel: str = "exact"  # or "schlick"

    thin = True

    @property
    def vanishes(self):
        """Whether nobody can see the pane: of the index of what is around it, and without colour."""
        return bool((self.eta == 1.0).all() and (self.specular_transmittance == 1.0).all())

    def reflectance_at(self, cos):
        """Share (N,) that both faces together mirror, for the (signed) cosine of wo."""
        eta = np.broadcast_to(self.eta, cos.shape)
        one, _ = fresnel.dielectric_mean(np.minimum(np.abs(cos), 1.0), eta, self.fresnel)
        return 2.0 * one / (1.0 + one)

    def explain(self, wo, wi):
        """F of the whole pane."""
        return {"F": self.reflectance_at(wo[2])}

    def sample(self, wo, u):
        """The mirror direction with probability R', straight on with T'."""
        share = self.reflectance_at(wo[2]).astype(wo.dtype)
        mirrored = u[0] < share
        pdf = np.where(mirrored, share, 1.0 - share)
        f = pdf * np.where(mirrored, self.specular_reflectance, self.specular_transmittance)
        wi = np.where(mirrored, warp.reflect(wo), -wo)
        lobe = np.where(mirrored, np.int8(LOBES.index("reflection")), np.int8(LOBES.index("transmission")))
        return Sample(wi, f, pdf, np.broadcast_to(True, wo.shape[1]), lobe)
