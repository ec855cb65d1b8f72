"""How surfaces scatter light. One file per material; each class has the same three methods.

    eval(wo, wi) -> f          (3, N) in sr^-1, never with the cosine
    pdf(wo, wi) -> density     (N,) in sr^-1 with which sample would give wi
    sample(wo, u) -> Sample    from u (3, N): choice of the lobe, then the direction

Directions are local (z is the shading normal), unit, and leave the surface. Parameters are arrays whose
last axis is one column per material, or one per lane after `take`. `one_sided` materials reflect on the side
of the normal only.

A Dirac lobe has no value in any given direction: eval and pdf leave it out, and sample gives the scattered
fraction as f and a probability as pdf, flagged `delta`, because the lobe's own 1/cos cancels the cosine.
A material may have lobes of both sorts; where it has nothing else, its class says `delta` too and no light is
sampled there. pdf counts the probability of choosing the lobe.
Adding a material: its file, and its name in ALL; the tests of all materials then hold for it too. What smooth
and rough ones share stands in `metal`, `glass` and `coat`.
"""

from tracer.bsdf.conductor import Conductor
from tracer.bsdf.dielectric import Dielectric
from tracer.bsdf.diffuse import Diffuse
from tracer.bsdf.plastic import Plastic
from tracer.bsdf.roughconductor import RoughConductor
from tracer.bsdf.roughdielectric import RoughDielectric
from tracer.bsdf.roughplastic import RoughPlastic
from tracer.bsdf.thindielectric import ThinDielectric
from tracer.bsdf.twosided import TwoSided

ALL = (
    Diffuse,
    Conductor,
    Dielectric,
    ThinDielectric,
    RoughConductor,
    RoughDielectric,
    Plastic,
    RoughPlastic,
    TwoSided,
)
