"""The vocabulary of scene descriptions: what each object may say, and what it means."""

from difflib import get_close_matches

import numpy as np

from tracer.bsdf import Conductor, Dielectric, Diffuse
from tracer.camera import Camera
from tracer.settings import TracerError
from tracer.shape import Cube, Mesh, Rectangle, Sphere

SHAPES = ("rectangle", "cube", "sphere", "obj", "ply")
BSDFS = ("diffuse", "conductor", "dielectric")
SENSORS = ("perspective",)

# Indices of refraction at 589 nm, by the names Mitsuba uses.
INDICES = {"vacuum": 1.0, "air": 1.000277, "water": 1.333, "bk7": 1.5046, "diamond": 2.419}

_MISSING = object()


def listed(names):
    """Names in one line."""
    return ", ".join(map(str, names))


class Words:
    """A table that is read word by word; finish() names the words nobody asked for."""

    def __init__(self, table, place):
        if not isinstance(table, dict):
            raise TracerError(f"{place}: is {table!r}, but has to be a table with a type")
        self.table, self.place, self._known = table, place, []

    def take(self, word, default=_MISSING):
        """The value of a word; TracerError if it is missing and has no default."""
        self._known.append(word)
        if word in self.table:
            return self.table[word]
        if default is _MISSING:
            raise TracerError(f"{self.place}.{word}: is missing")
        return default

    def finish(self):
        """TracerError for the first word that nothing understood."""
        for word in self.table:
            if word not in self._known:
                near = get_close_matches(word, self._known, 1)
                hint = f"did you mean {near[0]!r}? " if near else ""
                raise TracerError(f"{self.place}.{word}: unknown word; {hint}known here: {listed(self._known)}")


