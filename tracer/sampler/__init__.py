"""Random numbers as a pure function of (seed, pixel, sample, depth, use): no state anywhere.

Any path can therefore be traced again, alone or in any company, and is the same path. Numbers never depend on
how many samples there will be. Two samplers:

- `independent` (the default): every number for itself. The spread of a pixel's samples is then its error.
- `lattice`: a pixel's samples fill the space of paths evenly, so that their mean is more often near. Their
  spread says nothing of its error; that takes several independent lattices (settings.replicates).

Independent is the default because the debugger shows samples, and what it shows of them (error bars, tests of
two pictures, one sample against another) is then true without a second thought. For a picture alone take
the lattice.
"""

from tracer.sampler.independent import Independent
from tracer.sampler.lattice import Lattice
from tracer.sampler.numbers import USES, pack_pixel, pcg4d

__all__ = ["USES", "Independent", "Lattice", "of", "pack_pixel", "pcg4d"]


def of(settings):
    """The sampler that the settings ask for."""
    if settings.sampler == "lattice":
        return Lattice(settings.seed, settings.dtype, settings.replicates)
    return Independent(settings.seed, settings.dtype)
