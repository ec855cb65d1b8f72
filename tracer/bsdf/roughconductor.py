"""Rough metal: facets that are mirrors with the Fresnel reflectance of eta + i k."""

from dataclasses import dataclass

import numpy as np

from tracer.bsdf.metal import Metal
from tracer.bsdf.microfacet import Facets, mirrored, reflected, upwards
from tracer.bsdf.sample import Sample
from tracer.events import LOBES


@dataclass(frozen=True)
class RoughConductor(Metal):
    """f = F D G2 / (4 cos_o cos_i) (Torrance and Sparrow 1967), sampled by visible normals (Heitz 2014).

    The weight f cos / pdf is F G2 / G1 and so never above F. A perfect mirror's facets: k = inf.
    """

    alpha_u: np.ndarray  # (M,) roughness along x of the local frame
    alpha_v: np.ndarray  # (M,) roughness along y
    eta: np.ndarray  # (3, M) real part of the index
    k: np.ndarray  # (3, M) imaginary part
    specular_reflectance: np.ndarray  # (3, M) factor on top, 1 for a real metal
    distribution: str = "ggx"  # or "beckmann"
    fresnel: str = "exact"  # or "schlick"

    @property
    def anisotropic(self):
        """Whether it minds being turned about the normal."""
        return bool((self.alpha_u != self.alpha_v).any())

    @property
    def facets(self):
        """The normals of its surface."""
        return Facets(self.distribution, self.alpha_u, self.alpha_v)

    def eval(self, wo, wi):
        """F D G2 / (4 cos_o cos_i) where both directions are above the surface."""
        return self._both(wo, wi)[0]

    def pdf(self, wo, wi):
        """G1 D / (4 cos_o)."""
        return self._both(wo, wi)[1]

    def _both(self, wo, wi):
        at = mirrored(self.facets, wo, wi)
        return self.reflectance_at(at.cos) * at.f, at.pdf

    def sample(self, wo, u):
        """wo mirrored at a visible normal; below the surface it carries nothing."""
        wi = reflected(wo, self.facets.visible(upwards(wo), u[1:]))
        f, pdf = self._both(wo, wi)
        n = wo.shape[1]
        lobe = np.broadcast_to(np.int8(LOBES.index("reflection")), n)
        return Sample(wi, f, pdf, np.broadcast_to(False, n), lobe)

    def explain(self, wo, wi):
        """D, G1 of wo, G2, and F at the facet."""
        at = mirrored(self.facets, wo, wi)
        return self.facets.explain(wo, wi, at.m) | {"F": self.reflectance_at(at.cos)}
