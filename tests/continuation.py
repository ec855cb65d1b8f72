"""Rays that go on from the edges and corners of closed rooms: do they stay in, and meet what is there?

The start is a point of a face within 4 ulp of an edge or a corner, put onto the face and moved off it as
the loop does it. What the ray meets is judged by the definition in float64:

    escape          it meets nothing, and the room is closed
    false self-hit  it meets its own face, or one that does not reach into the side of its own face's plane to
                    which it leaves: a coplanar or a convex neighbour. No ray from there can meet those.
    from behind     it meets a face from the side where the room is not: it has passed through another
"""

from functools import cache
from typing import NamedTuple

import numpy as np
from meshes import icosphere

from tracer.bsdf.diffuse import Diffuse
from tracer.camera import Camera
from tracer.definition import Definition, Surface
from tracer.scene import Scene
from tracer.shape import Cube, Mesh, Rectangle, start

ULPS = 4
TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])  # orthogonal, no zero but one


class Place(NamedTuple):
    """Where a room of size 1 is put."""

    name: str
    size: float
    middle: tuple


PLACES = (
    Place("origin", 1.0, (0.0, 0.0, 0.0)),
    Place("far", 1000.0, (148376.0, 1234.0, -223423.0)),  # where Embree tests itself
    Place("away", 1.0, (1483.0, 12.0, -1341.0)),  # 2 km from the origin
    Place("cornered", 1.0, (1.04, -0.2, 1.72)),  # TURN (1, 1, 1): a corner and three walls at the origin
)


def matrix(place, *more):
    """The (4, 4) map of a place after some (4, 4) maps within the room."""
    out = np.eye(4)
    out[:3, :3] = TURN * place.size
    out[:3, 3] = place.middle
    for step in more:
        out = out @ step
    return out


def box(low, high, n=1):
    """A box seen from outside, each side n x n squares of two triangles: vertices (V, 3), faces (F, 3)."""
    low, high = np.array(low, float), np.array(high, float)
    vertices, faces = [], []
    s, t = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n, indexing="ij")
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    for axis in range(3):
        for end in (0, 1):
            p = np.empty((s.size, 3))
            p[:, axis] = end
            p[:, (axis + 1) % 3], p[:, (axis + 2) % 3] = s.ravel(), t.ravel()
            a, b, c, d = corner, corner + n + 1, corner + n + 2, corner + 1
            quad = np.concatenate((np.stack((a, b, c), 1), np.stack((a, c, d), 1)))
            faces.append(len(vertices) * s.size + (quad if end else quad[:, ::-1]))
            vertices.append(low + p * (high - low))
    return welded(np.concatenate(vertices), np.concatenate(faces))


def welded(vertices, faces):
    """Vertices at the same place made one."""
    unique, where = np.unique(vertices.round(9), axis=0, return_inverse=True)
    return unique, where.ravel()[faces]


def prism(outline, height=1.0):
    """A room over a polygon (K, 2), counter-clockwise, seen from inside; cut into triangles by hand."""
    outline, cut = outline
    k = len(outline)
    floor = np.column_stack((outline, np.full(k, -height)))
    roof = np.column_stack((outline, np.full(k, height)))
    cut = np.array(cut)
    faces = [cut, cut[:, ::-1] + k]
    for a in range(k):
        b = (a + 1) % k
        faces.append(np.array([(a, b + k, b), (a, a + k, b + k)]))
    return np.concatenate((floor, roof)), np.concatenate(faces)


ELL = (
    np.array([(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1)], float),
    [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)],
)
STAR = (
    np.array([(-1, -0.8), (0, -0.5), (1, -1), (0.6, 0), (0.9, 1), (0, 0.4), (-1, 1), (-0.5, 0)], float),
    [(0, 1, 7), (1, 2, 3), (1, 3, 7), (3, 4, 5), (3, 5, 7), (5, 6, 7)],
)


def joined(*meshes):
    """Several meshes as one."""
    vertices, faces, count = [], [], 0
    for v, f in meshes:
        vertices.append(v)
        faces.append(f + count)
        count += len(v)
    return np.concatenate(vertices), np.concatenate(faces)


def inside_out(mesh):
    return mesh[0], mesh[1][:, ::-1]


def _mesh(name, place, mesh, **more):
    m = matrix(place)
    return Mesh(name, mesh[0] @ m[:3, :3].T + m[:3, 3], mesh[1], **more)


def _walls(place):
    """Six rectangles around the cube from -1 to 1, facing inwards."""
    for axis in range(3):
        for sign in (-1.0, 1.0):
            step = np.zeros((4, 4))
            step[3, 3] = 1.0
            step[axis, 2], step[axis, 3] = -sign, sign
            step[(axis + 1) % 3, 0] = 1.0
            step[(axis + 2) % 3, 1] = -sign
            yield Rectangle(f"wall{axis}{sign}", matrix(place, step))


def _at(scale, middle):
    step = np.diag([*np.broadcast_to(np.array(scale, float), 3), 1.0])
    step[:3, 3] = middle
    return step


