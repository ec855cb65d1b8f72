"""From the unit square to the domains light lives on; each map is followed by its density."""

import numpy as np

from tracer.frame import dot

INV_PI = 1.0 / np.pi
INV_2PI = 0.5 / np.pi


def concentric_disk(u):
    """Unit square (2, N) to the unit disk (2, N), keeping areas (Shirley and Chiu 1997)."""
    x, y = 2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0
    wide = np.abs(x) > np.abs(y)
    r = np.where(wide, x, y)
    ratio = np.where(wide, y, x) / np.where(r == 0.0, 1.0, r)
    phi = np.where(wide, (np.pi / 4) * ratio, (np.pi / 2) - (np.pi / 4) * ratio)
    return np.stack((r * np.cos(phi), r * np.sin(phi)))


def concentric_disk_pdf(p):
    """1/pi inside the unit disk."""
    return np.where(p[0] * p[0] + p[1] * p[1] <= 1.0, p.dtype.type(INV_PI), p.dtype.type(0.0))


def cosine_hemisphere(u):
    """Unit square to local directions with density cos/pi (Malley's method), (3, N).

    The height comes from the area left over by the disk, so that it keeps its digits at grazing angles.
    """
    phi = (2.0 * np.pi) * u[1]
    r = np.sqrt(u[0])
    return np.stack((r * np.cos(phi), r * np.sin(phi), np.sqrt(1.0 - u[0])))


def cosine_hemisphere_pdf(w):
    """cos/pi above the surface, in sr^-1."""
    return np.maximum(w[2], 0.0) * INV_PI


def uniform_hemisphere(u):
    """Unit square to local directions with density 1/(2 pi), (3, N)."""
    phi = (2.0 * np.pi) * u[1]
    z = 1.0 - u[0]
    r = np.sqrt(u[0] * (2.0 - u[0]))
    return np.stack((r * np.cos(phi), r * np.sin(phi), z))


def uniform_hemisphere_pdf(w):
    """1/(2 pi) above the surface, in sr^-1."""
    return np.where(w[2] > 0.0, w.dtype.type(INV_2PI), w.dtype.type(0.0))


def uniform_sphere(u):
    """Unit square to all directions with density 1/(4 pi), (3, N)."""
    phi = (2.0 * np.pi) * u[1]
    r = 2.0 * np.sqrt(u[0] * (1.0 - u[0]))
    return np.stack((r * np.cos(phi), r * np.sin(phi), 1.0 - 2.0 * u[0]))


def uniform_sphere_pdf(w):
    """1/(4 pi), in sr^-1."""
    return np.full(w.shape[1:], w.dtype.type(0.5 * INV_2PI))


def uniform_triangle(u):
    """Unit square to barycentric coordinates (b0, b1), uniform over any triangle's area (2, N)."""
    root = np.sqrt(u[0])
    return np.stack((1.0 - root, u[1] * root))


def uniform_cone(u, one_minus_cos):
    """Unit square to local directions within an angle of the z axis, density 1/(2 pi (1 - cos)).

    one_minus_cos: (N,) of the half angle; passed in that form because small cones lose it otherwise.
    """
    phi = (2.0 * np.pi) * u[1]
    drop = u[0] * one_minus_cos
    r = np.sqrt(drop * (2.0 - drop))
    return np.stack((r * np.cos(phi), r * np.sin(phi), 1.0 - drop))


def uniform_cone_pdf(one_minus_cos):
    """1/(2 pi (1 - cos)), in sr^-1."""
    return INV_2PI / one_minus_cos


def reflect(w):
    """Local mirror direction: the normal component stays, the rest turns round."""
    return np.stack((-w[0], -w[1], w[2]))


def mirror(w, n):
    """World mirror direction, omega_o = -omega_i + 2 (omega_i . n) n."""
    return 2.0 * dot(w, n) * n - w
