"""Coordinates on surfaces lie as Mitsuba lays them, and local frames of what is anisotropic follow them."""

import numpy as np
import pytest
import trimesh

import tracer
from tracer import Settings, TracerError
from tracer.frame import Frame, cross, dot
from tracer.shape.chart import Chart

both = pytest.mark.parametrize("precision", [32, 64])
CAMERA = {
    "type": "perspective",
    "fov": 40.0,
    "to_world": [{"look_at": {"origin": [0, 0, 9], "target": [0, 0, 0], "up": [0, 1, 0]}}],
    "film": {"width": 8, "height": 8},
}
BRUSHED = {"type": "roughconductor", "alpha_u": 0.1, "alpha_v": 0.3}
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .1 .2\nvt .9 .3\nvt .2 .8\nf 1/1 2/2 3/3\n"
AS_PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property float {}
property float {}
element face 1
property list uchar int vertex_indices
end_header
0 0 0 .1 .2
1 0 0 .9 .3
0 1 0 .2 .8
3 0 1 2
"""
TURN = [{"rotate": [0, 1, 0], "angle": 90}]

# Shape, point on it, u and v there, and direction of dp/du: all from Mitsuba 3.9.1 (scalar_rgb).
MITSUBA = {
    "rectangle": ({"type": "rectangle"}, (0.5, 0.25, 0), (0.75, 0.625), (1, 0, 0)),
    "turned over": ({"type": "rectangle", "flip_normals": True}, (0.5, 0.25, 0), (0.75, 0.625), (1, 0, 0)),
    "mirrored": (
        {"type": "rectangle", "to_world": [{"scale": [-1, 1, 1]}]},
        (0.5, 0.25, 0),
        (0.25, 0.625),
        (-1, 0, 0),
    ),
    "cube -x": ({"type": "cube"}, (-1, 0.25, 0.5), (0.625, 0.75), (0, 1, 0)),
    "cube +x": ({"type": "cube"}, (1, 0.25, 0.5), (0.625, 0.25), (0, 1, 0)),
    "cube -y": ({"type": "cube"}, (0.5, -1, 0.25), (0.625, 0.75), (0, 0, 1)),
    "cube +y": ({"type": "cube"}, (0.5, 1, 0.25), (0.25, 0.375), (-1, 0, 0)),
    "cube -z": ({"type": "cube"}, (0.25, 0.5, -1), (0.25, 0.625), (0, -1, 0)),
    "cube +z": ({"type": "cube"}, (0.25, 0.5, 1), (0.75, 0.625), (0, 1, 0)),
    "sphere": (
        {"type": "sphere"},
        (-0.34188173, -0.91168461, 0.22792115),
        (0.6928998743900459, 0.4268071546690688),
        (0.936329, -0.351123, 0),
    ),
    "sphere turned": (
        {"type": "sphere", "to_world": TURN},
        (0.1, 0.974679434, 0.2),
        (0.282211, 0.468116),
        (0, -0.201008, 0.979589),
    ),
    "obj": ({"type": "obj", "filename": "m.obj"}, (0.25, 0.5, 0), (0.35, 0.475), (0.986394, -0.164399, 0)),
    "obj as it is": (
        {"type": "obj", "filename": "m.obj", "flip_tex_coords": False},
        (0.25, 0.5, 0),
        (0.35, 0.525),
        (0.986394, -0.164399, 0),
    ),
    "ply u, v": (
        {"type": "ply", "filename": "uv.ply"},
        (0.25, 0.5, 0),
        (0.35, 0.525),
        (0.986394, -0.164399, 0),
    ),
    "ply s, t": (
        {"type": "ply", "filename": "st.ply"},
        (0.25, 0.5, 0),
        (0.35, 0.525),
        (0.986394, -0.164399, 0),
    ),
    "ply flipped": (
        {"type": "ply", "filename": "st.ply", "flip_tex_coords": True},
        (0.25, 0.5, 0),
        (0.35, 0.475),
        (0.986394, -0.164399, 0),
    ),
    "mesh without any": ({"type": "obj", "filename": "n.obj"}, (0.25, 0.5, 0), (0.25, 0.5), (1, 0, 0)),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Meshes of one triangle."""
    folder = tmp_path_factory.mktemp("meshes")
    (folder / "m.obj").write_text(TRIANGLE, encoding="utf-8")
    (folder / "n.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    for a, b in ("uv", "st"):
        (folder / f"{a}{b}.ply").write_text(AS_PLY.format(a, b), encoding="utf-8")
    return folder


def scene(shape, folder=".", precision=64, **more):
    """A shape, ready for a precision."""
    lone = tracer.load_dict({"camera": CAMERA, "thing": {**shape, **more}}, folder=folder)
    return lone.at(Settings(precision=precision))


def hit(scene, p):
    """The hit of a ray that comes at the point p from where its normal points to, or from above."""
    p = np.asarray(p, float).reshape(3, 1)
    d = -(p if np.linalg.norm(p) > 0.9 else np.array([[0.0], [0.0], [1.0]]))
    d = (d / np.linalg.norm(d)).astype(scene.dtype)
    o = (p - 3.0 * d).astype(scene.dtype)
    with np.errstate(all="ignore"):
        t, primitive = scene.intersect(o, d, np.array([-1]))
    assert primitive >= 0
    return scene.hit(o, d, t, primitive)


@both
@pytest.mark.parametrize("name", MITSUBA)
def test_coordinates_and_frames_are_mitsubas(folder, name, precision):
    shape, p, uv, along = MITSUBA[name]
    lone = scene(shape, folder, precision)
    met = hit(lone, p)
    assert np.abs(met.p[:, 0] - p).max() < 1e-6
    assert lone.uv(met.p, met.primitive).dtype == lone.dtype
    assert np.abs(lone.uv(met.p, met.primitive)[:, 0] - uv).max() < 2e-6
    if name == "mesh without any":
        return
    brushed = scene(shape, folder, precision, bsdf=BRUSHED)
    frame = brushed.frame(met.n, met.p, met.primitive)
    assert np.abs(frame.s[:, 0] - along).max() < 2e-6
    assert np.abs(frame.t - cross(met.n, frame.s)).max() < 1e-6


@both
def test_a_mirrored_mesh_keeps_the_coordinates_of_its_corners(folder, precision):
    lone = scene(MITSUBA["ply u, v"][0], folder, precision, to_world=[{"scale": [-1, 1, 1]}])
    met = hit(lone, (-0.25, 0.5, 0))
    assert np.abs(lone.uv(met.p, met.primitive)[:, 0] - (0.35, 0.525)).max() < 1e-6


def test_coordinates_keep_their_digits_far_from_the_origin(folder):
    """In float32 a point 148 km away has 1/64 m: the coordinate is that of the point all the same."""
    far = [{"scale": 64.0}, {"translate": [148376.0, 1234.0, -223424.0]}]
    lone = scene(MITSUBA["ply u, v"][0], folder, 32, to_world=far)
    p = np.array([148376.0 + 16.0, 1234.0 + 32.0, -223424.0], np.float32).reshape(3, 1)
    assert np.abs(lone.uv(p, np.array([0]))[:, 0] - (0.35, 0.525)).max() < 1e-6


SEAM = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vt 0.5 0.5
vn 0 0 1
vn 0.6 0 0.8
f 1/1/1 2/2/1 3/3/1
f 1/5/2 3/3/2 4/4/2
"""


def test_a_vertex_of_an_obj_may_have_several_coordinates_and_normals(tmp_path):
    (tmp_path / "seam.obj").write_text(SEAM, encoding="utf-8")
    mesh = scene({"type": "obj", "filename": "seam.obj", "flip_tex_coords": False}, tmp_path).shapes[0]
    assert np.array_equal(mesh.uv, [[[0, 0], [1, 0], [1, 1]], [[0.5, 0.5], [1, 1], [0, 1]]])
    assert np.allclose(mesh.normals[mesh.faces], [[[0, 0, 1]] * 3, [[0.6, 0, 0.8]] * 3])


def test_normals_of_a_ply_with_coordinates_are_kept(tmp_path):
    ball = trimesh.creation.icosphere(subdivisions=1)
    uv = np.random.default_rng(1).random((len(ball.vertices), 2))
    head = "ply\nformat ascii 1.0\nelement vertex 42\n" + "".join(
        f"property double {word}\n" for word in ("x", "y", "z", "nx", "ny", "nz", "u", "v")
    )
    body = [" ".join(map(str, (*p, *p, *c))) for p, c in zip(ball.vertices, uv, strict=True)]
    body += ["3 {} {} {}".format(*face) for face in ball.faces]
    text = f"{head}element face 80\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "ball.ply").write_text(text + "\n".join(body) + "\n", encoding="utf-8")
    mesh = scene({"type": "ply", "filename": "ball.ply"}, tmp_path).shapes[0]
    assert np.allclose(mesh.normals, ball.vertices) and np.array_equal(mesh.uv, uv[ball.faces])


def test_a_triangle_without_extent_in_u_has_no_direction_and_still_a_frame():
    corner, e1, e2 = (np.array(v, float).reshape(3, 1) for v in ([0, 0, 0], [1, 0, 0], [0, 1, 0]))
    chart = Chart.spanned(corner, e1, e2, np.full((3, 2, 1), 0.5))
    assert not chart.tangent.any() and not chart.grad_u.any()
    n = np.array([[0.0], [0.0], [1.0]])
    assert np.array_equal(Frame.along(n, chart.tangent), Frame.around(n))


@both
def test_a_frame_is_orthonormal_and_as_near_to_the_tangent_as_it_can_be(suite_seed, precision):
    dtype = {32: np.float32, 64: np.float64}[precision]
    n, tangent = np.random.default_rng(suite_seed).normal(size=(2, 3, 10_000)).astype(dtype)
    n, tangent = (v / np.sqrt(dot(v, v)) for v in (n, tangent))
    tangent[:, :100] = n[:, :100]
    frame, eps = Frame.along(n, tangent), np.finfo(dtype).eps
    followed = dot(cross(n, tangent), cross(n, tangent)) > 1.1e-4
    for a, b, wanted in ((frame.s, frame.s, 1), (frame.s, n, 0), (frame.t, n, 0), (frame.t, frame.t, 1)):
        assert np.abs(dot(a, b) - wanted).max() < 400 * eps  # half a degree loses two digits
    assert followed.sum() > 9800 and np.abs(dot(frame.t, tangent))[followed].max() < 400 * eps
    assert (dot(frame.s, tangent)[followed] > 0).all()
    assert np.array_equal(frame.s[:, :100], Frame.around(n[:, :100]).s)


def test_a_pole_has_a_frame():
    ball = scene({"type": "sphere"}, bsdf=BRUSHED)
    met = hit(ball, (0, 0, 1))
    assert np.array_equal(ball.frame(met.n, met.p, met.primitive).s, Frame.around(met.n).s)


@both
def test_what_is_isotropic_keeps_its_frame_bit_for_bit(precision):
    """Beside something brushed, too: D and G of an event are worked out in the frame of the loop."""
    objects = {
        "camera": CAMERA,
        "plain": {"type": "sphere", "bsdf": {"type": "roughconductor", "alpha": 0.2}},
        "brushed": {"type": "sphere", "center": [0, 2, 0], "bsdf": BRUSHED},
    }
    mixed = tracer.load_dict(objects).at(Settings(precision=precision))
    d = np.random.default_rng(0).normal(size=(3, 500)).astype(mixed.dtype)
    d /= np.sqrt(dot(d, d))
    primitive = np.arange(500) % 2
    p = d + np.array([[0.0], [2.0], [0.0]], mixed.dtype) * primitive
    frame, around = mixed.frame(d, p, primitive), Frame.around(d)
    assert np.array_equal(frame.s[:, primitive == 0], around.s[:, primitive == 0])
    assert (np.abs(frame.s - around.s).max(axis=0)[primitive == 1] > 1e-3).mean() > 0.9


@pytest.mark.parametrize(
    ("bsdf", "said"),
    [
        (BRUSHED, "has a grain.*no texture coordinates"),
        ({"type": "twosided", "bsdf": BRUSHED}, "has a grain"),
        ({"type": "diffuse", "reflectance": {"type": "checkerboard"}}, "has a texture.*use an OBJ with vt"),
    ],
)
@pytest.mark.parametrize("name", ["n.obj", "broken.obj", "half.obj", "n.stl"])
def test_a_mesh_without_coordinates_cannot_carry_what_needs_them(folder, bsdf, said, name):
    (folder / "broken.obj").write_text(TRIANGLE.replace("vt .9", "vt nan"), encoding="utf-8")
    (folder / "half.obj").write_text(TRIANGLE + "v 1 1 0\nf 2 4 3\n", encoding="utf-8")
    trimesh.creation.box().export(folder / "n.stl")
    shape = {"type": name.partition(".")[2], "filename": name}
    assert scene(shape, folder).shapes[0].uv is None
    with pytest.raises(TracerError, match=f"thing.bsdf: {said}"):
        scene(shape, folder, bsdf=bsdf)
