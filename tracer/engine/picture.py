"""Render a picture; trace one pixel again with everything kept."""

import time
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

import numpy as np

from tracer import film
from tracer.engine import many, parts, plan, waves
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave
from tracer.recorder import RecordedPath, number, record
from tracer.settings import Settings, TracerError

MOST_RECORDED = 1 << 16  # paths: about 2 GB of events


@dataclass(frozen=True)
class Picture:
    """A rendered picture and what it cost."""

    rgb: np.ndarray  # (H, W, 3) float32, linear
    variance: np.ndarray  # (H, W, 3) float32, of each pixel's mean; NaN where not known (Settings.parts)
    samples: np.ndarray  # (H, W) samples that went into each pixel
    settings: Settings
    seconds: float
    rays: int
    dropped: int  # samples that were not finite and count as 0
    complete: bool  # False if it was stopped
    engine: str = "numpy"  # which traced it

    @property
    def paths(self):
        """Number of paths traced."""
        return int(self.samples.sum())

    @property
    def saved(self):
        """Share of the samples asked for that were not needed."""
        return 1.0 - self.paths / (self.samples.size * self.settings.spp)

    @classmethod
    def of(cls, so_far, settings, engine="numpy"):
        """The picture that a SoFar is by now."""
        width, height, sheet = settings.width, settings.height, so_far.sheet
        rgb, variance = (
            np.ascontiguousarray(a.T).reshape(height, width, 3) for a in (sheet.mean(), sheet.variance())
        )
        samples = sheet.samples.reshape(height, width)
        cost = so_far.seconds, so_far.rays, so_far.dropped
        return cls(rgb, variance, samples, settings, *cost, so_far.complete, engine)


@dataclass
class SoFar:
    """A picture in the making."""

    sheet: film.Film
    seconds: float = 0.0
    rays: int = 0
    dropped: int = 0
    complete: bool = False

    @classmethod
    def begin(cls, settings):
        """Nothing yet of a picture with these Settings."""
        return cls(film.Film(settings.width * settings.height, settings.parts))

    def add(self, result):
        """Count what a result cost."""
        self.rays += result.rays
        self.dropped += result.dropped

    @contextmanager
    def going(self):
        """While it is worked on: keeps the time. It ends early by Ctrl-C or, which a warning says, with a
        cluster that is lost."""
        began = time.perf_counter()
        try:
            yield
            self.complete = True
        except KeyboardInterrupt:
            pass
        except many.Lost as lost:
            warnings.warn(str(lost), many.ClusterWarning, stacklevel=3)
        finally:
            self.seconds += time.perf_counter() - began


def render(
    scene,
    settings,
    progress=None,
    workers=1,
    steps=RIGHT,
    until_error=None,
    adaptive="off",
    engine="numpy",
    cluster=None,
    so_far=None,
):
    """Render `scene`.

    progress: called as progress(paths done, paths in all). workers: most processes to use; more than one
    only when the work is worth their start, and the picture is the same bit for bit. steps: the named steps
    of the loop; settings.bug asks for those of `lessons.zoo.planted`. until_error: stop a tile when its root
    mean of se^2 / (mean^2 + 0.01) is that small; settings.spp is then the most. adaptive: "mse" or "relmse"
    spends settings.spp, on average, where that error is (see engine/plan.py). engine: "numpy", or "gl", which
    is one process and gives the same picture but for rounding. cluster: a tracer.cluster.Cluster that does
    the work instead of this machine; pixel by pixel, unless until_error or adaptive look at the whole.
    so_far: a SoFar of the same picture to go on with, pixel by pixel; it is filled. Ctrl-C, and a cluster
    that is lost, which a warning says, return the picture so far with complete = False. Raises TracerError.
    """
    settings = asked(scene, settings, steps)
    paths = settings.width * settings.height * settings.spp
    so_far = so_far or SoFar.begin(settings)
    sheet = so_far.sheet
    rounds = plan.rounds(settings, sheet, until_error, adaptive)
    if cluster and until_error is None and adaptive == "off":
        rounds = [many.left(settings, cluster.processes, sheet)]
        job = partial(parts.trace, scene.at(settings), settings, steps)
    else:
        job = tracing(engine, scene, settings, steps)
    workers = 1 if engine == "gl" else workers
    done = int(sheet.samples.sum())
    with so_far.going():
        for result in results(job, rounds, paths, workers, cluster):
            waves.collect(sheet, result)
            so_far.add(result)
            done += result.task.paths
            if progress:
                progress(done, paths)
    return Picture.of(so_far, settings, engine)


