"""Rough boundaries as many small mirrors: how their normals are spread, and which of them are seen.

A surface of roughness (alpha_u, alpha_v) has normals m with density D(m), so that their projected area is
one: integral of D(m) cos theta_m = 1. Seen along w, facets of area w_z (1 + Lambda(w)) face the eye per
unit of area, and w_z Lambda(w) of that is hidden by other facets (Smith's model; Heitz 2014):

    G1(w) = 1 / (1 + Lambda(w))                   share that is seen from w
    G2(wo, wi) = 1 / (1 + Lambda(wo) + Lambda(wi))  seen from both, heights correlated
    visible(m) = D(m) max(0, w . m) / (w_z (1 + Lambda(w)))

Everything is written with `hidden` = w_z Lambda(w) instead of Lambda, which grows without bound at grazing
angles, and with directions stretched to a surface of roughness 1. So nothing overflows or cancels: at
alpha = 1e-4 in float32, at a cosine of 1e-8, or head on.
"""

from typing import NamedTuple

import numpy as np

from tracer.bsdf import beckmann, ggx
from tracer.frame import dot

DISTRIBUTIONS = {"ggx": ggx, "beckmann": beckmann}
INV_4PI = 0.25 / np.pi


class Facets(NamedTuple):
    """The normals of a rough surface. All directions are local, those of m upwards."""

    distribution: str  # a name in DISTRIBUTIONS
    alpha_u: np.ndarray  # (M,) roughness along x: the facets' slope, about sqrt(2) times its deviation
    alpha_v: np.ndarray  # (M,) roughness along y

    def D(self, m):
        """Density of normals per solid angle and area, (N,) in sr^-1."""
        x, y = m[0] / self.alpha_u, m[1] / self.alpha_v
        return DISTRIBUTIONS[self.distribution].density(x * x + y * y, m[2]) / (self.alpha_u * self.alpha_v)

    def hidden(self, w):
        """|cos| Lambda (N,): area that faces w but is hidden from it."""
        x, y = self.alpha_u * w[0], self.alpha_v * w[1]
        return DISTRIBUTIONS[self.distribution].hidden(np.sqrt(x * x + y * y), np.abs(w[2]))

    def G1(self, w):
        """Share (N,) of the facets facing w that is seen from it."""
        z = np.abs(w[2])
        return _ratio(z, z + self.hidden(w))

    def both(self, wo, wi):
        """|cos_o cos_i| / G2, (N,): what D is divided by in every microfacet BSDF."""
        zo, zi = np.abs(wo[2]), np.abs(wi[2])
        return zo * zi + zo * self.hidden(wi) + zi * self.hidden(wo)

    def G2(self, wo, wi):
        """Share (N,) of the facets that is seen from both sides, heights correlated."""
        return _ratio(np.abs(wo[2] * wi[2]), self.both(wo, wi))

    def facing(self, w):
        """Area (N,) of the facets that face w, hidden ones included: cos (1 + Lambda)."""
        return np.abs(w[2]) + self.hidden(w)

    def visible_pdf(self, w, m):
        """Density (N,) in sr^-1 of the normals that are seen from w."""
        return self.D(m) * np.maximum(dot(w, m), 0.0) / self.facing(w)

    def visible(self, w, u):
        """A normal (3, N) that is seen from w (above the surface), from u (2, N)."""
        stretched = np.stack((self.alpha_u * w[0], self.alpha_v * w[1], w[2]))
        x, y, z = DISTRIBUTIONS[self.distribution].visible(stretched, u)
        return unit(np.stack((self.alpha_u * x, self.alpha_v * y, z)).astype(w.dtype))

    def explain(self, wo, wi, m):
        """What an event shows: D at the normal m, G1 of wo, G2."""
        return {"D": self.D(m), "G1": self.G1(wo), "G2": self.G2(wo, wi)}


class Mirrored(NamedTuple):
    """What facets make of two directions above the surface when they reflect everything."""

    m: np.ndarray  # (3, N) the normal that reflects one into the other
    cos: np.ndarray  # (N,) angle of incidence on it
    f: np.ndarray  # (N,) D G2 / (4 cos_o cos_i) in sr^-1, 0 below
    pdf: np.ndarray  # (N,) density of wi by reflecting at a visible normal, in sr^-1, 0 below


def mirrored(facets, wo, wi):
    """Reflection at the facets, F = 1; both directions on the upper side (Torrance and Sparrow 1967)."""
    m = unit(wo + wi)
    above = (wo[2] > 0.0) & (wi[2] > 0.0)
    density = np.where(above, 0.25 * facets.D(m), 0.0)
    cos = np.clip(dot(wo, m), 0.0, 1.0)
    return Mirrored(m, cos, _ratio(density, facets.both(wo, wi)), density / facets.facing(wo))


def reflected(w, m):
    """w (3, N) mirrored at the normals m (3, N), of length 1 to the last bits."""
    return renormalised(2.0 * dot(w, m) * m - w)


def upwards(w):
    """w turned to the upper side."""
    return np.stack((w[0], w[1], np.abs(w[2])))


def unit(v):
    """v / |v|; what is too short to have a length stays short."""
    return v / np.sqrt(np.maximum(dot(v, v), np.finfo(v.dtype).tiny))


def renormalised(w):
    """w of length almost 1, made 1 by one step of Newton's method for 1/|w|."""
    return w * (1.5 - 0.5 * dot(w, w))


def _ratio(a, b):
    """a / b for b >= 0, and 0 where b is 0."""
    return np.where(b > 0.0, a / np.maximum(b, np.finfo(b.dtype).tiny), 0.0)
