"""A picture of all that is far away, wrapped around the scene.

Mitsuba's `envmap`: columns run around +y from -z by way of +x, rows from +y down to -y. Texels are points
(the first and the last row are the poles, columns lie at (i + 1/2) / width), and between them the radiance
is bilinear in longitude and latitude. Of the cells between four texels one is chosen with probability
proportional to mean luminance times solid angle, and a direction uniformly within it.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracer.frame import normalize
from tracer.light.sample import IMAGE, far_side, luminance


@dataclass(frozen=True)
class Envmap:
    """image: (H, W, 3) linear radiance, H and W at least 2. to_world: (3, 3) rotation."""

    name: str
    image: np.ndarray
    to_world: np.ndarray
    ball: object = None
    dtype: type = np.float64

    technique = IMAGE

    def __post_init__(self):
        image = self.image
        rows, columns = image.shape[0] - 1, image.shape[1]
        following = np.roll(image, -1, axis=1)
        mean = 0.25 * (image[:-1] + image[1:] + following[:-1] + following[1:])
        cosines = np.cos(np.pi / rows * np.arange(rows + 1))
        cosines[0], cosines[-1] = 1.0, -1.0
        # Differences of these cosines by the sum formula: at the poles they would lose their digits.
        middle = np.pi / rows * (np.arange(rows) + 0.5)
        drops = 2.0 * np.sin(middle) * np.sin(0.5 * np.pi / rows)
        bright = luminance(np.moveaxis(mean, -1, 0))  # (rows, columns)
        weight = bright * (drops * 2.0 * np.pi / columns)[:, None]
        total = weight.sum()
        whole = weight.sum(axis=1)
        across = np.cumsum(weight, axis=1) / np.where(whole > 0.0, whole, 1.0)[:, None]
        across[:, -1] = 1.0
        tables = {
            "cosines": cosines,
            "density": bright / total if total > 0.0 else bright,
            "total": total,
            "down": np.cumsum(whole) / (total if total > 0.0 else 1.0),
            "across": (across + np.arange(rows)[:, None]).ravel(),
        }
        for name, table in tables.items():
            object.__setattr__(self, f"_{name}", table)

    @property
    def light(self):
        """What it sends at most, (3,): the brightest radiance of each channel."""
        return self.image.max(axis=(0, 1))

    def power(self, ball):
        """What enters the scene's ball, (3,) in W; of its luminance in each channel."""
        return np.full(3, np.pi * ball.radius**2 * self._total)

    def ready(self, dtype, ball):
        """The same for one precision and a scene within `ball`; the tables stay in float64."""
        return replace(self, dtype=dtype, ball=ball.astype(dtype))

    def sample(self, p, u):
        """q, normal, wi (3, N), distance (N,), radiance (3, N), and the density of wi in sr^-1."""
        rows, columns = self._density.shape
        down, across = u[0].astype(np.float64), u[1].astype(np.float64)
        row = np.searchsorted(self._down, down, side="right").clip(0, rows - 1)
        below = np.where(row > 0, self._down[row - 1], 0.0)
        down = _share(down, below, self._down[row])
        cell = np.searchsorted(self._across, row + across, side="right").clip(row * columns, None)
        cell = np.minimum(cell, row * columns + columns - 1)
        column = cell - row * columns
        before = np.where(column > 0, self._across[cell - 1] - row, 0.0)
        across = _share(across, before, self._across[cell] - row)
        cos = self._cosines[row] + down * (self._cosines[row + 1] - self._cosines[row])
        sin = np.sqrt(np.maximum((1.0 - cos) * (1.0 + cos), 0.0))
        phi = 2.0 * np.pi * (column + 0.5 + across) / columns
        wi = self._turned(self.to_world, np.stack((sin * np.sin(phi), cos, -sin * np.cos(phi))))
        wi = normalize(wi).astype(self.dtype)
        distance = far_side(p, self.ball)
        # Asked again for the direction as it was rounded: it may have crossed a border.
        return p + wi * distance, -wi, wi, distance, self.radiance(wi), self.pdf(wi)

    def radiance(self, d):
        """Radiance (3, N) from directions d (3, N)."""
        row, column, down, across = self._place(d)
        following = (column + 1) % self.image.shape[1]
        upper = self.image[row, column] * (1 - across) + self.image[row, following] * across
        lower = self.image[row + 1, column] * (1 - across) + self.image[row + 1, following] * across
        return np.ascontiguousarray((upper * (1 - down) + lower * down).T).astype(self.dtype)

    def pdf(self, d):
        """Density (N,) in sr^-1 with which sample gives directions d (3, N)."""
        row, column, _, _ = self._place(d)
        return self._density[row, column].astype(self.dtype)

    def _place(self, d):
        """Cell (row, column (N,)) that directions lie in, and where in it (down, across (N, 1))."""
        rows, columns = self._density.shape
        x, y, z = self._turned(self.to_world.T, d.astype(np.float64))
        down = np.arctan2(np.sqrt(x * x + z * z), y) / np.pi * rows
        across = (np.arctan2(x, -z) / (2.0 * np.pi) % 1.0) * columns - 0.5
        row = np.minimum(down.astype(np.intp), rows - 1)
        column = np.floor(across).astype(np.intp)
        return row, column % columns, (down - row)[:, None], (across - column)[:, None]

    @staticmethod
    def _turned(matrix, d):
        """matrix d for (3, N) d, by element-wise sums: a direction's numbers do not depend on its company."""
        return np.stack([row[0] * d[0] + row[1] * d[1] + row[2] * d[2] for row in matrix])


def _share(value, low, high):
    """Where a number lies between two others, from 0 to 1."""
    return np.clip((value - low) / np.where(high > low, high - low, 1.0), 0.0, 1.0)
