"""A picture on a surface."""

from dataclasses import dataclass, replace

import numpy as np

from tracer.texture.moved import moved

FILTERS = ("bilinear", "nearest")
WRAPS = ("repeat", "mirror", "clamp")


@dataclass(frozen=True)
class Bitmap:
    """Mitsuba's `bitmap`. Texels are squares with their value in the middle; u runs along the rows, v from
    the first row to the last, so that a picture stands upright where v runs down.

    filter_type: "bilinear" between the four nearest texels, or "nearest", the texel itself. wrap_mode: how
    the picture goes on beyond its borders: again ("repeat"), turned over ("mirror"), or with what is at the
    border ("clamp").
    """

    texels: np.ndarray  # (3, H, W) linear RGB
    to_uv: np.ndarray  # (2, 3)
    filter_type: str = "bilinear"
    wrap_mode: str = "repeat"

    def mean(self):
        """Average over the picture, (3,)."""
        return self.texels.mean(axis=(1, 2))

    def astype(self, dtype):
        """The same in another precision."""
        return replace(self, texels=self.texels.astype(dtype))

    def at(self, uv):
        """The picture at coordinates (2, N), (3, N)."""
        _, height, width = self.texels.shape
        u, v = moved(self.to_uv, uv)
        x, y = u * u.dtype.type(width), v * v.dtype.type(height)
        if self.filter_type == "nearest":
            return self._texel(np.floor(x), np.floor(y))
        x, y = x - 0.5, y - 0.5
        column, row = np.floor(x), np.floor(y)
        x, y = x - column, y - row
        above = self._between(column, row, x)
        return above + y * (self._between(column, row + 1.0, x) - above)

    def _between(self, column, row, x):
        """Along a row, the share x of the way from a column to the next."""
        left = self._texel(column, row)
        return left + x * (self._texel(column + 1.0, row) - left)

    def _texel(self, column, row):
        """The texels (3, N) of any columns and rows, whole numbers in floating point."""
        _, height, width = self.texels.shape
        place = self._wrapped(row, height) * width + self._wrapped(column, width)
        return self.texels.reshape(3, -1).take(place, axis=1)

    def _wrapped(self, k, size):
        """Whole numbers within the picture, as integers."""
        if self.wrap_mode == "clamp":
            return np.clip(k, 0, size - 1).astype(np.intp)
        if self.wrap_mode == "repeat":
            return np.mod(k, size).astype(np.intp)
        k = np.mod(k, 2 * size).astype(np.intp)
        return np.minimum(k, 2 * size - 1 - k)
