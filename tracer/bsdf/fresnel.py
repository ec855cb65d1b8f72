"""How much light a smooth boundary reflects, for each polarisation (Born and Wolf 1999, 1.5).

The dielectric forms are rearranged so that nothing cancels: with e the relative index, c the cosine and
g = e cos_t, c - g is computed as -(e-1)(e+1)/(c+g), and e^2 c - g as (e^2-1)((e^2+1)c^2-1)/(e^2 c+g).
Numbers in float32 are taken to float64 and the reflectances rounded once: near the critical angle the product
of two of them is needed to its last bit.

Materials ask for the mean of both polarisations, exact or by Schlick's approximation (Schlick 1994).
"""

from functools import cache

import numpy as np


def dielectric(cos, eta):
    """Reflectances (Rs, Rp) and the cosine of the refracted direction, each (N,).

    cos: (N,) in [0, 1] between the direction and the normal on its own side. eta: (N,) index behind the
    surface over index in front. Beyond the critical angle Rs = Rp = 1 and the refracted cosine is 0.
    """
    dtype = np.result_type(cos, eta)
    cos, eta = np.asarray(cos, np.float64), np.asarray(eta, np.float64)
    contrast = (eta - 1.0) * (eta + 1.0)
    square = contrast + cos * cos  # (eta cos_t)^2
    total = square <= 0.0
    g = np.sqrt(np.maximum(square, 0.0))
    eta2 = eta * eta
    with np.errstate(divide="ignore", invalid="ignore"):
        # (c + g)^2 with g^2 as it is known, not as the root's square: both are exactly 1 at c = 0.
        s = contrast / (square + cos * (cos + 2.0 * g))
        p = contrast * ((eta2 + 1.0) * cos * cos - 1.0) / (square + eta2 * cos * (eta2 * cos + 2.0 * g))
    s = np.where(total, 1.0, s)
    p = np.where(total, 1.0, p)
    same = contrast == 0.0
    rs = np.where(same, 0.0, np.minimum(s * s, 1.0))
    rp = np.where(same, 0.0, np.minimum(p * p, 1.0))
    return rs.astype(dtype), rp.astype(dtype), np.where(same, cos, g / eta).astype(dtype)


def conductor(cos, eta, k):
    """Reflectances (Rs, Rp), each (C, N), of a conductor with complex index eta + i k.

    cos: (N,) in [0, 1]. eta, k: (C, N) or (C, 1), relative to the medium in front.
    """
    dtype = np.result_type(cos, eta)
    cos, eta, k = (np.asarray(v, np.float64) for v in (cos, eta, k))
    cos2 = cos * cos
    sin2 = 1.0 - cos2
    eta2, k2 = eta * eta, k * k
    t0 = eta2 - k2 - sin2
    a2b2 = np.sqrt(t0 * t0 + 4.0 * eta2 * k2)
    a = np.sqrt(np.maximum(0.5 * (a2b2 + t0), 0.0))
    s_sum, s_part = a2b2 + cos2, 2.0 * cos * a
    least = np.finfo(np.float64).tiny  # an index of exactly 1 at a cosine of 0 has sums of 0
    rs = (s_sum - s_part) / np.maximum(s_sum + s_part, least)
    p_sum, p_part = cos2 * a2b2 + sin2 * sin2, s_part * sin2
    rp = rs * (p_sum - p_part) / np.maximum(p_sum + p_part, least)
    return np.clip(rs, 0.0, 1.0).astype(dtype), np.clip(rp, 0.0, 1.0).astype(dtype)


def dielectric_mean(cos, eta, formula="exact"):
    """Unpolarised reflectance (N,) and the refracted cosine (N,); arguments as of dielectric."""
    rs, rp, cos_t = dielectric(cos, eta)
    if formula == "exact":
        return 0.5 * (rs + rp), cos_t
    total = (cos_t == 0.0) & (eta < 1.0)
    wider = np.where(eta < 1.0, cos_t, cos)  # Schlick's angle is the one in the thinner medium
    return np.where(total, 1.0, schlick(wider, head_on(eta, np.zeros_like(eta)))), cos_t


def conductor_mean(cos, eta, k, formula="exact"):
    """Unpolarised reflectance (C, N); arguments as conductor. k = inf is a perfect mirror: 1 everywhere."""
    perfect = np.isinf(k)
    eta, k = np.where(perfect, 1.0, eta), np.where(perfect, 0.0, k)
    if formula == "exact":
        rs, rp = conductor(cos, eta, k)
        return np.where(perfect, 1.0, 0.5 * (rs + rp))
    return np.where(perfect, 1.0, schlick(cos, head_on(eta, k)))


def head_on(eta, k):
    """Reflectance at normal incidence for the relative index eta + i k."""
    return ((eta - 1.0) ** 2 + k * k) / ((eta + 1.0) ** 2 + k * k)


def schlick(cos, head_on):
    """R0 + (1 - R0) (1 - cos)^5."""
    miss = 1.0 - cos
    return head_on + (1.0 - head_on) * (miss * miss) * (miss * miss) * miss


@cache
def _nodes():
    """400 nodes and weights of Gauss-Legendre's rule: a second's work, done once."""
    return np.polynomial.legendre.leggauss(400)


def diffuse_average(eta, formula="exact"):
    """Share of diffuse light that a dielectric reflects from outside, 2 integral of F cos dcos, (M,) float64.

    From inside it is 1 - (1 - this)/eta^2: as much light gets out along each ray as gets in. Gauss-Legendre
    in t with cos = t^2 (what is not smooth lies at grazing angles); from the denser side, that same rule.
    """
    t, weight = _nodes()
    t, weight = 0.5 * t[:, None] + 0.5, 0.5 * weight[:, None]
    dense = np.maximum(eta, 1.0 / eta).astype(np.float64)
    reflectance, _ = dielectric_mean(t * t, np.broadcast_to(dense, (t.size, dense.size)), formula)
    average = (4.0 * weight * t * t * t * reflectance).sum(axis=0)
    return np.where(eta >= 1.0, average, 1.0 - (1.0 - average) / (dense * dense))
