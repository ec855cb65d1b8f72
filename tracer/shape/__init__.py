"""What light meets. One file per shape; each class is a definition in float64 that offers:

    name, primitives                number of flat faces (or 1 for a sphere)
    planes() -> (normals (3, K), offsets (K,))   the plane n . x = c of each flat face
    area() -> (K,)                  area of each primitive in m^2
    across                          its size in metres, for the precision that has to resolve it
    triangles() -> (vertices (V, 3), faces (F, 3))   for drawing
    chart() -> Chart                coordinates (u, v) on each flat face; a sphere has uv_at and tangent_at
    outline() -> (3, 4, K)          corners of each primitive
    kernel(first, extent, dtype, others)    the intersection routine in one precision; others: the Faces of
                                    the scene (see start), or None where nothing else matters

and a kernel that answers for a whole wave of Rays:

    first                           number of its first primitive in the scene
    closest(rays, within) -> (t (N,), primitive)   distance to the nearest hit, inf or NaN where there is
                                    none, and its primitive: one, (N,) or a function of the lanes that hit.
                                    What lies beyond `within` (N,) may be left out. Where rays.touched is
                                    a list, starts within rounding of its faces are put there

A ray never hits the flat primitive it starts on (`source`) or is aimed at (`target`): both are excluded by
identity. A convex body (cube, sphere) is left for good from its outside, and from its inside only its far
side is met. What starts within rounding of other faces is moved off them first (`start`).
"""

from tracer.shape.cube import Cube
from tracer.shape.mesh import Mesh
from tracer.shape.rectangle import Rectangle
from tracer.shape.sphere import Sphere

ALL = (Rectangle, Cube, Sphere, Mesh)