def kind_of(table, place):
    """Whether a named object is a "shape", a "bsdf" or a "sensor"."""
    kind = Words(table, place).take("type")
    for family, known in (("shape", SHAPES), ("bsdf", BSDFS), ("sensor", SENSORS)):
        if kind in known:
            return family
    known = (*SHAPES, *BSDFS, *SENSORS)
    near = get_close_matches(str(kind), known, 1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    raise TracerError(f"{place}.type: {kind!r} is not supported; {hint}known: {listed(known)}")


def real(value, place, least=-np.inf, most=np.inf):
    """A finite number within limits."""
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TracerError(f"{place}: {value!r} is not a number")
    if not np.isfinite(value):
        raise TracerError(f"{place}: {value} is not a finite number")
    if not least <= value <= most:
        limits = f"at least {least:g}" if most == np.inf else f"from {least:g} to {most:g}"
        raise TracerError(f"{place}: {value:g} is out of range; it has to be {limits}")
    return float(value)


def triple(value, place, least=-np.inf, most=np.inf):
    """Three finite numbers within limits, (3,) float64."""
    if not isinstance(value, (list, tuple, np.ndarray)) or len(value) != 3:
        raise TracerError(f"{place}: {value!r} is not a list of three numbers")
    return np.array([real(v, f"{place}[{k}]", least, most) for k, v in enumerate(value)])


def colour(value, place, most=np.inf):
    """A linear RGB colour from a number, three numbers, or {type = "rgb", value = ...}, (3,) float64."""
    if isinstance(value, dict):
        table = Words(value, place)
        if table.take("type") != "rgb":
            raise TracerError(f"{place}.type: {value['type']!r} is not supported; known: rgb")
        value = table.take("value")
        table.finish()
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        value = [value] * 3
    return triple(value, place, 0.0, most)


def bsdf(description, place):
    """A material with one parameter column."""
    table = Words(description, place)
    kind = table.take("type")
    readers = {"diffuse": _diffuse, "conductor": _conductor, "dielectric": _dielectric}
    if kind not in readers:
        raise TracerError(f"{place}.type: {kind!r} is not a material; known: {listed(BSDFS)}")
    material = readers[kind](table)
    table.finish()
    return material


def _diffuse(table):
    return Diffuse(_column(table, "reflectance", 0.5, 1.0))


def _column(table, word, default, most=np.inf):
    return colour(table.take(word, default), f"{table.place}.{word}", most)[:, None]


def _conductor(table):
    material = table.take("material", None)
    factor = _column(table, "specular_reflectance", 1.0, 1.0)
    if material == "none" or (material is None and "eta" not in table.table and "k" not in table.table):
        return Conductor(np.ones((3, 1)), np.full((3, 1), np.inf), factor)
    if material is not None:
        raise TracerError(
            f"{table.place}.material: {material!r} is not known; \"none\" is a perfect mirror, or give eta and k"
        )
    eta = _column(table, "eta", _MISSING)
    return Conductor(eta, _column(table, "k", _MISSING), factor)


def _dielectric(table):
    inside, outside = _index(table, "int_ior", "bk7"), _index(table, "ext_ior", "air")
    return Dielectric(
        np.array([inside / outside]),
        _column(table, "specular_reflectance", 1.0, 1.0),
        _column(table, "specular_transmittance", 1.0, 1.0),
    )


def _index(table, word, default):
    value, place = table.take(word, default), f"{table.place}.{word}"
    if isinstance(value, str):
        if value not in INDICES:
            raise TracerError(f"{place}: {value!r} is not known; give a number or one of {listed(INDICES)}")
        return INDICES[value]
    if real(value, place) <= 0.0:
        raise TracerError(f"{place}: {value:g} is no index of refraction; it has to be above 0")
    return float(value)


def area_emitter(description, place):
    """Radiance (3,) of a shining shape, None if it does not shine."""
    if description is None:
        return None
    table = Words(description, place)
    if table.take("type") != "area":
        raise TracerError(f"{place}.type: {description['type']!r} is not supported on a shape; known: area")
    radiance = colour(table.take("radiance"), f"{place}.radiance")
    table.finish()
    return radiance


def shape(table, folder):
    """A shape; the words for material and emitter are left for the caller to take."""
    kind, place = table.take("type"), table.place
    flip = table.take("flip_normals", False)
    if not isinstance(flip, bool):
        raise TracerError(f"{place}.flip_normals: {flip!r} is neither true nor false")
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
    if not np.allclose(matrix[:3, :3].T @ matrix[:3, :3], scale**2 * np.eye(3), rtol=1e-9, atol=1e-12 * scale**2):
        raise TracerError(f"{place}.to_world: stretches the sphere; scale it evenly, or use a mesh")
    return Sphere(place, matrix[:3, :3] @ center + matrix[:3, 3], radius * scale, flip)


def _mesh(table, matrix, flip, folder):
    from tracer.mesh_file import read

    filename = table.take("filename")
    if not isinstance(filename, str):
        raise TracerError(f"{table.place}.filename: {filename!r} is not the name of a file")
    if table.take("face_normals", True) is not True:
        raise TracerError(f"{table.place}.face_normals: only true is supported: meshes are flat shaded")
    vertices, faces = read(folder / filename, f"{table.place}.filename")
    turned = np.linalg.det(matrix[:3, :3]) < 0.0  # a reflection turns the winding round
    moved = vertices @ matrix[:3, :3].T + matrix[:3, 3]
    return Mesh(table.place, moved, faces[:, ::-1] if turned else faces, flip)


def to_world(steps, place):
    """A 4x4 matrix, from itself or from a list of steps in the order in which they are applied."""
    if np.shape(steps) == (4, 4):
        return _matrix(steps, place)
    if not isinstance(steps, (list, tuple)):
        steps = [steps]
    whole = np.eye(4)
    for k, step in enumerate(steps):
        whole = _transform_step(Words(step, f"{place}[{k}]")) @ whole
    return whole


def _matrix(rows, place):
    try:
        matrix = np.array(rows, np.float64)
    except (TypeError, ValueError):
        raise TracerError(f"{place}: is not a 4 x 4 table of numbers") from None
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or (matrix[3] != [0, 0, 0, 1]).any():
        raise TracerError(f"{place}: is not an affine 4 x 4 matrix of finite numbers with last row 0 0 0 1")
    return matrix


def _transform_step(table):
    known = ("translate", "rotate", "scale", "look_at", "matrix")
    word = next((w for w in known if w in table.table), None)
    if word is None:
        raise TracerError(f"{table.place}: none of {listed(known)} in it")
    place, value = f"{table.place}.{word}", table.take(word)
    matrix = np.eye(4)
    if word == "translate":
        matrix[:3, 3] = triple(value, place)
    elif word == "scale":
        even = isinstance(value, (int, float)) and not isinstance(value, bool)
        matrix[:3, :3] = np.diag(triple([value] * 3 if even else value, place))
    elif word == "rotate":
        angle = real(table.take("angle"), f"{table.place}.angle")
        matrix[:3, :3] = _rotation(triple(value, place), angle, place)
    elif word == "look_at":
        matrix = _look_at(Words(value, place))
    else:
        matrix = _matrix(value, place)
    table.finish()
    return matrix


def _rotation(axis, degrees, place):
    """Rotation about an axis by an angle (Rodrigues); quarter turns are exact."""
    size = np.linalg.norm(axis)
    if size == 0.0:
        raise TracerError(f"{place}: an axis of length 0 turns nothing; give a direction")
    x, y, z = axis / size
    quarter = degrees % 360.0 / 90.0
    if quarter.is_integer():
        cos, sin = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter)]
    else:
        cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    along = np.outer([x, y, z], [x, y, z])
    return cos * np.eye(3) + sin * across + (1.0 - cos) * along


