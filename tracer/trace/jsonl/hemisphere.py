"""How a program chooses directions that neither declares it nor logs their density."""

import numpy as np

from tracer.bsdf.diffuse import Diffuse
from tracer.frame import dot

_BETWEEN = 7.0 / 12.0  # of the mean cosines: 1/2 of uniform directions, 2/3 of those that follow the cosine


def shown(chain, places, scene):
    """The hemisphere that directions from diffuse surfaces show by their mean cosine; None if there are none.

    It tells which of the two is meant, not whether either is right: that is for the doctor."""
    on = np.flatnonzero(~chain.last & places.hit)
    kinds = np.array([isinstance(bsdf, Diffuse) for bsdf in scene.definition.bsdfs.values()])
    on = on[kinds.take(scene.bsdf_of.take(np.maximum(places.primitive[on], 0)))]
    if not on.size:
        return None
    cosines = np.abs(dot(places.n[:, on], places.d[:, on + 1]))
    return "uniform" if np.nanmean(cosines) < _BETWEEN else "cosine"
