"""What smooth and rough metal share."""

import numpy as np

from tracer.bsdf import fresnel
from tracer.bsdf.sample import Material


class Metal(Material):
    """A mirror, or facets that are mirrors, with the Fresnel reflectance of eta + i k."""

    eta: np.ndarray  # (3, M)
    k: np.ndarray  # (3, M)
    specular_reflectance: np.ndarray  # (3, M)
    fresnel: str

    def reflectance_at(self, cos):
        """Unpolarised reflectance (3, N) of the mirror, or of a facet, for the cosine at it."""
        mean = fresnel.conductor_mean(cos, self.eta, self.k, self.fresnel)
        return mean.astype(cos.dtype) * self.specular_reflectance

    def albedo(self):
        """Bound of the share of light that is sent back, (3, M)."""
        return self.specular_reflectance

    def display_colour(self):
        """Colour that stands for the material in drawings: its reflectance head on, (3, M)."""
        return self.reflectance_at(np.ones(1, self.eta.dtype))
