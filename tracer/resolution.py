"""What a precision can hold: how far from the origin a scene may lie for the size of its shapes, and how dim
its lamps may be.

Numbers of one precision lie apart by their spacing, which grows with distance from the origin. A rectangle
reaches past its edges by so many spacings that two which share an edge leave no gap: its area is too large by
110 spacings over its side. Measured with cornell_unit moved away in float32, a million paths a picture,
against float64 at the origin: where the lamp is 6800 spacings across there is 1.1 % too much light, which the
z-test cannot tell (|Z| 2.0); at 3400 it is 2.1 % and the test rejects (3.9), at 850 it is 10 %. Cubes,
spheres and meshes are right to 0.1 % down to 400 spacings, but for single samples at the rim of glass balls.
"""

import numpy as np

from tracer.shape import Rectangle

FEWEST = {Rectangle: 4096.0}  # spacings across a shape
FEWEST_BODY = 512.0
DIMMEST = 2.0**20  # smallest normal numbers in a lamp's light, so that what a path leaves of it is normal

_BITS = {np.dtype(np.float32): ("single", 32), np.dtype(np.float64): ("double", 64)}


def refusal(definition, dtype):
    """Why this precision cannot hold a scene's definition, in one line; None if it can."""
    return _too_far(definition, dtype) or _too_dim(definition, dtype)


def _too_far(definition, dtype):
    surfaces, camera = definition.surfaces, definition.camera
    reach = np.abs(camera.origin).max() + camera.aperture_radius
    for surface in surfaces:
        reach = max(reach, np.abs(surface.shape.triangles()[0]).max())
    spacing = float(np.spacing(dtype(reach)))
    for surface in surfaces:
        shape = surface.shape
        if shape.across < FEWEST.get(type(shape), FEWEST_BODY) * spacing:
            return (
                f"{shape.name}: is {shape.across:g} m across in a scene that reaches {reach:g} m from the "
                f"origin, where {_named(dtype)} keeps points {spacing:.2g} m apart; "
                f"{_remedy(dtype)}move the scene nearer to the origin"
            )
    return None


def _too_dim(definition, dtype):
    least = DIMMEST * float(np.finfo(dtype).tiny)
    shining = [s for s in definition.surfaces if s.radiance is not None]
    lamps = [(f"{s.shape.name}.emitter", s.radiance) for s in shining]
    for place, light in lamps + [(e.name, e.light) for e in definition.emitters]:
        dim = light[(light > 0.0) & (light < least)]
        if dim.size:
            return (
                f"{place}: {dim[0]:g} is dimmer than the {least:.2g} that {_named(dtype)} can take along a "
                f"path; {_remedy(dtype)}make it brighter"
            )
    return None


def _named(dtype):
    return f"{_BITS[np.dtype(dtype)][0]} precision"


def _remedy(dtype):
    return "use precision 64, or " if dtype == np.float32 else ""
