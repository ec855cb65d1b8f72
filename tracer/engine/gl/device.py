"""OpenGL without a window: the context that everything here runs in."""

import sys
from functools import cache
from importlib.util import find_spec

from tracer.engine.gl.compute import Compute
from tracer.engine.gl.fragments import Fragments
from tracer.settings import TracerError

LEAST = Fragments.version
_SOFTWARE = ("llvmpipe", "softpipe", "swiftshader", "software", "swrast", "gdi generic")


@cache
def device():
    """The moderngl context. TracerError with what is missing: the package, OpenGL, or a version of it.

    On Linux by EGL, which needs neither a screen nor a window system.
    """
    if find_spec("moderngl") is None:
        raise TracerError(
            "engine: gl needs the package moderngl, which is not installed: "
            "pip install moderngl, or choose engine numpy"
        )
    try:
        import moderngl
    except ImportError as error:
        raise TracerError(
            f"engine: gl needs the package moderngl, which cannot be imported ({error}); choose engine numpy"
        ) from None

    said = []
    for backend in ({"backend": "egl"}, {}) if sys.platform.startswith("linux") else ({},):
        try:
            context = moderngl.create_standalone_context(**backend)
        except Exception as error:  # what a driver or its loader raises is anything
            said.append(" ".join(str(error).split()) or type(error).__name__)
            continue
        if context.version_code >= LEAST:
            context.gc_mode = "context_gc"  # what nobody has any more is freed where gc() is called
            return context
        version = "{}.{}".format(*divmod(context.version_code // 10, 10))
        context.release()
        said.append(f"this one has OpenGL {version}")
    raise TracerError(
        f"engine: gl needs a driver with OpenGL {LEAST // 100}.{LEAST // 10 % 10}: {'; '.join(said)}; "
        "choose engine numpy"
    )


def renderer():
    """Who draws, as the driver calls it."""
    return device().info["GL_RENDERER"]


def stage():
    """What runs shaders here: Compute, or Fragments where there are no compute shaders."""
    return Compute if device().version_code >= Compute.version else Fragments


def largest():
    """Most bytes of tables that a shader reads."""
    return stage().largest(device().info)


def is_hardware():
    """Whether that is more than this machine's processor."""
    name = renderer().lower()
    return not any(word in name for word in _SOFTWARE)
