"""GGX normals, those of an ellipsoid (Walter et al. 2007; Trowbridge and Reitz 1975), at roughness 1.

D = 1 / (pi (x^2 + y^2 + z^2)^2),  Lambda = (sqrt(1 + tan^2) - 1) / 2
"""

import numpy as np

from tracer.warp import INV_PI

TWO_PI = 2.0 * np.pi


def density(square, z):
    """D (N,) of the stretched normal with x^2 + y^2 = square."""
    whole = square + z * z
    return INV_PI / (whole * whole) * (z > 0.0)


def hidden(r, z):
    """z Lambda, (N,): with tan = r/z it is (sqrt(z^2 + r^2) - z) / 2, without the difference."""
    return 0.5 * r * r / np.maximum(z + np.sqrt(z * z + r * r), np.finfo(z.dtype).tiny)


def visible(w, u):
    """A stretched normal, of any length, seen from the stretched direction w: half way between it and a
    uniform direction on the cap of the sphere above -w_z (Dupuy and Benyoub 2023)."""
    square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
    x, y, z = w / np.sqrt(np.maximum(square, np.finfo(w.dtype).tiny))
    phi = TWO_PI * u[1]
    drop = u[0] * (1.0 + z)
    r = np.sqrt(drop * np.maximum(2.0 - drop, 0.0))
    return r * np.cos(phi) + x, r * np.sin(phi) + y, (1.0 - u[0]) * (1.0 + z)