def rooms(place):
    """Closed rooms as tuples of shapes, by name; all free space lies on the front of every face, but in
    `glass`, which is seen from behind."""
    hull = inside_out(box((-1, -1, -1), (1, 1, 1)))
    block = box((-0.4, -0.3, -0.5), (0.3, 0.5, 0.4))
    return {
        "box": lambda: [_mesh("room", place, hull)],
        "ball": lambda: [_mesh("room", place, inside_out(icosphere(2)))],
        "fine": lambda: [_mesh("room", place, inside_out(box((-1, -1, -1), (1, 1, 1), 4)))],
        "glass": lambda: [_mesh("room", place, box((-1, -1, -1), (1, 1, 1), 2))],
        "block": lambda: [_mesh("room", place, joined(hull, block))],
        "ell": lambda: [_mesh("room", place, prism(ELL))],
        "star": lambda: [_mesh("room", place, prism(STAR))],
        "rectangles": lambda: list(_walls(place)),
        "cube": lambda: [Cube("room", matrix(place), flip_normals=True)],
        "block in rectangles": lambda: [*_walls(place), _mesh("block", place, block)],
        "cube in rectangles": lambda: [*_walls(place), Cube("block", matrix(place, _at(0.3, (0.1, 0.2, 0))))],
        "cube on a wall": lambda: [*_walls(place), Cube("block", matrix(place, _at(0.3, (0.1, 0.2, -0.7))))],
        "block on a wall": lambda: [
            *_walls(place),
            _mesh("block", place, box((-0.4, -0.3, -1), (0.3, 0.5, 0.4), 2)),
        ],
        "block on a mesh": lambda: [
            _mesh("room", place, joined(hull, box((-0.4, -0.3, -1), (0.3, 0.5, 0.4)))),
        ],
        "block in a cube": lambda: [
            Cube("room", matrix(place), flip_normals=True),
            _mesh("block", place, box((-0.4, -0.3, -1), (0.3, 0.5, 0.4))),
        ],
    }


NAMES = tuple(rooms(PLACES[0]))
KINDS = {
    "concave": ("box", "ball", "glass", "rectangles", "cube"),
    "convex": ("block", "ell", "star", "block in rectangles", "cube in rectangles"),
    "coplanar": ("fine",),
    "standing": ("cube on a wall", "block on a wall", "block on a mesh", "block in a cube"),
}
AIMS = ("corners", "edges")
WAYS = ("anywhere", "grazing", "along a neighbour")


def camera_in(place):
    """A camera in the middle of a room."""
    middle = np.array(place.middle)
    return Camera(middle, middle + [0.0, 0.0, place.size], np.array([0.0, 1.0, 0.0]), 60.0)


class Room(NamedTuple):
    """A scene and what its definition says about its faces."""

    scene: Scene
    side: float  # +1 where the room lies in front of the faces, -1 behind them
    n: np.ndarray  # (3, P) normals into the room
    corners: np.ndarray  # (3, 4, P)
    reaches: np.ndarray  # (P, P) whether face [a, b] b reaches into a's side
    spots: (
        tuple  # face (M,) and ends (3, M), (3, M) of edges that lie in the face: its own, and feet of others
    )
    tilt: float  # by how much rounding of their corners may turn faces
    sealed: np.ndarray  # faces that nothing reaches, since they stand on others


@cache
def room(name, place, dtype):
    """One of the rooms in one precision."""
    shapes = rooms(place)[name]()
    surfaces = tuple(Surface(shape, "white") for shape in shapes)
    scene = Scene(
        Definition(name, surfaces, {"white": Diffuse(np.ones((3, 1)))}, camera_in(place), 8, 8), dtype
    )
    side = -1.0 if name == "glass" else 1.0
    planes = [shape.planes() for shape in shapes]
    n = side * np.concatenate([p for p, _ in planes], axis=1)
    c = side * np.concatenate([c for _, c in planes])
    corners = np.concatenate([shape.outline() for shape in shapes], axis=2)
    area = np.concatenate([shape.area() for shape in shapes])
    height = np.einsum("ka,kcb->acb", n, corners) - c[:, None, None]
    near = 1e-9 * place.size
    on = np.abs(height) < near
    facing = on.all(axis=1) & (n.T @ n < -0.5)
    sealed = (facing & (area[:, None] > area)).any(axis=0)
    stands = on & np.roll(on, -1, axis=1) & (np.abs(n.T @ n) < 0.9)[:, None, :] & ~sealed[:, None, None]
    face, edge, other = np.nonzero(stands)
    own, k = np.nonzero(~sealed[:, None] & np.ones(4, bool))
    face, other, k = np.append(face, own), np.append(other, own), np.append(edge, k)
    spots = face.astype(np.int32), corners[:, k, other], corners[:, (k + 1) % 4, other]
    tilt = 32.0 * np.finfo(dtype).eps * (1.0 + np.abs(place.middle).max() / place.size)
    return Room(scene, side, n, corners, (height > near).any(axis=1), spots, tilt, np.flatnonzero(sealed))


