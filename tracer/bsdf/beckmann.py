"""Beckmann's normals, those of Gaussian slopes (Beckmann and Spizzichino 1963), at roughness 1.

    D = exp(-tan^2) / (pi z^4),  Lambda = (erf(a) - 1 + exp(-a^2) / (a sqrt(pi))) / 2  with a = cot theta

Evaluated with the scaled complement erfcx, because for smooth surfaces erf(a) - 1 has no digits left.
"""

import numpy as np

from tracer.warp import INV_PI

INV_SQRT_PI = np.pi**-0.5
STEPS = 8  # of Newton's method: the distribution is then met to 3e-9 everywhere, mostly to the last bit


def density(square, z):
    """D (N,) of the stretched normal with x^2 + y^2 = square."""
    z2 = np.maximum(z * z, np.sqrt(np.finfo(z.dtype).tiny) * 4.0)  # its square is still a normal number
    return INV_PI * np.exp(-square / z2) / (z2 * z2) * (z > 0.0)


def hidden(r, z):
    """z Lambda, (N,): exp(-a^2) (r / sqrt(pi) - z erfcx(a)) / 2 with a = z/r."""
    from scipy.special import erfcx

    a = np.minimum(z / np.maximum(r, np.finfo(z.dtype).tiny), 100.0)  # beyond, nothing is hidden
    return np.maximum(0.5 * np.exp(-a * a) * (r * INV_SQRT_PI - z * erfcx(a)), 0.0)


def visible(w, u):
    """A stretched normal (x, y, 1) seen from the stretched direction w (Heitz and D'Eon 2014; Jakob 2014).

    Turned so that w lies in the xz plane, with r and z its two components, y is Gaussian and x has the
    density (z + r x) exp(-x^2): what lies beyond x is z erfc(x) + r exp(-x^2)/sqrt(pi), up to a factor. That
    is solved for q = erfc(x): increasing and concave in q, so Newton's steps close in from one side. In
    float64, because the far ends of erfc need the digits.
    """
    from scipy.special import erf, erfcinv

    cell = np.finfo(u.dtype).epsneg if u.dtype == np.float32 else 2.0**-32  # what the sampler resolves
    x, y, z = w.astype(np.float64)
    r = np.sqrt(x * x + y * y)
    safe = np.maximum(r, np.finfo(np.float64).tiny)
    cot = np.minimum(z / safe, 1e3)  # beyond, all of the Gaussian is seen
    most = 1.0 + erf(cot)
    beyond = 1.0 - np.maximum(u[0].astype(np.float64), 0.5 * cell)  # in (0, 1): both ends of x stay finite
    wanted = beyond * (z * most + r * INV_SQRT_PI * np.exp(-cot * cot))
    q = most * (1.0 - (1.0 - beyond) ** _exponent(cot))
    for _ in range(STEPS):
        q = np.clip(q, np.finfo(np.float64).tiny, most)
        slope = erfcinv(q)
        rise = np.maximum(z + r * slope, 1e-300)
        q = q + (wanted - (z * q + r * INV_SQRT_PI * np.exp(-slope * slope))) / rise
    along = np.maximum(erfcinv(np.clip(q, np.finfo(np.float64).tiny, most)), -cot)
    across = erfcinv(2.0 * np.maximum(u[1].astype(np.float64), 0.5 * cell))
    cos, sin = np.where(r > 0.0, x / safe, 1.0), y / safe
    return cos * along - sin * across, sin * along + cos * across, np.ones_like(z)


def _exponent(cot):
    """First guess of the shape of q: 1 head on, where q is linear, and 1/2 at grazing angles."""
    return 0.5 + 0.5 * cot / (0.7 + cot)
