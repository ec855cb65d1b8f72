"""The same opaque material on both sides of a surface."""

from dataclasses import dataclass

import numpy as np

from tracer.bsdf.sample import Material


@dataclass(frozen=True)
class TwoSided(Material):
    """Asks the material inside as if it were seen from the front: both directions turn over with wo."""

    bsdf: Material

    one_sided = False

    @property
    def delta(self):
        """Whether all lobes are Dirac ones."""
        return self.bsdf.delta

    @property
    def anisotropic(self):
        """Whether it minds being turned about the normal."""
        return self.bsdf.anisotropic

    def albedo(self):
        """Bound of the share of light that is sent back, (3, M)."""
        return self.bsdf.albedo()

    def display_colour(self):
        """Colour that stands for the material in drawings, (3, M)."""
        return self.bsdf.display_colour()

    def eval(self, wo, wi):
        """f of the side that wo is on."""
        return self.bsdf.eval(_over(wo, wo), _over(wi, wo))

    def pdf(self, wo, wi):
        """Density on the side that wo is on."""
        return self.bsdf.pdf(_over(wo, wo), _over(wi, wo))

    def sample(self, wo, u):
        """A direction on the side that wo is on."""
        sample = self.bsdf.sample(_over(wo, wo), u)
        return sample._replace(wi=_over(sample.wi, wo))

    def explain(self, wo, wi):
        """What the material inside says."""
        return self.bsdf.explain(_over(wo, wo), _over(wi, wo))


def _over(w, wo):
    """w (3, N), turned over where wo is behind the surface."""
    return np.stack((w[0], w[1], np.where(wo[2] < 0.0, -w[2], w[2])))
