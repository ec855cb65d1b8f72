"""Right-handed cameras, pinhole and thin lens: x to the right, y down the film, looking along `forward`."""

from dataclasses import dataclass

import numpy as np

from tracer.frame import normalize
from tracer.settings import TracerError
from tracer.warp import concentric_disk


@dataclass(frozen=True)
class Camera:
    """Where the picture is taken from.

    origin: (3,); target: (3,) a point in the middle of the picture; up: (3,); fov_x: horizontal field of
    view in degrees; aperture_radius: of a thin lens in metres, 0 for a pinhole; focus_distance: from the lens
    to the plane, at right angles to the view, in which all is sharp (Cook et al. 1984). Raises TracerError
    where these do not span a picture.
    """

    origin: np.ndarray
    target: np.ndarray
    up_hint: np.ndarray
    fov_x: float
    aperture_radius: float = 0.0
    focus_distance: float = 1.0

    def __post_init__(self):
        if not 0.0 < self.fov_x < 180.0:
            raise TracerError(f"sensor.fov: {self.fov_x} degrees is not between 0 and 180")
        for name in ("origin", "target", "up_hint"):
            if not np.isfinite(getattr(self, name)).all():
                raise TracerError(f"sensor.to_world: {name} holds a number that is not finite")
        if not np.linalg.norm(np.cross(self.target - self.origin, self.up_hint)) > 0.0:
            raise TracerError(
                "sensor.to_world: target and up lie on one line, so no side of the picture is up"
            )

    @property
    def forward(self):
        """Unit direction of the view, (3,)."""
        view = self.target - self.origin
        return view / np.linalg.norm(view)

    @property
    def right(self):
        """Unit direction of growing x, (3,)."""
        side = np.cross(self.forward, self.up_hint)
        return side / np.linalg.norm(side)

    @property
    def up(self):
        """Unit direction of shrinking y, (3,)."""
        return np.cross(self.right, self.forward)

    def rays(self, film, width, height, dtype, lens=None):
        """Origins and unit directions, both (3, N), through film positions (2, N) in pixels.

        lens: (2, N) random numbers where there is an aperture: rays then start evenly over it, and go to
        where the pinhole's meet the plane of focus.
        """
        half = np.tan(np.radians(0.5 * self.fov_x))
        x = (film[0] * dtype(2.0 / width) - dtype(1.0)) * dtype(half)
        y = (dtype(height / width) - film[1] * dtype(2.0 / width)) * dtype(half)
        forward, right, up = (v.astype(dtype).reshape(3, 1) for v in (self.forward, self.right, self.up))
        view = forward + right * x + up * y
        origin = self.origin.astype(dtype).reshape(3, 1)
        if lens is None:
            d = normalize(view)
            return np.broadcast_to(origin, d.shape), d
        x, y = dtype(self.aperture_radius) * concentric_disk(lens)
        aside = right * x + up * y
        return origin + aside, normalize(view * dtype(self.focus_distance) - aside)
