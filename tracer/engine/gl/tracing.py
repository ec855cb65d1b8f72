"""Waves traced by a shader: what `engine.waves.trace` is for NumPy."""

from functools import lru_cache

import numpy as np

from tracer import film
from tracer.engine.gl.device import device, largest, stage
from tracer.engine.gl.refusals import refuse, refuse_size
from tracer.engine.gl.source import Source
from tracer.engine.waves import Result
from tracer.sampler import pack_pixel
from tracer.settings import TracerError

WATCHED = 5  # vertices of a path that are kept where they are looked at
SHADERS = 16  # that are kept ready


@lru_cache(SHADERS)
def _compiled(context, stage, text):
    """The shader of that text: where a scene differs by numbers of its tables only, it is compiled once."""
    try:
        return stage.compiled(context, text)
    except Exception as error:  # moderngl's own, which has no name outside it
        said = next((line for line in str(error).splitlines() if "error" in line.lower()), error)
        raise TracerError(
            f"engine: the driver does not take the shader of gl ({said}); choose engine numpy"
        ) from error


class Tracer:
    """The shader of a scene at some settings, and its tables, ready to trace tasks.

    Raises TracerError where scene, settings or steps ask for what it cannot do, or there is no OpenGL.
    """

    def __init__(self, scene, settings, steps, watched=False):
        scene = scene.at(settings)
        refuse(scene, settings, steps)
        self.settings, self._watched = settings, WATCHED if watched else 0
        context, runs = device(), stage()
        source = Source(scene, settings, runs, self._watched)
        refuse_size(source.tables.size, largest())
        context.gc()
        shader = _compiled(context, runs, source.text)
        self._run = runs(context, shader, source.tables.tobytes(), self._watched)
        fixed = settings.roulette not in ("auto", "off")
        self._numbers = {
            "seed": settings.seed,
            "last_depth": settings.last_depth,
            "said_survival": float(settings.roulette) if fixed else 1.0,
        }

    def __call__(self, task):
        """Trace one task; its samples are folded as those of every engine are."""
        numbers = task.numbers
        radiance = self.trace(numbers % self.settings.width, numbers // self.settings.width, *task[1:])
        rays, radiance = radiance[..., 3], radiance[..., :3].transpose(2, 0, 1)
        finite = np.isfinite(radiance).all(axis=0)
        counted = np.where(finite, radiance, np.float32(0.0))
        block = film.block(counted, task.sample, self.settings.parts)
        return Result(task, block, int(rays.sum(dtype=np.float64)), int(np.count_nonzero(~finite)))

    def trace(self, x, y, first, samples):
        """Radiance and number of rays, (P, samples, 4) float32, of so many samples of pixels (P,) from number
        `first`, or (P,) numbers, on."""
        pixels = np.empty((x.size, 2), np.uint32)
        pixels[:, 0], pixels[:, 1] = pack_pixel(x, y), first
        numbers = {**self._numbers, "samples": samples}
        return self._run(pixels, x.size * samples, numbers).reshape(-1, samples, 4)

    def vertices(self, paths):
        """What the last call kept of its paths: (number (N, 5, 4) int32, p (N, 5, 3), end (N,))."""
        number, p = self._run.vertices(paths)
        return number, p[..., :3], p[:, 0, 3].astype(np.int32)
