"""A sphere that shines outwards, sampled uniformly over the cone of directions in which it is seen."""

import numpy as np

from tracer.frame import Frame, dot


def one_minus_cos(radius, distance, slack=0.0):
    """1 - cos of the cone's half angle, (N,), for receivers at `distance` (N,) from the centre; 0 inside and
    on the sphere, where there is no cone. On it are also those within `slack` of it.

    sin^2 / (1 + cos) keeps the digits that 1 - cos loses for small or distant spheres.
    """
    sine = radius / distance
    square = np.maximum((distance - radius) * (distance + radius), 0.0) / (distance * distance)
    return np.where(distance > radius + slack, sine * sine / (1.0 + np.sqrt(square)), 0.0).astype(
        distance.dtype
    )


def uniform_cone(p, center, radius, u, slack=0.0):
    """Points of spheres and the normals there, both (3, N), and the cones' 1 - cos, (N,).

    p: (3, N) receivers; center: (3, N or 1); u: (2, N). The normal is found from the sine of the direction:
    the chord to the sphere, a difference of large numbers, is not needed (Pharr et al. 2023, 6.2.4, whose
    angle at the centre is written here without differences).
    """
    out = p - center
    distance = np.sqrt(dot(out, out))
    least = one_minus_cos(radius, distance, slack)
    drop = u[0] * least
    sin, cos = np.sqrt(drop * (2.0 - drop)), 1.0 - drop
    sin_most = radius / distance
    # sqrt(1 - sin^2 / sin_most^2)
    rim = np.sqrt((1.0 - u[0]) * np.maximum(2.0 - least * (1.0 + u[0]), 0.0) / (2.0 - least))
    across = sin * (cos / sin_most - rim)
    along = sin * sin / sin_most + cos * rim
    phi = (2.0 * np.pi) * u[1]
    frame = Frame.around(out / distance)
    n = frame.to_world(np.stack((across * np.cos(phi), across * np.sin(phi), along)))
    return center + radius * n, n, least
