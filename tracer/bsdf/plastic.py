"""A diffuse base under a smooth clear coat: a mirror lobe and a diffuse lobe in one material."""

from dataclasses import dataclass

import numpy as np

from tracer import warp
from tracer.bsdf import fresnel
from tracer.bsdf.coat import Coated
from tracer.bsdf.sample import Sample
from tracer.events import LOBES


@dataclass(frozen=True)
class Plastic(Coated):
    """A Dirac lobe of Fresnel's reflectance F, and what gets through the coat, is scattered and gets out:

        f = (1 - F(wo)) (1 - F(wi)) rho / (pi eta^2 (1 - rho F_in))

    F_in is the share of diffuse light that the coat sends back down. With `nonlinear` off, colours do not
    deepen by going round: the denominator takes rho = 1 (the words are Mitsuba's).
    """

    eta: np.ndarray  # (M,) index of the coat over index outside
    inside: np.ndarray  # (M,) F_in, from coated()
    diffuse_reflectance: np.ndarray  # (3, M) albedo rho of the base
    specular_reflectance: np.ndarray  # (3, M) factor on the mirror lobe, 1 for a real coat
    nonlinear: bool = False
    fresnel: str = "exact"  # or "schlick"

    @classmethod
    def coated(cls, eta, diffuse_reflectance, specular_reflectance, nonlinear=False, formula="exact"):
        """The material, with F_in = 1 - (1 - F_out) / eta^2 from the diffuse average outside."""
        inside = 1.0 - (1.0 - fresnel.diffuse_average(eta, formula)) / (eta * eta)
        return cls(eta, inside, diffuse_reflectance, specular_reflectance, nonlinear, formula)

    def explain(self, wo, wi):
        """F of the coat."""
        return {"F": self.reflectance_at(wo[2])}

    def _mirror_chance(self, F):
        """Probability (N,) of the mirror lobe: its share of the largest channel's light."""
        mirror = F * self.specular_reflectance.max(axis=0)
        # (1 - F) averages to (1 - F_in) eta^2 over the hemisphere
        base = (1.0 - F) * (self._base() * (1.0 - self.inside) * self.eta * self.eta).max(axis=0)
        whole = mirror + base
        return np.where(whole > 0.0, mirror / np.where(whole > 0.0, whole, 1.0), 0.0)

    def eval(self, wo, wi):
        """The diffuse part, where both directions are above the surface."""
        above = (wo[2] > 0.0) & (wi[2] > 0.0)
        through = (1.0 - self.reflectance_at(wo[2])) * (1.0 - self.reflectance_at(wi[2]))
        return self._base() * (through * warp.INV_PI * above)

    def pdf(self, wo, wi):
        """cos/pi, times the probability of not choosing the mirror lobe."""
        chance = self._mirror_chance(self.reflectance_at(wo[2]))
        return (1.0 - chance) * warp.cosine_hemisphere_pdf(wi) * (wo[2] > 0.0)

    def sample(self, wo, u):
        """The mirror direction, or a cosine-weighted one."""
        F, above = self.reflectance_at(wo[2]), wo[2] > 0.0
        chance = self._mirror_chance(F)
        mirrored = u[0] < chance
        wi = np.where(mirrored, warp.reflect(wo), warp.cosine_hemisphere(u[1:]))
        f = np.where(mirrored, F * self.specular_reflectance * above, self.eval(wo, wi))
        pdf = np.where(mirrored, chance * above, self.pdf(wo, wi))
        lobe = np.where(mirrored, np.int8(LOBES.index("reflection")), np.int8(LOBES.index("diffuse")))
        return Sample(wi, f, pdf, mirrored, lobe)
