"""The vocabulary of scene descriptions: what each object may say, and what it means."""

import numpy as np

from tracer.camera import Camera
from tracer.scene_file.emitters import EMITTERS
from tracer.scene_file.materials import BSDFS
from tracer.scene_file.textures import TEXTURES
from tracer.scene_file.to_world import to_world
from tracer.scene_file.words import Words, listed, near, real, shown, switch, triple
from tracer.settings import TracerError
from tracer.shape import Cube, Mesh, Rectangle, Sphere
from tracer.shape.transform import check_invertible, determinant

SHAPES = ("rectangle", "cube", "sphere", "obj", "ply", "stl", "gltf")
SENSORS = ("perspective", "thinlens")


def kind_of(table, place):
    """Whether a named object is a "shape", a "bsdf", a "texture", an "emitter" or a "sensor"."""
    kind = Words(table, place).take("type")
    families = {
        "shape": SHAPES,
        "bsdf": BSDFS,
        "texture": TEXTURES,
        "emitter": EMITTERS,
        "sensor": SENSORS,
    }
    for family, known in families.items():
        if kind in known:
            return family
    everything = [word for known in families.values() for word in known]
    hint = near(kind, everything)
    raise TracerError(f"{place}.type: {shown(kind)} is not supported; {hint}known: {listed(everything)}")


def shape(table, folder):
    """A shape; the words for material and emitter are left for the caller to take."""
    kind, place = table.take("type"), table.place
    flip = switch(table, "flip_normals", False)
    matrix = to_world(table.take("to_world", []), f"{place}.to_world")
    if kind == "rectangle":
        return Rectangle(place, matrix, flip)
    if kind == "cube":
        return Cube(place, matrix, flip)
    if kind == "sphere":
        return _sphere(table, matrix, flip)
    return _mesh(table, matrix, flip, folder)


def _sphere(table, matrix, flip):
    place = table.place
    center = triple(table.take("center", [0.0, 0.0, 0.0]), f"{place}.center")
    radius = real(table.take("radius", 1.0), f"{place}.radius", 0.0)
    scale = np.linalg.norm(matrix[:3, 0])
    if not np.allclose(
        matrix[:3, :3].T @ matrix[:3, :3], scale**2 * np.eye(3), rtol=1e-9, atol=1e-12 * scale**2
    ):
        raise TracerError(f"{place}.to_world: stretches the sphere; scale it evenly, or use a mesh")
    return Sphere(
        place, matrix[:3, :3] @ center + matrix[:3, 3], radius * scale, flip, matrix[:3, :3] / scale
    )


def _mesh(table, matrix, flip, folder):
    from tracer.scene_file.mesh_file import read, unit

    filename = table.take("filename")
    if not isinstance(filename, str):
        raise TracerError(f"{table.place}.filename: {shown(filename)} is not the name of a file")
    flat = switch(table, "face_normals", None)
    smooth = None if flat is None else not flat
    upside_down = False  # Mitsuba's words and defaults; OBJ counts v from the bottom, pictures from the top
    if table.table["type"] in ("obj", "ply"):
        upside_down = switch(table, "flip_tex_coords", table.table["type"] == "obj")
    vertices, faces, normals, uv = read(folder / filename, f"{table.place}.filename", smooth)
    if uv is not None and upside_down:
        uv[..., 1] = 1.0 - uv[..., 1]
    turned = determinant(matrix[:3, :3]) < 0.0  # a reflection turns the winding round
    moved = vertices @ matrix[:3, :3].T + matrix[:3, 3]
    try:
        if normals is not None:
            check_invertible(matrix, table.place)
            moved_by = np.linalg.inv(matrix[:3, :3])  # the inverse transpose, from the right
            normals = unit(normals @ moved_by)  # so that all weigh the same between them
        if turned:
            faces, uv = faces[:, ::-1], None if uv is None else uv[:, ::-1]
        return Mesh(table.place, moved, faces, flip, normals, uv)
    except TracerError as error:
        raise TracerError(f"{error} ({folder / filename})") from None


def sensor(description, place):
    """Camera, width and height."""
    table = Words(description, place)
    lens = _lens(table) if table.take("type") == "thinlens" else ()
    matrix = to_world(table.take("to_world", []), f"{place}.to_world")
    width, height = _film(table.take("film", {}), f"{place}.film")
    fov = real(table.take("fov"), f"{place}.fov")
    axis = table.take("fov_axis", "x")
    table.finish()
    if not 0.0 < fov < 180.0:
        raise TracerError(f"{place}.fov: {fov:g} degrees is not between 0 and 180")
    if not isinstance(axis, str) or axis not in ("x", "y", "smaller", "larger"):
        raise TracerError(f"{place}.fov_axis: {shown(axis)} is not known; choose x, y, smaller or larger")
    if determinant(matrix[:3, :3]) <= 0.0:
        raise TracerError(f"{place}.to_world: flattens or mirrors the view; use look_at")
    if axis == "y" or axis == ("smaller" if height < width else "larger"):
        half = np.tan(np.radians(0.5 * fov)) * width / height
        fov = float(np.degrees(2.0 * np.arctan(half)))
    origin, forward = matrix[:3, 3], matrix[:3, 2]
    return Camera(origin, origin + forward, matrix[:3, 1], fov, *lens), width, height


def _lens(table):
    """Radius of the aperture and distance of the plane that is sharp."""
    size = [real(table.take(word), f"{table.place}.{word}") for word in ("aperture_radius", "focus_distance")]
    for word, value in zip(("aperture_radius", "focus_distance"), size, strict=True):
        if value <= 0.0:
            hint = '; for none, say type = "perspective"' if word == "aperture_radius" else ""
            raise TracerError(f"{table.place}.{word}: {value:g} is not above 0{hint}")
    return size


def _film(description, place):
    table = Words(description, place)
    table.take("type", "hdrfilm")
    size = [table.take("width", 256), table.take("height", 256)]
    table.finish()
    for word, value in zip(("width", "height"), size, strict=True):
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= 65535:
            raise TracerError(f"{place}.{word}: {shown(value)} is not a whole number from 1 to 65535")
    return size
