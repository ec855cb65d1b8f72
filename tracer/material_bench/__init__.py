"""One material on the bench: what holds of it, with the figure found, and what it looks like in numbers.

    from tracer.material_bench import albedo, properties
    from tracer.scene_file.materials import bsdf
    properties(bsdf({"type": "roughconductor", "material": "Au"}, "gold"))

Every function takes a material with one column of float64 parameters and gives plain arrays.
"""

from tracer.material_bench.counts import Histogram, histogram
from tracer.material_bench.curves import dirac_lobes, fresnel_curves, lobes
from tracer.material_bench.energy import albedo, sides, towards, weights
from tracer.material_bench.laws import TILTS, Property, physical, properties

__all__ = [
    "TILTS",
    "Histogram",
    "Property",
    "albedo",
    "dirac_lobes",
    "fresnel_curves",
    "histogram",
    "lobes",
    "physical",
    "properties",
    "sides",
    "towards",
    "weights",
]
