"""Rough glass: facets that reflect and refract (Walter et al. 2007)."""

from dataclasses import dataclass

import numpy as np

from tracer.bsdf import fresnel
from tracer.bsdf.glass import Refracting
from tracer.bsdf.microfacet import Facets, reflected, renormalised, unit, upwards
from tracer.bsdf.sample import Sample
from tracer.events import LOBES
from tracer.frame import dot


@dataclass(frozen=True)
class RoughDielectric(Refracting):
    """With h = wo + wi for reflection, h = wo + e wi for transmission, e the index across over that at wo:

        f_r = F D G2 / (4 |cos_o cos_i|)
        f_t = (1 - F) |wo.m| |wi.m| D G2 / (|cos_o cos_i| |h|^2),  m = h / |h| turned upwards

    f_t scatters radiance, as seen along the path from the camera: energy per ray times 1/e^2. Sampled by
    visible normals, and there by F: the weight is G2 / G1, over e^2 for transmission.
    """

    alpha_u: np.ndarray  # (M,) roughness along x of the local frame
    alpha_v: np.ndarray  # (M,) roughness along y
    eta: np.ndarray  # (M,) index behind the surface over index on the side of the normal
    specular_reflectance: np.ndarray  # (3, M) factor on the reflected light, 1 for real glass
    specular_transmittance: np.ndarray  # (3, M) factor on the transmitted light, 1 for clear glass
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
        """f_r on the side of wo, f_t on the other."""
        return self._both(wo, wi)[0]

    def pdf(self, wo, wi):
        """F or 1 - F, times the density of the visible normal, times that of wi given the normal."""
        return self._both(wo, wi)[1]

    def _normal(self, wo, wi):
        """The facet that sends wi to wo: m (3, N) upwards, h.h, F, and whether it can be seen from both."""
        eta, same = self.relative_eta(wo[2]), wo[2] * wi[2] > 0.0
        h = wo + np.where(same, 1.0, eta) * wi
        m = unit(h) * np.copysign(1.0, h[2]).astype(h.dtype)
        seen = (dot(wo, m) * wo[2] > 0.0) & (dot(wi, m) * wi[2] > 0.0)
        F, _ = fresnel.dielectric_mean(np.minimum(np.abs(dot(wo, m)), 1.0), eta, self.fresnel)
        return m, dot(h, h), F.astype(wo.dtype), seen

    def _both(self, wo, wi):
        """f (3, N) and density (N,)."""
        facets, eta, same = self.facets, self.relative_eta(wo[2]), wo[2] * wi[2] > 0.0
        m, h2, F, seen = self._normal(wo, wi)
        density, both, facing = facets.D(m), facets.both(wo, wi), facets.facing(wo)
        spread = np.abs(dot(wo, m) * dot(wi, m)) / np.maximum(h2, np.finfo(h2.dtype).tiny)
        lobe = np.where(same, 0.25 * F, (1.0 - F) * spread) * density
        f = np.where(seen, lobe / np.where(both > 0.0, both, 1.0), 0.0)
        pdf = np.where(seen, lobe * np.where(same, 1.0, eta * eta) / facing, 0.0)
        return f * np.where(same, self.specular_reflectance, self.specular_transmittance), pdf

    def sample(self, wo, u):
        """A visible normal, and there reflection with probability F; on the wrong side it carries nothing."""
        eta = self.relative_eta(wo[2])
        up = np.copysign(1.0, wo[2]).astype(wo.dtype)
        m = up * self.facets.visible(upwards(up * wo), u[1:])
        cos = np.clip(dot(wo, m), 0.0, 1.0)
        F, cos_t = fresnel.dielectric_mean(cos, eta, self.fresnel)
        back = u[0] < F
        across = renormalised((cos / eta - cos_t) * m - wo / eta)
        wi = np.where(back, reflected(wo, m), across).astype(wo.dtype)
        f, pdf = self._both(wo, wi)
        right = back == (wo[2] * wi[2] > 0.0)
        lobe = np.where(back, np.int8(LOBES.index("reflection")), np.int8(LOBES.index("transmission")))
        return Sample(wi, f * right, pdf * right, np.broadcast_to(False, wo.shape[1]), lobe)

    def explain(self, wo, wi):
        """D, G1 of wo, G2, F at the facet, and the index across the surface."""
        m, _, F, _ = self._normal(wo, wi)
        eta = self.relative_eta(wo[2])
        return self.facets.explain(wo, wi, m) | {"F": F, "eta": eta}