def starts(made, aim, n, rng):
    """Faces (n,) and points (3, n) of them near their edges or corners, up to ULPS off in each coordinate."""
    dtype = made.scene.dtype
    pick = rng.integers(0, made.spots[0].size, n)
    face, a, b = (column[..., pick] for column in made.spots)
    s = np.zeros(n) if aim == "corners" else rng.random(n) * rng.choice([0, 1, 1, 1, 1e-3, 1e-6], n)
    p = (a + s * (b - a)).astype(dtype)
    off = rng.integers(-ULPS, ULPS + 1, (3, n)) * (rng.random(n) < 0.8)
    return face, p + off.astype(dtype) * np.spacing(np.abs(p))


def covered(made, p):
    """Whether points (3, N) lie under a face that stands on theirs, further than ULPS could move them."""
    out = np.zeros(p.shape[1], bool)
    slack = 4 * ULPS * np.spacing(np.abs(p).max(axis=0)).astype(float)
    for face in made.sealed:
        n, corner = made.n[:, face, None], made.corners[:, :, face]
        inside = np.abs(((p - corner[:, :1]) * n).sum(axis=0)) < 1e3 * slack
        for k in range(4):
            along = corner[:, k - 3] - corner[:, k]
            size = np.linalg.norm(along)
            if size > 0.0:
                inwards = np.cross(n[:, 0], along / size)
                inwards *= np.sign(inwards @ (corner.mean(axis=1) - corner[:, k]))
                inside &= inwards @ (p - corner[:, k, None]) > slack
        out |= inside
    return out


def directions(made, face, way, rng):
    """Unit directions (3, n) on the room's side of their faces, in the scene's precision."""
    n = made.n[:, face]
    d = rng.normal(size=n.shape)
    cos = (d * n).sum(axis=0)
    if way == "anywhere":
        d = d - 2.0 * np.minimum(cos, 0.0) * n
    elif way == "grazing":
        d = d - cos * n
        d = d / np.linalg.norm(d, axis=0) + n * 10.0 ** rng.uniform(-8, 0, cos.size)
    else:  # nearly in the plane of another face, so also along edges
        other = made.n[:, rng.integers(0, made.n.shape[1], cos.size)]
        d = d - (d * other).sum(axis=0) * other
        along = rng.random(cos.size) < 0.5
        d = np.where(along, np.cross(n, other, axis=0), d) + 1e-30
        d = d / np.linalg.norm(d, axis=0)
        tilt = 10.0 ** rng.uniform(-9, 0, (2, cos.size)) * rng.choice([-1, 1], (2, cos.size))
        d = d + tilt[0] * other + tilt[1] * n
        d = d - 2.0 * np.minimum((d * n).sum(axis=0), 0.0) * n
    return (d / np.linalg.norm(d, axis=0)).astype(made.scene.dtype)


def careless(scene, monkeypatch):
    """Leave starts where rounding put them: the broken twin."""
    monkeypatch.setattr(start, "clear", lambda faces, o, *rest: (np.empty(0, np.intp), np.empty((3, 0))))
    for kernel in scene.arrangement.closest:
        kernel = getattr(kernel, "exact", kernel)
        if hasattr(kernel, "others"):
            monkeypatch.setattr(kernel, "others", None)


class Judged(NamedTuple):
    """What became of rays: three counts."""

    rays: int
    escaped: int
    self_hit: int
    behind: int


def trace(made, aim, way, n, rng):
    """Rays of the room: face, hit, wi, t, met, and which of them count."""
    scene = made.scene
    face, p = starts(made, aim, n, rng)
    wi = directions(made, face, way, rng)
    with np.errstate(all="ignore"):
        hit = scene.hit(p, -directions(made, face, "anywhere", rng), np.zeros(n, scene.dtype), face)
        o = scene.spawn(hit, wi)
        t, met = scene.intersect(o, wi, face)
    leaves = made.side * (hit.ng[0] * wi[0] + hit.ng[1] * wi[1] + hit.ng[2] * wi[2]) > 0.0
    return face, hit, o, wi, t, met, leaves & ~covered(made, hit.p)


def judge(made, face, wi, met):
    """Boolean columns: escaped, met falsely, met from behind."""
    escaped = met < 0
    there = np.maximum(met, 0)
    self_hit = ~escaped & ~made.reaches[face, there]
    cos = (wi.astype(float) * made.n[:, there]).sum(axis=0)
    behind = ~escaped & (cos > made.tilt)
    return escaped, self_hit, behind


def continuation(name, place, dtype, aim, way, n, seed):
    """Trace n rays and count."""
    made = room(name, place, dtype)
    face, _, _, wi, _, met, leaves = trace(made, aim, way, n, np.random.default_rng(seed))
    counts = [int(np.count_nonzero(column & leaves)) for column in judge(made, face, wi, met)]
    return Judged(int(leaves.sum()), *counts)
