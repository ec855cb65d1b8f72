"""What smooth, thin and rough glass share."""

import numpy as np

from tracer.bsdf.sample import Material


class Glass(Material):
    """Light is reflected by its surface, and goes on behind it."""

    specular_reflectance: np.ndarray  # (3, M)
    specular_transmittance: np.ndarray  # (3, M)

    one_sided = False
    see_through = True

    def albedo(self):
        """Bound of the share of light that is sent on, (3, M)."""
        return np.maximum(self.specular_reflectance, self.specular_transmittance)

    def display_colour(self):
        """Colour that stands for the material in drawings, (3, M)."""
        return self.specular_transmittance


class Refracting(Glass):
    """Its sides have unlike indices."""

    eta: np.ndarray  # (M,)

    def relative_eta(self, cos):
        """Index across the surface over index on the side of wo, (N,)."""
        return np.where(cos > 0.0, self.eta, 1.0 / self.eta)
