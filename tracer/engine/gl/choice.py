"""Which engine `auto` takes."""

from tracer.engine.gl.device import is_hardware, renderer
from tracer.engine.gl.refusals import reasons
from tracer.settings import TracerError


def faster(scene, settings, steps):
    """("gl" or "numpy", why): gl where a graphics card draws, and it can do all that is asked.

    OpenGL on the processor is left out: there NumPy has several processes, and gl takes a second to begin.
    """
    against = next(reasons(scene.at(settings), settings, steps), None)
    if against:
        return "numpy", f"gl cannot do {against}"
    try:
        name = renderer()
    except TracerError as error:
        return "numpy", str(error).removeprefix("engine: ")
    if not is_hardware():
        return "numpy", f"OpenGL is drawn by the processor here ({name})"
    return "gl", name
