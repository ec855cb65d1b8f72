"""What a smooth and a rough coat over a diffuse base share."""

import numpy as np

from tracer.bsdf import fresnel
from tracer.bsdf.sample import Material


class Coated(Material):
    """A coat of another index over a diffuse base; nonlinear: whether colours deepen by going round."""

    eta: np.ndarray  # (M,)
    inside: np.ndarray  # (M,) share of diffuse light that the coat sends back down
    diffuse_reflectance: np.ndarray  # (3, M)
    specular_reflectance: np.ndarray  # (3, M)
    nonlinear: bool
    fresnel: str

    def albedo(self):
        """Bound of the share of light that is sent back, (3, M)."""
        return np.maximum(self.diffuse_reflectance, self.specular_reflectance)

    def display_colour(self):
        """Colour that stands for the material in drawings, (3, M)."""
        return self.diffuse_reflectance

    def reflectance_at(self, cos):
        """F (N,) of the coat, or of a facet of it, for a cosine above the surface."""
        eta = np.broadcast_to(self.eta, cos.shape)
        return fresnel.dielectric_mean(np.clip(cos, 0.0, 1.0), eta, self.fresnel)[0].astype(cos.dtype)

    def _base(self):
        """pi f of the base without what the coat lets through of both directions, (3, N)."""
        rho = self.diffuse_reflectance
        return rho / (1.0 - (rho if self.nonlinear else 1.0) * self.inside) / (self.eta * self.eta)
