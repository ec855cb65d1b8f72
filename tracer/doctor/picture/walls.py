"""What a picture does to each object: its mean over the pixels that show it, beside the right one."""

from dataclasses import dataclass

import numpy as np

from tracer.doctor.picture.features import CELLS, resampled

_MOSTLY = 0.75  # of what a cell shows: one object
_FEW = 6  # pixels well inside an object; with fewer those at its edge count, too

_OTHERS = 3  # objects from which on one can be unlike the others
_STRANGE = np.log(1.8)  # noise and what a neighbour reflects stay below


@dataclass(frozen=True)
class Wall:
    """An object in the picture: ratio (3,) of its mean colour to the right one, NaN where that is black; its
    share of the pixels; cells (8, 8) bool that show little else."""

    name: str
    ratio: np.ndarray
    share: float
    cells: np.ndarray


def shown(scene, height, width, step=1):
    """Number of the shape that each pixel's centre shows, (H, W); -1 for none. step: of columns, to look at
    some of them only."""
    columns = np.arange(0, width, step) + 0.5
    x, y = np.meshgrid(columns, np.arange(height) + 0.5)
    film = np.stack((x.ravel(), y.ravel())).astype(scene.dtype)
    lens = np.full_like(film, 0.5)
    o, d = scene.camera.rays(film, width, height, scene.dtype, lens)
    with np.errstate(all="ignore"):  # a ray along a wall
        _, primitive = scene.intersect(o, d, np.full(film.shape[1], -1, np.int32))
    return np.where(primitive >= 0, scene.shape_of[primitive], -1).reshape(height, columns.size)


def walls(rgb, right, scene, eight_bits):
    """A Wall for each object that a picture shows; right: (H, W, 3), the right one."""
    height, width = right.shape[:2]
    shape = shown(scene, height, width)
    known = np.isfinite(rgb).all(axis=2, keepdims=True)
    count = resampled(known.astype(np.float64), height, width)
    mine = resampled(np.where(known, rgb, 0.0), height, width) / np.maximum(count, 1e-9)
    should = np.clip(right, 0.0, 1.0) if eight_bits else right
    coarse = tuple(resampled(picture, CELLS, CELLS) for picture in (mine, should))  # what `predicted` has
    inside, filled = _inside(shape), resampled((shape >= 0).astype(np.float64), CELLS, CELLS)
    for number in np.unique(shape):
        if number < 0:
            continue
        here = shape == number
        deep = here & inside
        used = deep if deep.sum() >= _FEW else here
        cells = resampled(here.astype(np.float64), CELLS, CELLS) > _MOSTLY * filled
        a, b, used = (*coarse, cells) if cells.any() else (mine, should, used)
        ratio = _over(a[used].mean(axis=0), b[used].mean(axis=0))
        yield Wall(scene.shapes[number].name, ratio, float(here.mean()), cells)


def predicted(wall, looks, right, eight_bits):
    """The ratio (3,) that a tracer with those Features would have there; None where no cell tells."""
    if looks is None or not wall.cells.any():
        return None
    a, b = (f.mean if eight_bits else f.bright for f in (looks, right))
    return _over(a[wall.cells].mean(axis=0), b[wall.cells].mean(axis=0))


def strangest(walls):
    """(the Wall that is off most unlike the others, whether in colour rather than in brightness); (None,
    False) where none stands out."""
    seen = [wall for wall in walls if np.isfinite(wall.ratio).all() and (wall.ratio > 0.0).all()]
    if len(seen) < _OTHERS:
        return None, False
    off = np.log([wall.ratio for wall in seen])
    bright = off.mean(axis=1)
    for size, coloured in (
        (np.abs(off - bright[:, None]).max(axis=1), True),
        (np.abs(bright - np.median(bright)), False),
    ):
        first, second = np.argsort(-size, kind="stable")[:2]
        if size[first] > max(_STRANGE, 2.0 * size[second]):
            return seen[first], coloured
    return None, False


def _over(a, b):
    return np.where(b > 1e-6, a / np.maximum(b, 1e-6), np.nan)


def _inside(shape):
    """Pixels whose neighbours all show the same."""
    around = np.pad(shape, 1, mode="edge")
    same = np.ones(shape.shape, bool)
    for dy in (0, 1, 2):
        for dx in (0, 1, 2):
            same &= around[dy : dy + shape.shape[0], dx : dx + shape.shape[1]] == shape
    return same
