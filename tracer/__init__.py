"""castray's path tracer: arrays in, arrays out. It knows no window, no web, no lesson.

Conventions, stated here and nowhere else:

- Arrays are component-first: a direction is (3, N), a density (N,), one lane per path; (N, 3) only at the
  seams (mesh files, drawing).
- wo points back along the path, wi to where light may come from; both leave the surface, both are unit.
- Local frame: z is the shading normal. f never contains the cosine.
- Densities are per solid angle unless the name says pdf_area. At a Dirac lobe f is the scattered fraction
  and the density a probability, flagged `delta`: the lobe's 1/cos cancels the cosine of the equation.
- Radiance is linear RGB. Pixels: x to the right, y down, (0, 0) top left; pictures are (H, W, 3) float32.
- The camera is right-handed. Lengths are in metres.
- float32 unless Settings(precision=64); the film adds in float64.
- max_depth: 1 = emission seen directly, 2 = plus direct light, -1 = unlimited. The event field `depth` is 0
  at the first hit.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tracer.doctor import examine
    from tracer.engine import inspect, render
    from tracer.film import fold
    from tracer.picture import read, write
    from tracer.scene_file import SceneWarning, export
    from tracer.scene_file.load import built_in_scenes, load, load_dict
    from tracer.settings import Settings, TracerError
    from tracer.trace import read_trace, record

__all__ = [
    "SceneWarning",
    "Settings",
    "TracerError",
    "built_in_scenes",
    "examine",
    "export",
    "fold",
    "inspect",
    "load",
    "load_dict",
    "read",
    "read_trace",
    "record",
    "render",
    "write",
]

# Where each public name lives. Its module is imported when the name is first used: who only wants a BSDF
# does not wait for the engine.
_HOME = {
    "tracer.doctor": ("examine",),
    "tracer.engine": ("inspect", "render"),
    "tracer.film": ("fold",),
    "tracer.picture": ("read", "write"),
    "tracer.scene_file": ("SceneWarning", "built_in_scenes", "export", "load", "load_dict"),
    "tracer.settings": ("Settings", "TracerError"),
    "tracer.trace": ("read_trace", "record"),
}


def __getattr__(name):
    for home, names in _HOME.items():
        if name in names:
            globals()[name] = value = getattr(import_module(home), name)
            return value
    raise AttributeError(f"module 'tracer' has no attribute {name!r}")


def __dir__():
    return sorted({*globals(), *__all__})
