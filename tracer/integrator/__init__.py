"""Three complete loops, simple before good, each a generator of events.

    for event in path(scene, settings, wave): ...

Exhaust one: a render. Keep what it yields: a recording. Call next(): a step. They solve the same equation
(Kajiya 1986) and differ in how they find the light.
"""

from tracer.integrator.direct import direct
from tracer.integrator.path import path
from tracer.integrator.walk import walk

ALL = {"path": path, "direct": direct, "walk": walk}
