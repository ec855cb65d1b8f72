"""Smooth shading: normals come from the vertices, and never let light through or a cosine below zero."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from suite import suite_seed

import tracer
from tracer.frame import dot
from tracer.integrator.steps import RIGHT, light_term
from tracer.shape import Mesh

CAMERA = {
    "type": "perspective",
    "fov": 40.0,
    "to_world": [{"look_at": {"origin": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}],
    "film": {"width": 32, "height": 32},
}
LAMP = {
    "type": "rectangle",
    "to_world": [{"rotate": [1, 0, 0], "angle": 90}, {"translate": [0, 3, 1]}],
    "emitter": {"type": "area", "radiance": 5.0},
}
both = pytest.mark.parametrize("precision", [32, 64])
SETTINGS = tracer.Settings(spp=16, seed=suite_seed(), max_depth=6)


def ball(folder, name="ball.ply", subdivisions=2, normals=lambda n: n):
    """A file with a ball of triangles whose vertex normals went through `normals`."""
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
    mesh.vertex_normals = normals(np.array(mesh.vertices))
    mesh.export(folder / name, vertex_normal=True)
    return name


def scene(folder, **shape):
    """A lamp over a mesh."""
    mesh = {"type": "ply", "filename": "ball.ply"} | shape
    return tracer.load_dict({"camera": CAMERA, "lamp": LAMP, "mesh": mesh}, folder=folder)


def hits(scene, settings=SETTINGS):
    """Values of all HIT events on the mesh along one row of pixels."""
    width = settings.at_size_of(scene).width
    records = [tracer.inspect(scene, settings, x, 16) for x in range(width)]
    return [
        event.values
        for record in records
        for path in record.paths
        for event in path.events
        if event.kind.name == "hit" and event.values["shape"] == 1
    ]


def test_a_triangles_own_normal_lies_across_its_sides_and_tells_their_sense():
    corners = np.random.default_rng(4).normal(size=(50, 3, 3))
    mesh = Mesh("m", corners.reshape(-1, 3), np.arange(150).reshape(-1, 3))
    n, offset = mesh.planes()
    a, b, c = corners.transpose(1, 2, 0)
    assert np.allclose(dot(n, n), 1.0) and np.allclose(dot(n, a), offset)
    assert np.abs(dot(n, b - a)).max() < 1e-9 > np.abs(dot(n, c - a)).max()
    assert (dot(n, np.cross(b - a, c - a, axis=0)) > 0.0).all()
    assert np.allclose(replace(mesh, flip_normals=True).planes()[0], -n)


def test_stored_normals_are_interpolated_and_made_unit_again(tmp_path):
    ball(tmp_path)
    for hit in hits(scene(tmp_path)):
        assert abs(np.linalg.norm(hit["n"].astype(np.float64)) - 1.0) < 1e-6
        if (hit["n"] != hit["ng"]).any():
            out = hit["p"] / np.linalg.norm(hit["p"])
            assert out @ hit["n"] > 0.999  # the flat ones reach 0.98 only


@both
def test_s46_the_length_of_stored_normals_does_not_matter(tmp_path, precision):
    ball(tmp_path)
    settings = replace(SETTINGS, precision=precision)
    unit = tracer.render(scene(tmp_path), settings).rgb
    for length in (2.0, 2.0**-20):
        ball(tmp_path, normals=lambda n, length=length: length * n)
        assert (tracer.render(scene(tmp_path), settings).rgb == unit).all()


def test_stretching_a_mesh_gives_no_vertex_more_weight_than_another(tmp_path):
    """As in Mitsuba, with which smooth_dome of `make peers` compares: 0.2 % of the picture otherwise."""
    ball(tmp_path)
    stretched = scene(tmp_path, to_world=[{"scale": [1.4, 1.0, 0.8]}]).shapes[1]
    assert np.abs(np.linalg.norm(stretched.normals, axis=1) - 1.0).max() < 1e-12


@both
@pytest.mark.parametrize("broken", [0.0, float("nan")])
def test_s46_normals_that_are_none_fall_back_to_the_geometric_one(tmp_path, broken, precision):
    ball(tmp_path)
    settings = replace(SETTINGS, precision=precision)
    flat = tracer.render(scene(tmp_path, face_normals=True), settings)
    vertices, faces = (np.asarray(a) for a in scene(tmp_path).shapes[1].triangles())
    definition = scene(tmp_path).definition
    mesh = Mesh("mesh", vertices, faces, normals=np.full(vertices.shape, broken))
    surfaces = (definition.surfaces[0], definition.surfaces[1]._replace(shape=mesh))
    broken_scene = type(scene(tmp_path))(definition._replace(surfaces=surfaces))
    picture = tracer.render(broken_scene, settings)
    assert picture.dropped == 0 and (picture.rgb == flat.rgb).all()


@pytest.mark.slow
def test_normals_move_by_the_inverse_transpose_n03(tmp_path):
    ball(tmp_path, subdivisions=4)
    squeezed = scene(tmp_path, to_world=[{"scale": [1.0, 0.4, 1.0]}])
    for hit in hits(squeezed):
        gradient = hit["p"] / np.array([1.0, 0.16, 1.0])
        assert gradient @ hit["n"] / np.linalg.norm(gradient) > 0.9995


def test_no_cosine_is_negative_and_nothing_leaks(tmp_path):
    ball(tmp_path, subdivisions=1)
    lit = scene(tmp_path)
    for hit in hits(lit):
        assert (dot(hit["n"], hit["wo"]) > 0.0) == (dot(hit["ng"], hit["wo"]) > 0.0)
    inside = LAMP | {"to_world": [{"scale": 0.3}]}
    closed = {"camera": CAMERA, "lamp": inside, "mesh": {"type": "ply", "filename": "ball.ply"}}
    picture = tracer.render(tracer.load_dict(closed, folder=tmp_path), SETTINGS)
    assert (picture.rgb == 0.0).all()


def region(lit, integrator, steps=RIGHT):
    """Mean of the picture over 8 seeds, and its standard error."""
    means = [
        tracer.render(
            lit, tracer.Settings(spp=64, seed=suite_seed() + k, integrator=integrator), steps=steps
        ).rgb.mean(dtype=np.float64)
        for k in range(8)
    ]
    return np.mean(means), np.std(means, ddof=1) / np.sqrt(8)


def brighter(*arguments):
    """The light term with a fault of 15 %, the smallest that the test below claims to see."""
    return 1.15 * light_term(*arguments)


@pytest.mark.slow
@pytest.mark.statistical
def test_the_loops_agree_under_smooth_normals(tmp_path):
    """Means within 4 joint standard errors, which are 2 % or better (two-sided 6e-5, one test)."""
    ball(tmp_path, subdivisions=1)
    lit = scene(tmp_path)
    (a, error_a), (b, error_b) = region(lit, "path"), region(lit, "walk")
    assert error_a < 0.02 * a and error_b < 0.02 * b
    assert abs(a - b) < 4.0 * np.hypot(error_a, error_b)
    wrong, error = region(lit, "direct", replace(RIGHT, light_term=brighter))
    assert abs(wrong - b) > 4.0 * np.hypot(error, error_b)


def test_a_file_without_normals_is_flat_unless_smooth_ones_are_asked_for(tmp_path):
    mesh = trimesh.creation.icosphere(subdivisions=2)
    mesh.export(tmp_path / "ball.ply", vertex_normal=False)
    assert not scene(tmp_path).has_smooth_normals
    assert scene(tmp_path, face_normals=False).has_smooth_normals
    ball(tmp_path)
    assert scene(tmp_path).has_smooth_normals
    assert not scene(tmp_path, face_normals=True).has_smooth_normals
