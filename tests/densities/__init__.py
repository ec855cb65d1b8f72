"""Every sampler of castray against its density, by chi-square: what is counted and what is expected."""

from densities import bsdfs, lights, lobes, normals, warps
from densities.sampler import Sampler

FAMILIES = (warps, normals, lobes, bsdfs, lights)
SAMPLERS = {sampler.name: sampler for family in FAMILIES for sampler in family.samplers()}

__all__ = ["FAMILIES", "SAMPLERS", "Sampler"]