def tracing(engine, scene, settings, steps):
    """What traces a task by that engine: a function that gives its Result."""
    if engine == "numpy":
        return partial(waves.trace, scene.at(settings), settings, steps)
    if engine != "gl":
        raise TracerError(f"engine: {engine!r} is not known; choose one of numpy, gl")
    from tracer.engine.gl.tracing import Tracer  # where it is used: it needs a package that may be missing

    return Tracer(scene, settings, steps)


def asked(scene, settings, steps):
    """The settings at the scene's size; TracerError if they name a bug whose steps were not given."""
    if settings.bug and steps is RIGHT:
        raise TracerError(f"bug: {settings.bug} needs its steps: pass steps=lessons.zoo.planted(settings)")
    return settings.at_size_of(scene)


def results(job, rounds, paths, workers, cluster=None):
    """What job(task) gives for the tasks of all rounds, in order: by a cluster; or by this process, then by
    several once it is clear that the rest is worth it. paths: of all tasks together."""
    if cluster:
        for tasks in rounds:
            yield from many.traced(job, tasks, cluster)
        return
    if workers == 1:
        for tasks in rounds:
            yield from map(job, tasks)
        return
    from tracer.engine import processes  # where it is used: multiprocessing takes long to import

    left, together = paths, processes.started(workers)
    for tasks in rounds:
        tasks = iter(tasks)
        while not together and (task := next(tasks, None)) is not None:
            began = time.perf_counter()
            yield job(task)
            left -= task.paths
            together = (time.perf_counter() - began) / task.paths * left > processes.WORTH_A_START
        yield from processes.traced(job, tasks, workers) if together else ()


@dataclass(frozen=True)
class PixelRecord:
    """All that went into one pixel."""

    x: int
    y: int
    value: np.ndarray  # (3,) float32: the pixel, bit for bit as render gives it
    variance: np.ndarray  # (3,) float32: of that value; NaN where not known (Settings.parts)
    paths: tuple[RecordedPath, ...]
    settings: Settings

    def as_dict(self, scene):
        """Plain values, as `castray inspect --json` prints them."""
        return {
            "scene": scene.name,
            "settings": self.settings.as_dict(),
            "pixel": [self.x, self.y],
            "value": [number(v) for v in self.value],
            "variance": [number(v) for v in self.variance],
            "samples": [path.as_dict(scene) for path in self.paths],
        }


def inspect(scene, settings, x, y, sample=None, steps=RIGHT):
    """Trace the paths of pixel (x, y) again and keep every event.

    sample: only this one; the value is then that sample alone. Raises TracerError outside the picture.
    """
    settings = asked(scene, settings, steps)
    scene = scene.at(settings)
    if not (0 <= x < settings.width and 0 <= y < settings.height):
        raise TracerError(
            f"pixel {x} {y} is outside the picture: x goes from 0 to {settings.width - 1}, "
            f"y from 0 to {settings.height - 1}"
        )
    if sample is not None and not 0 <= sample < settings.spp:
        raise TracerError(f"sample {sample} is not there: samples go from 0 to {settings.spp - 1}")
    if sample is None and settings.spp > MOST_RECORDED:
        raise TracerError(
            f"{settings.spp} samples are too many to record at once; choose one, or spp up to {MOST_RECORDED}"
        )
    samples = np.arange(settings.spp) if sample is None else np.array([sample])
    wave = Wave(np.full(samples.size, x), np.full(samples.size, y), samples, settings, steps)
    with np.errstate(all="ignore"):
        paths = record(waves.events(scene, settings, wave), scene, wave)
    pixel = film.gather(wave.radiance, settings.parts)
    return PixelRecord(x, y, pixel.mean()[:, 0], pixel.variance()[:, 0], paths, settings)
