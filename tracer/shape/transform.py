"""Affine maps as 4x4 matrices in float64, and what they do to points and normals."""

import numpy as np

from tracer.settings import TracerError


def points(matrix, p):
    """Points (3, K) mapped."""
    return matrix[:3, :3] @ p + matrix[:3, 3:]


def vectors(matrix, v):
    """Vectors (3, K) mapped."""
    return matrix[:3, :3] @ v


def normals(matrix, n):
    """Normals (3, K) mapped by the inverse transpose and made unit again."""
    turned = np.linalg.inv(matrix[:3, :3]).T @ n
    return turned / np.linalg.norm(turned, axis=0)


def check_invertible(matrix, name):
    """TracerError unless the map is finite and keeps the three dimensions apart."""
    if not np.isfinite(matrix).all():
        raise TracerError(f"{name}.to_world: holds a number that is not finite")
    linear_part = matrix[:3, :3]
    size = np.abs(linear_part).max()
    if size == 0.0 or abs(determinant(linear_part / size)) < 1e-30:
        raise TracerError(f"{name}.to_world: flattens the shape (a scale of 0?) and cannot be inverted")


def determinant(linear_part):
    """Of the (3, 3) part of a transform; 0 where it underflows."""
    with np.errstate(divide="ignore", under="ignore"):
        return np.linalg.det(linear_part)
