"""Normals: missing, turned over, moved wrongly, of the wrong length."""

import numpy as np

from lessons.zoo.bug import Bug
from lessons.zoo.where import of_shape
from tracer.frame import Frame, cross, dot, length, normalize
from tracer.integrator.steps import hit
from tracer.lanes import put
from tracer.shape.mesh import Mesh

UNIT = "I11: normals have length 1, and lie on the side of the surface's own"
STRETCH = np.array([1.0, 2.0, 1.0])  # by which a smooth object is taken to have been scaled
LONG = 1.5  # length of the normals of a mesh that was scaled together with them


def zero_normals(scene, o, d, t, primitive):
    """A mesh without normals has zero vectors for them."""
    found = hit(scene, o, d, t, primitive)
    bare = of_shape(scene, primitive, Mesh)
    n, ng = (np.where(bare, 0.0, v).astype(v.dtype) for v in (found.n, found.ng))
    return found._replace(n=n, ng=ng, front=found.front & ~bare)


def turned_over(scene, o, d, t, primitive):
    """The vertices of meshes are listed the other way round."""
    found = hit(scene, o, d, t, primitive)
    mesh = of_shape(scene, primitive, Mesh)
    n, ng = (np.where(mesh, -v, v) for v in (found.n, found.ng))
    return found._replace(n=n, ng=ng, front=found.front ^ mesh)


def moved_as_points(scene, o, d, t, primitive):
    """Normals of objects that were scaled by M, by M itself.

    An object's own normal is M^T n, with n the right one in the world; M M^T n is what comes out.
    """
    found = hit(scene, o, d, t, primitive)
    stretch = STRETCH.astype(found.n.dtype).reshape(3, 1)
    moved = normalize(found.n * (stretch * stretch))
    return found._replace(n=np.where(_smooth(scene, primitive), moved, found.n))


def as_interpolated(scene, o, d, t, primitive):
    """The mean of the vertices' normals, shorter than any of them."""
    found = hit(scene, o, d, t, primitive)
    n = found.n.copy()
    for shape, first in zip(scene.shapes, scene.first, strict=True):
        if getattr(shape, "normals", None) is None:
            continue
        lanes = np.flatnonzero((primitive >= first) & (primitive < first + shape.primitives))
        put(
            n,
            lanes,
            n.take(lanes, axis=1)
            * _mean_length(shape, found.p.take(lanes, axis=1), primitive[lanes] - first),
        )
    return found._replace(n=n)


def _mean_length(shape, p, face):
    """Length (N,) of the interpolated unit normals at points (3, N) of a mesh's triangles."""
    v, w = shape.barycentric(p, face)
    a, b, c = (normalize(shape.normals[shape.faces[face, k]].T) for k in range(3))
    return length((1.0 - v - w) * a + v * b + w * c).astype(p.dtype)


def _smooth(scene, primitive):
    """Whether primitives (N,) belong to shapes with normals of their own, (N,)."""
    table = np.array([getattr(shape, "normals", None) is not None for shape in scene.shapes])
    return table.take(scene.shape_of.take(primitive))


def scaled_along(scene, o, d, t, primitive):
    """Normals of meshes as long as the mesh was scaled."""
    found = hit(scene, o, d, t, primitive)
    long = np.where(of_shape(scene, primitive, Mesh), LONG, 1.0).astype(found.n.dtype)
    return found._replace(n=found.n * long)


def crossed_with_up(scene, hit):
    """The frame from the cross product with y, which is 0/0 for a normal along y."""
    up = np.zeros_like(hit.n)
    up[1] = 1.0
    s = normalize(cross(up, hit.n))
    return Frame(s, cross(hit.n, s), hit.n)


def by_shading_alone(hit, wi):
    """Only the shading normal is asked whether a direction leaves the surface."""
    return dot(hit.n, wi) * dot(hit.n, hit.wo) > 0.0


BUGS = (
    Bug(
        "N01",
        "Missing normals",
        "The left wall and both boxes, which are meshes, are black.",
        "a mesh file without normals, and a loader that leaves them (0, 0, 0)",
        UNIT,
        {"hit": zero_normals},
    ),
    Bug(
        "N02",
        "Winding turned over",
        "The left wall and both boxes, which are meshes, are black: they are seen from behind.",
        "triangles listed clockwise, so that cross(b - a, c - a) points into the object",
        UNIT,
        {"hit": turned_over},
    ),
    Bug(
        "N03",
        "Normals moved by the matrix of the points",
        "A stretched object is lit as if it were flatter: its sides take light from above.",
        "n_world = normalize(M n), where the inverse transpose of M belongs",
        UNIT,
        {"hit": moved_as_points},
        scene="smooth_ball",
        settings={},
        note="The smooth ball is taken to be an egg that was stretched to a ball, by 2 along y.",
    ),
    Bug(
        "N04",
        "Interpolated normal not made unit again",
        "Smooth objects are too dark inside their triangles, which show as a pattern.",
        "n = (1 - v - w) n_a + v n_b + w n_c, without normalize",
        UNIT,
        {"hit": as_interpolated},
        scene="smooth_ball",
        settings={},
    ),
    Bug(
        "B17",
        "Local frame that breaks down",
        "Floor and ceiling send out no indirect light; other faces are right.",
        "s = normalize(cross((0, 1, 0), n)) for any n, also for n = (0, 1, 0)",
        "I11: directions have length 1",
        {"frame": crossed_with_up},
    ),
    Bug(
        "B18",
        "Normals not unit",
        "The left wall and both boxes, which are meshes, are too bright: cosines carry a factor |n|.",
        "n = cross(b - a, c - a), or n of a mesh that was scaled, without normalize",
        UNIT,
        {"hit": scaled_along},
        note="Normals of meshes have length 1.5.",
    ),
    Bug(
        "G09",
        "Only the shading normal asked for the hemisphere",
        "Directions into smooth objects count: light leaks through those that are thin or open.",
        "if dot(n_shading, wi) > 0, without dot(n_geometric, wi) > 0",
        UNIT,
        {"sides_agree": by_shading_alone},
        scene="smooth_ball",
        settings={},
        note="The ball is closed: what enters it is lost inside, and the picture stays right.",
    ),
)
