"""Lambertian reflection: equal radiance in every direction."""

from dataclasses import dataclass

import numpy as np

from tracer import warp
from tracer.bsdf.sample import Material, Sample
from tracer.events import LOBES


@dataclass(frozen=True)
class Diffuse(Material):
    """f = rho/pi above the surface, black below.

    hemisphere: "cosine" or "uniform", how sample chooses directions.
    """

    reflectance: np.ndarray  # (3, M) albedo rho
    hemisphere: str = "cosine"

    def albedo(self):
        """Largest share of light that is sent back, (3, M)."""
        return self.reflectance

    def display_colour(self):
        """Colour that stands for the material in drawings, (3, M)."""
        return self.reflectance

    def eval(self, wo, wi):
        """rho/pi where both directions are above the surface."""
        return (self.reflectance * warp.INV_PI) * ((wo[2] > 0.0) & (wi[2] > 0.0))

    def pdf(self, wo, wi):
        """cos/pi, or 1/(2 pi)."""
        density = (
            warp.cosine_hemisphere_pdf(wi) if self.hemisphere == "cosine" else warp.uniform_hemisphere_pdf(wi)
        )
        return density * (wo[2] > 0.0)

    def sample(self, wo, u):
        """A direction of the upper hemisphere."""
        upper = warp.cosine_hemisphere if self.hemisphere == "cosine" else warp.uniform_hemisphere
        wi = upper(u[1:])
        n = wo.shape[1]
        lobe = np.broadcast_to(np.int8(LOBES.index("diffuse")), n)
        return Sample(wi, self.eval(wo, wi), self.pdf(wo, wi), np.broadcast_to(False, n), lobe)
