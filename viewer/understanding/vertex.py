"""One recorded surface point, asked for many directions as a reader sees them.

Shown directions are local, turned about n until wo lies to the left. On the disc of a hemisphere equal areas
are equal solid angles (Lambert's projection), so that dots are as dense there as p is large.
"""

import numpy as np

from viewer.numerals import LUMINANCE
from viewer.understanding.surface import Surface

SIDE = 41  # cells along a disc
UPRIGHT = 1e-6  # sine of wo's angle below which the lens is not turned


class Vertex:
    """A HIT's values and what the scene (at the record's settings) says there.

    sides: +1 above the normal and -1 below it, those that can be seen or reached.
    """

    def __init__(self, scene, hit):
        self.scene, self.hit = scene, hit
        x, y, z = (float(v) for v in Surface(scene, [hit]).wo[:, 0])
        through = scene.is_see_through(int(hit["shape"]))
        self.sides = (1.0, -1.0) if through else (float(np.copysign(1.0, z)),)
        across = np.hypot(x, y)
        self._turn = (-x / across, -y / across) if across > UPRIGHT else (1.0, 0.0)

    def times(self, n):
        """Its Surface, n times."""
        return Surface(self.scene, [self.hit], n)

    def shown(self, w):
        """World directions (3, N) as the reader sees them."""
        return self.turned(self.times(1).frame.to_local(w.astype(self.scene.dtype)))

    def turned(self, local):
        """Directions (3, N) of the frame as the reader sees them."""
        c, s = self._turn
        return np.stack((c * local[0] + s * local[1], c * local[1] - s * local[0], local[2])).astype(float)

    def world(self, shown):
        """Shown directions (3, N) as the scene has them."""
        return self._world(shown, self.times(1))

    def _world(self, shown, surface):
        c, s = self._turn
        local = np.stack((c * shown[0] - s * shown[1], s * shown[0] + c * shown[1], shown[2]))
        return surface.frame.to_world(local.astype(self.scene.dtype))

    def asked(self, shown):
        """Luminance of f |cos| (N,) and p (N,) along shown directions (3, N)."""
        surface = self.times(shown.shape[1])
        wi = self._world(shown, surface)
        f = np.tensordot(LUMINANCE, surface.f(wi).astype(float), axes=1)
        return f * np.abs(shown[2]), surface.pdf(wi).astype(float)

    def sheet(self, side):
        """f |cos| and p, each (SIDE, SIDE) over the disc of a side, NaN outside of it."""
        place = (np.arange(SIDE) + 0.5) / SIDE * 2.0 - 1.0
        a, b = (v.ravel() for v in np.meshgrid(place, place))
        r2 = a * a + b * b
        inside = r2 < 1.0
        found = self.asked(off_disc(np.stack((a[inside], b[inside])), side))
        sheets = np.full((2, SIDE * SIDE), np.nan)
        sheets[:, inside] = found
        return sheets.reshape(2, SIDE, SIDE)


def on_disc(shown):
    """Places (2, N) on the disc, of radius 1, of directions (3, N)."""
    return shown[:2] / np.sqrt(1.0 + np.abs(shown[2]))


def off_disc(place, side):
    """Directions (3, N) of a side at places (2, N) on the disc: what `on_disc` undoes."""
    r2 = (place * place).sum(axis=0)
    return np.concatenate((place * np.sqrt(2.0 - r2), side * (1.0 - r2)[None]))