def _look_at(table):
    origin, target, up = (triple(table.take(w), f"{table.place}.{w}") for w in ("origin", "target", "up"))
    table.finish()
    forward = target - origin
    if not np.linalg.norm(np.cross(forward, up)) > 0.0:
        raise TracerError(f"{table.place}: origin, target and up lie on one line; give another up")
    forward = forward / np.linalg.norm(forward)
    left = np.cross(up, forward)
    left = left / np.linalg.norm(left)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack((left, np.cross(forward, left), forward), axis=1)
    matrix[:3, 3] = origin
    return matrix


def sensor(description, place):
    """Camera, width and height."""
    table = Words(description, place)
    table.take("type")
    matrix = to_world(table.take("to_world", []), f"{place}.to_world")
    width, height = _film(table.take("film", {}), f"{place}.film")
    fov = real(table.take("fov"), f"{place}.fov")
    axis = table.take("fov_axis", "x")
    table.finish()
    if not 0.0 < fov < 180.0:
        raise TracerError(f"{place}.fov: {fov:g} degrees is not between 0 and 180")
    if axis not in ("x", "y", "smaller", "larger"):
        raise TracerError(f"{place}.fov_axis: {axis!r} is not known; choose x, y, smaller or larger")
    if np.linalg.det(matrix[:3, :3]) <= 0.0:
        raise TracerError(f"{place}.to_world: flattens or mirrors the view; use look_at")
    if axis == "y" or axis == ("smaller" if height < width else "larger"):
        half = np.tan(np.radians(0.5 * fov)) * width / height
        fov = float(np.degrees(2.0 * np.arctan(half)))
    origin, forward = matrix[:3, 3], matrix[:3, 2]
    return Camera(origin, origin + forward, matrix[:3, 1], fov), width, height


def _film(description, place):
    table = Words(description, place)
    table.take("type", "hdrfilm")
    size = [table.take("width", 256), table.take("height", 256)]
    table.finish()
    for word, value in zip(("width", "height"), size, strict=True):
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= 65535:
            raise TracerError(f"{place}.{word}: {value!r} is not a whole number from 1 to 65535")
    return size
