"""A shader that is run for itself: a compute shader, which reads and writes buffers."""

import numpy as np

GROUP = 64  # invocations side by side
_TABLES, _PIXELS, _RADIANCE, _VERTICES = range(4)  # bindings


class Compute:
    """A compiled shader, and its tables on the card. watched: vertices that are kept of each path."""

    version, folder, defines = 430, "compute", {"GROUP": GROUP}

    @staticmethod
    def compiled(context, text):
        """The shader of that text; what moderngl raises where the driver does not take it."""
        return context.compute_shader(text)

    @staticmethod
    def largest(info):
        """Most bytes of tables that it reads. info: of the context."""
        return info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"]

    def __init__(self, context, shader, tables, watched):
        self._context, self._shader, self._watched = context, shader, watched
        self._buffers = {_TABLES: context.buffer(tables)}

    def __call__(self, pixels, paths, uniforms):
        """Radiance and number of rays of so many paths, (N, 4). pixels: (P, 2) uint32."""
        self._room(_PIXELS, pixels.nbytes).write(pixels.tobytes())
        out = self._room(_RADIANCE, 16 * paths)
        if self._watched:
            self._room(_VERTICES, 32 * self._watched * paths)
        for binding, buffer in self._buffers.items():
            buffer.bind_to_storage_buffer(binding)
        say(self._shader, paths=paths, **uniforms)
        self._shader.run(-(-paths // GROUP))
        return np.frombuffer(out.read(16 * paths), np.float32).reshape(-1, 4)

    def vertices(self, paths):
        """What the last call kept: numbers (N, watched, 4) int32, and points with ends (N, watched, 4)."""
        kept = np.frombuffer(self._buffers[_VERTICES].read(), [("number", "4i4"), ("p", "4f4")])
        kept = kept[: paths * self._watched].reshape(-1, self._watched)
        return kept["number"], kept["p"]

    def _room(self, binding, size):
        """A buffer of at least that size."""
        if binding not in self._buffers or self._buffers[binding].size < size:
            self._buffers[binding] = self._context.buffer(reserve=size)
        return self._buffers[binding]


def say(shader, **uniforms):
    """Set uniforms; those that a shader has no use for are not there."""
    for name, value in uniforms.items():
        if name in shader:
            shader[name] = value
