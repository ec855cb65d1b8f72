"""Which engine `auto` takes."""

from tracer.engine.gl.device import is_hardware, largest, renderer
from tracer.engine.gl.refusals import of_size, reasons
from tracer.engine.gl.shape_tables import size
from tracer.settings import TracerError


def faster(scene, settings, steps):
    """("gl" or "numpy", why): gl where a graphics card draws, and it can do all that is asked."""
    against = next(reasons(scene.at(settings), settings, steps), None)
    if against:
        return "numpy", f"gl cannot do {against}"
    try:
        found = of_size(size(scene.at(settings)), largest())
        against = by_processor() or (found and f"gl cannot do {found}")
    except TracerError as error:
        return "numpy", str(error).removeprefix("engine: ")
    return ("numpy", against) if against else ("gl", renderer())


def by_processor():
    """Says so where OpenGL is drawn by the processor: there NumPy has several processes, and gl takes a
    second to begin. Nothing ("") where a graphics card draws."""
    return "" if is_hardware() else f"OpenGL is drawn by the processor here ({renderer()})"
