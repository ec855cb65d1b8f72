"""Which engine `auto` takes."""

from tracer.engine.gl.device import is_hardware, renderer
from tracer.engine.gl.refusals import reasons
from tracer.settings import TracerError


def faster(scene, settings, steps):
    """("gl" or "numpy", why): gl where a graphics card draws, and it can do all that is asked."""
    against = next(reasons(scene.at(settings), settings, steps), None)
    if against:
        return "numpy", f"gl cannot do {against}"
    try:
        against = by_processor()
    except TracerError as error:
        return "numpy", str(error).removeprefix("engine: ")
    return ("numpy", against) if against else ("gl", renderer())


def by_processor():
    """Says so where OpenGL is drawn by the processor: there NumPy has several processes, and gl takes a
    second to begin. Nothing ("") where a graphics card draws."""
    return "" if is_hardware() else f"OpenGL is drawn by the processor here ({renderer()})"
