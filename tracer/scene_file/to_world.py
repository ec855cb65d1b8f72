"""Transforms as scenes write them: a matrix, or steps in the order in which they are applied."""

import numpy as np

from tracer.scene_file.words import LARGEST, Words, listed, real, triple
from tracer.settings import TracerError


def to_world(steps, place):
    """A 4x4 matrix, from itself or from a list of steps in the order in which they are applied."""
    if isinstance(steps, np.ndarray) or _is_list_of(steps, (list, tuple)):
        return _matrix(steps, place)
    if not isinstance(steps, (list, tuple)):
        steps = [steps]
    whole = np.eye(4)
    for k, step in enumerate(steps):
        whole = _transform_step(Words(step, f"{place}[{k}]")) @ whole
        if not np.abs(whole).max() <= LARGEST:
            raise TracerError(f"{place}[{k}]: takes something to more than {LARGEST:g} times its size")
    return whole


def _is_list_of(value, kinds):
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(v, kinds) for v in value)


def _matrix(rows, place):
    try:
        matrix = np.array(rows, np.float64)
    except (TypeError, ValueError, OverflowError):
        raise TracerError(f"{place}: is not a 4 x 4 table of numbers") from None
    if matrix.shape != (4, 4) or not (np.abs(matrix) <= LARGEST).all() or (matrix[3] != [0, 0, 0, 1]).any():
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
        cos, sin = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
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
