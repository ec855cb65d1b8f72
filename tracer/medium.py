"""Coloured glass: what fills closed shapes, and which medium lies on which side of a surface.

Of the light that goes a way t through a medium the share exp(-sigma_t t) is left, in each channel (Beer and
Lambert's law: Pharr et al. 2023, 11.2). Nothing is scattered.

A path carries the number of the medium it travels in; 0 is empty. Where a ray leaves a surface that bounds a
medium, the side it leaves to decides: behind a filled shape lies its medium, in front of it that of the
innermost filled shape around it, or nothing. A clear glass inside coloured glass (a bubble) is empty. What
else stands inside, opaque things above all, changes nothing. The camera's medium is that of where it stands;
its lens is taken to lie there as a whole.

Shapes may lie in one another but must not overlap: where they do, the surface met last decides, and the
index of refraction would be wrong, too. What fills an open shape or one turned inside out cannot be said, so
that is refused when a scene is loaded.
"""

from typing import NamedTuple

import numpy as np

from tracer.frame import dot
from tracer.lanes import gather

_SAME = -1  # in front and back: the surface bounds no medium
_WITNESSES = 9  # points of a shape that tell where it lies: one may touch what is around it


class Media(NamedTuple):
    """The media of a scene, by number.

    front and back are per shape as `around` gives it, per primitive as a Scene needs it.
    """

    sigma_t: np.ndarray  # (3, M) share lost per metre; 0 in the empty medium 0
    front: np.ndarray  # (S,) medium on the side of the normals
    back: np.ndarray  # (S,) medium on the other
    camera: int  # medium at the camera

    def of_shapes(self, kept):
        """The same for some of the shapes, by number."""
        return self._replace(front=self.front[kept], back=self.back[kept])

    def of_primitives(self, shape_of, dtype):
        """The same per primitive, of the shapes `shape_of`, in one precision."""
        return Media(
            self.sigma_t.astype(dtype), gather(self.front, shape_of), gather(self.back, shape_of), self.camera
        )

    @property
    def bounding(self):
        """Whether each surface has different media on its sides, (S,)."""
        return self.front != self.back

    def towards(self, hit, wi, medium):
        """Medium (N,) of rays that leave hits along wi (3, N), which came there through `medium` (N,)."""
        behind = np.signbit(dot(hit.ng, wi))  # as `leave` chooses the side
        beyond = np.where(behind, gather(self.back, hit.primitive), gather(self.front, hit.primitive))
        return np.where(beyond == _SAME, medium, beyond)

    def transmittance(self, medium, distance):
        """exp(-sigma_t t), (3, N), for `medium` and distance in metres (N,)."""
        return np.exp(-gather(self.sigma_t, medium) * distance)


def around(surfaces, bsdfs, eye):
    """The Media of surfaces whose materials are `bsdfs` by name, seen from eye (3,); None if nothing is
    filled."""
    filled = [k for k, s in enumerate(surfaces) if s.interior is not None]
    if not filled:
        return None
    number = {k: 1 + n for n, k in enumerate(filled)}  # 0 for clear glass
    solid = [k for k, s in enumerate(surfaces) if k in number or _is_clear_glass(s, bsdfs)]
    holders = {k: [o for o in solid if o != k and _lies_in(surfaces[k], surfaces[o])] for k in solid}

    def innermost(those):
        """Medium of the shape that most others are around."""
        return number.get(max(those, key=lambda k: len(holders[k])), 0) if those else 0

    front, back = (np.full(len(surfaces), _SAME, np.int32) for _ in range(2))
    for k in solid:
        sides = innermost(holders[k]), number.get(k, 0)
        if any(sides):
            front[k], back[k] = sides if surfaces[k].shape.turned > 0 else sides[::-1]
    sigma_t = np.stack([np.zeros(3), *(surfaces[k].interior for k in filled)], axis=1)
    at_eye = [k for k in solid if surfaces[k].shape.holds(eye[:, None])[0]]
    return Media(sigma_t, front, back, innermost(at_eye))


def _is_clear_glass(surface, bsdfs):
    material = bsdfs[surface.bsdf]
    return material.see_through and not material.thin and surface.shape.turned != 0


def _lies_in(surface, other):
    """Whether a shape lies within another one, told by some of its corners."""
    corners = surface.shape.triangles()[0]
    some = corners[np.linspace(0, len(corners) - 1, min(_WITNESSES, len(corners))).astype(int)].T
    return 2 * np.count_nonzero(other.shape.holds(some)) > some.shape[1]
