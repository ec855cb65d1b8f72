"""The faces of shapes that shine, as the lights know them."""

import numpy as np

from tracer.light.area import ShiningFace
from tracer.shape.mesh import Mesh
from tracer.shape.sphere import Sphere


def shining_faces(light, shape, first):
    """Yield a ShiningFace for each primitive of a shape; light: its number among the lights; first: number
    of the shape's first primitive."""
    area = shape.area()
    if isinstance(shape, Sphere):
        side = -1.0 if shape.flip_normals else 1.0
        radius, zero = np.array([shape.radius, 0, 0]), np.zeros(3)
        yield ShiningFace(light, first, "sphere", shape.center, radius, zero, area[0], np.array([side, 0, 0]))
        return
    kind = "triangle" if isinstance(shape, Mesh) else "quad"
    corner, e1, e2 = shape.corners() if kind == "triangle" else shape.parallelograms()
    n, _ = shape.planes()
    for j in range(shape.primitives):
        yield ShiningFace(light, first + j, kind, corner[:, j], e1[:, j], e2[:, j], area[j], n[:, j])
