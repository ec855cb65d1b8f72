"""A diffuse base under a rough clear coat: a glossy lobe and a diffuse one."""

from dataclasses import dataclass

import numpy as np

from tracer import warp
from tracer.bsdf import fresnel
from tracer.bsdf.coat import Coated
from tracer.bsdf.microfacet import Facets, mirrored, reflected, unit, upwards
from tracer.bsdf.sample import Sample
from tracer.events import LOBES
from tracer.frame import dot

NODES = 64  # of the tables over the angle, evenly spaced in the root of the cosine


@dataclass(frozen=True)
class RoughPlastic(Coated):
    """f = F D G2 / (4 cos_o cos_i) + T(wo) T(wi) rho / (pi eta^2 (1 - rho R_in)).

    T(w) is what the rough coat lets through of light along w, R_in the share of diffuse light that it sends
    back down, both integrals over its facets. With `nonlinear` off the denominator takes rho = 1.
    """

    alpha: np.ndarray  # (M,) roughness
    eta: np.ndarray  # (M,) index of the coat over index outside
    through: np.ndarray  # (NODES, M) T over the root of the cosine
    out: np.ndarray  # (M,) average of T over the hemisphere
    inside: np.ndarray  # (M,) R_in
    diffuse_reflectance: np.ndarray  # (3, M) albedo rho of the base
    specular_reflectance: np.ndarray  # (3, M) factor on the glossy lobe, 1 for a real coat
    nonlinear: bool = False
    distribution: str = "ggx"  # or "beckmann"
    fresnel: str = "exact"  # or "schlick"

    @classmethod
    def coated(cls, alpha, eta, diffuse, specular, nonlinear=False, distribution="ggx", formula="exact"):
        """The material with its tables, from one column of parameters."""
        facets = Facets(distribution, alpha, alpha)
        cosines = np.maximum(np.linspace(0.0, 1.0, NODES), 1e-4) ** 2
        _, through = shares(facets, float(eta[0]), cosines, formula)
        x, weight = np.polynomial.legendre.leggauss(16)
        mu = 0.5 * x + 0.5
        out = (weight * mu * shares(facets, float(eta[0]), mu, formula)[1]).sum()
        inside = (weight * mu * shares(facets, 1.0 / float(eta[0]), mu, formula)[0]).sum()
        tables = through[:, None], np.array([out]), np.array([inside])
        return cls(alpha, eta, *tables, diffuse, specular, nonlinear, distribution, formula)

    @property
    def facets(self):
        """The normals of the coat."""
        return Facets(self.distribution, self.alpha, self.alpha)

    def _through(self, cos):
        """T (N,), between the nodes of its table."""
        x = np.sqrt(np.clip(cos, 0.0, 1.0)) * (NODES - 1.0)
        k = np.minimum(x.astype(np.int32), NODES - 2)
        lane = np.arange(cos.size) if self.through.shape[1] == cos.size else 0
        low, high = self.through[k, lane], self.through[k + 1, lane]
        return low + (x - k.astype(x.dtype)) * (high - low)

    def _glossy_chance(self, wo):
        """Probability (N,) of the glossy lobe: its share, about, of the largest channel's light."""
        glossy = self.reflectance_at(wo[2]) * self.specular_reflectance.max(axis=0)
        base = self._through(wo[2]) * (self._base() * self.out).max(axis=0)
        whole = glossy + base
        return np.where(whole > 0.0, glossy / np.where(whole > 0.0, whole, 1.0), 1.0)

    def eval(self, wo, wi):
        """Both parts, where both directions are above the surface."""
        at = mirrored(self.facets, wo, wi)
        above = (wo[2] > 0.0) & (wi[2] > 0.0)
        base = self._through(wo[2]) * self._through(wi[2]) * warp.INV_PI * above
        return self.reflectance_at(at.cos) * at.f * self.specular_reflectance + self._base() * base

    def pdf(self, wo, wi):
        """Of both lobes together, with the probabilities of choosing them."""
        chance = self._glossy_chance(wo)
        diffuse = (1.0 - chance) * warp.cosine_hemisphere_pdf(wi) * (wo[2] > 0.0)
        return chance * mirrored(self.facets, wo, wi).pdf + diffuse

    def sample(self, wo, u):
        """wo mirrored at a visible normal, or a cosine-weighted direction."""
        glossy = u[0] < self._glossy_chance(wo)
        mirror = reflected(wo, self.facets.visible(upwards(wo), u[1:]))
        wi = np.where(glossy, mirror, warp.cosine_hemisphere(u[1:]))
        lobe = np.where(glossy, np.int8(LOBES.index("reflection")), np.int8(LOBES.index("diffuse")))
        return Sample(wi, self.eval(wo, wi), self.pdf(wo, wi), np.broadcast_to(False, wo.shape[1]), lobe)

    def explain(self, wo, wi):
        """D, G1 of wo, G2, and F at the facet, all of the coat."""
        at = mirrored(self.facets, wo, wi)
        return self.facets.explain(wo, wi, at.m) | {"F": self.reflectance_at(at.cos)}


def shares(facets, eta, cosines, formula):
    """What a rough boundary reflects and lets through of light at some cosines, two (K,).

    By the sampler's own map from the unit square to visible normals, on Gauss-Legendre nodes in the first
    number and even ones in the second, which is an angle; the weights there are G2 / G1.
    """
    x, weight = np.polynomial.legendre.leggauss(48)
    u, weight = 0.5 * x + 0.5, 0.5 * weight
    v = (np.arange(48) + 0.5) / 48
    numbers = np.stack([grid.ravel() for grid in np.meshgrid(u, v, indexing="ij")])
    lanes = numbers.shape[1]
    reflectance, transmittance = np.empty(cosines.size), np.empty(cosines.size)
    for k, mu in enumerate(cosines):
        wo = np.repeat(np.array([[np.sqrt((1.0 - mu) * (1.0 + mu))], [0.0], [mu]]), lanes, axis=1)
        m = facets.visible(wo, numbers)
        cos = np.clip(dot(wo, m), 0.0, 1.0)
        F, cos_t = fresnel.dielectric_mean(cos, np.full(lanes, eta), formula)
        back, across = reflected(wo, m), unit((cos / eta - cos_t) * m - wo / eta)
        seen = [np.abs(w[2]) * facets.facing(wo) / facets.both(wo, w) for w in (back, across)]
        lost = (back[2] <= 0.0, across[2] >= 0.0)
        parts = (F * seen[0] * ~lost[0], (1.0 - F) * seen[1] * ~lost[1])
        reflectance[k], transmittance[k] = (
            (part.reshape(48, 48).mean(axis=1) * weight).sum() for part in parts
        )
    return reflectance, transmittance
