"""A shader that draws, with paths for pixels: a fragment shader, where OpenGL has no compute shaders.

It reads pictures in the place of buffers, and writes one pixel of each picture that it draws. So it keeps one
vertex of a path, and where several are asked for, the paths are traced as often.
"""

import numpy as np

from tracer.engine.gl.compute import say

ACROSS = 4096  # pixels in a row of any of its pictures
_EVERYTHING = """#version 410
void main()
{
    gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1);
}
"""


class Fragments:
    """As Compute."""

    version, folder, defines = 410, "fragment", {"ACROSS": ACROSS}

    @staticmethod
    def compiled(context, text):
        """As Compute.compiled."""
        return context.program(vertex_shader=_EVERYTHING, fragment_shader=text)

    @staticmethod
    def largest(info):
        """As Compute.largest."""
        return 16 * ACROSS * info["GL_MAX_TEXTURE_SIZE"]

    def __init__(self, context, shader, tables, watched):
        self._context, self._shader, self._watched = context, shader, watched
        self._tables = self._picture(np.frombuffer(tables, np.uint32).reshape(-1, 4))
        self._triangle = context.vertex_array(shader, [])
        self._pixels, self._target, self._kept = None, None, []

    def __call__(self, pixels, paths, uniforms):
        """As Compute's."""
        self._pixels = self._picture(pixels, self._pixels)
        self._tables.use(0)
        self._pixels.use(1)
        say(self._shader, paths=paths, tables=0, pixels=1, **uniforms)
        self._make_room(paths)
        self._kept = []
        for k in range(max(1, self._watched)):
            say(self._shader, watched=k)
            self._target.use()
            self._triangle.render(vertices=3)
            if self._watched:
                self._kept.append([self._read(paths, *of) for of in ((1, np.int32), (2, np.float32))])
        return self._read(paths, 0, np.float32)

    def vertices(self, paths):
        """As Compute's."""
        numbers, points = zip(*self._kept, strict=True)
        return np.stack(numbers, axis=1), np.stack(points, axis=1)

    def _picture(self, rows, there=None):
        """One that holds rows (N, C) of uint32: `there` if they fit in."""
        high = -(-len(rows) // ACROSS)
        padded = np.zeros((high * ACROSS, rows.shape[1]), np.uint32)
        padded[: len(rows)] = rows
        if there is not None and there.size[1] >= high:
            there.write(padded.tobytes(), viewport=(0, 0, ACROSS, high))
            return there
        made = self._context.texture((ACROSS, high), rows.shape[1], padded.tobytes(), dtype="u4")
        made.filter = self._context.NEAREST, self._context.NEAREST
        return made

    def _make_room(self, paths):
        """A target of at least so many pixels."""
        high = -(-paths // ACROSS)
        if self._target is None or self._target.size[1] < high:
            kinds = ("f4", "i4", "f4") if self._watched else ("f4",)
            pictures = [self._context.texture((ACROSS, high), 4, dtype=kind) for kind in kinds]
            self._target = self._context.framebuffer(pictures)

    def _read(self, paths, picture, kind):
        """What stands in a picture of the target, (N, 4)."""
        data = self._target.color_attachments[picture].read()
        return np.frombuffer(data, kind).reshape(-1, 4)[:paths]
