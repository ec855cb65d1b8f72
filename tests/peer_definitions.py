"""Where Mitsuba 3 defines something differently, and why; and castray by Mitsuba's definitions of rough
surfaces and coats, for a comparison of all the rest.
"""

from contextlib import contextmanager

import numpy as np

from tracer.bsdf import beckmann
from tracer.bsdf.microfacet import Facets
from tracer.bsdf.plastic import Plastic
from tracer.bsdf.roughplastic import RoughPlastic, shares

NAMED_METALS = """\
Metals by name. castray reads n and k at one wavelength a channel; Mitsuba, in RGB, makes three numbers
of the whole spectrum, and has other measurements of some. `materials_eta_k` gives both the same
numbers."""
MASKING = """\
Masking of rough surfaces. castray correlates the heights of facets (Heitz 2014): G2 = 1 / (1 +
Lambda(wo) + Lambda(wi)); in Mitsuba the directions are independent, G2 = G1(wo) G1(wi), which is darker
at grazing angles, and G1 of Beckmann's facets is a fit (Walter et al. 2007), up to 0.4 % off."""
COATS = """\
Coats. What a coat sends back down to its base is integrated in castray. In Mitsuba's `plastic` it is a
fit in the index, 0.1 % off at 1.5; in `roughplastic` a mean over 64 cosines from 0 to 1, about 1.5 %
too small. A base that is lit from within loses the more the brighter it is."""
SMOOTH_OUTLINES = """\
Smooth normals of a coarse mesh. Where the interpolated normal looks away from the eye, Mitsuba draws
black and castray shades by the flat triangle. Light that is before a surface by one of its normals and
behind it by the other gets in in Mitsuba and not in castray (Veach 1997, 5.3). `smooth_dome` is seen
and lit so that neither happens."""

_NODES = 64  # of a coat's tables


def _both(self, wo, wi):
    return self.facing(wo) * self.facing(wi)


def _hidden(r, z):
    a = np.minimum(z / np.maximum(r, np.finfo(z.dtype).tiny), 1.6)
    G1 = np.where(a < 1.6, a * (3.535 + 2.181 * a) / (1.0 + a * (2.276 + 2.577 * a)), 1.0)
    return z * (1.0 / np.maximum(G1, np.finfo(z.dtype).tiny) - 1.0)


def _coated(cls, eta, diffuse_reflectance, specular_reflectance, nonlinear=False, formula="exact"):
    out = 1.0 / eta
    inside = 0.6681 + 0.7099 * out - 1.4399 * out * out + 0.0636 * eta
    return cls(eta, inside, diffuse_reflectance, specular_reflectance, nonlinear, formula)


def _roughly_coated(cls, alpha, eta, diffuse, specular, nonlinear=False, distribution="ggx", formula="exact"):
    facets = Facets(distribution, alpha, alpha)
    cosines = np.maximum(np.linspace(0.0, 1.0, _NODES), 1e-6)
    _, through = shares(facets, float(eta[0]), cosines, formula)
    out = np.array([2.0 * np.trapezoid(cosines * through, cosines)])
    inside = np.array([2.0 * (cosines * shares(facets, 1.0 / float(eta[0]), cosines, formula)[0]).mean()])
    tables = through[:, None], out, inside
    return cls(alpha, eta, *tables, diffuse, specular, nonlinear, distribution, formula)


def _through(self, cos):
    x = np.clip(cos, 0.0, 1.0) * (_NODES - 1.0)
    k = np.minimum(x.astype(np.int32), _NODES - 2)
    lane = np.arange(cos.size) if self.through.shape[1] == cos.size else 0
    low, high = self.through[k, lane], self.through[k + 1, lane]
    return low + (x - k.astype(x.dtype)) * (high - low)


@contextmanager
def of_the_peer():
    """castray with these definitions in place of its own."""
    theirs = (
        (Facets, "both", _both),
        (beckmann, "hidden", _hidden),
        (Plastic, "coated", classmethod(_coated)),
        (RoughPlastic, "coated", classmethod(_roughly_coated)),
        (RoughPlastic, "_through", _through),
    )
    ours = [(place, name, vars(place)[name]) for place, name, _ in theirs]
    try:
        for place, name, definition in theirs:
            setattr(place, name, definition)
        yield
    finally:
        for place, name, definition in ours:
            setattr(place, name, definition)
