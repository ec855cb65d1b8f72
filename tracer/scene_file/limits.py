"""Which sizes a scene may have: those for which single precision holds an area squared."""

import numpy as np

from tracer.settings import TracerError

SMALLEST, LARGEST = 1e-9, 1e9  # metres


def check(surfaces, camera):
    """TracerError naming the first shape that is too far away, too large or too small."""
    for surface in surfaces:
        corners = surface.shape.triangles()[0]
        reach, size = np.abs(corners).max(), np.ptp(corners, axis=0).max()
        name = surface.shape.name
        if reach > LARGEST:
            raise TracerError(f"{name}: reaches {reach:g} from the origin; the limit is {LARGEST:g}")
        if size < SMALLEST:
            raise TracerError(f"{name}: is only {size:g} large; the limit is {SMALLEST:g}")
    reach = np.abs(camera.origin).max() + camera.aperture_radius
    if max(reach, camera.focus_distance) > LARGEST:
        raise TracerError(f"sensor.to_world: is more than {LARGEST:g} from the origin or from its focus")
