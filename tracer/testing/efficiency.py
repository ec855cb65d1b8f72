"""Run time against error: what an estimator's accuracy costs on a scene.

The error is that of whole pictures against a reference, over several seeds, never the spread of the samples
within one: where samples are not independent that is another thing (Celarek et al. 2019). The efficiency of
an estimator is 1 / (time x MSE) (Pharr et al. 2023, 2.2): twice as much of it reaches the same error in half
the time, whatever the number of samples, as long as the MSE falls as 1 / N.
"""

import math
import statistics
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from tracer.engine import render
from tracer.engine.plan import GOALS
from tracer.film import BLOCK
from tracer.integrator import ALL as INTEGRATORS
from tracer.integrator.steps import RIGHT
from tracer.settings import Settings, TracerError
from tracer.testing.errors import SMALL
from tracer.testing.machine import kernel_seconds, peak_bytes

MEASURED = ("integrator", "strategy", "sampler", "precision")  # the Settings that make an Estimator
TRIAL = 8  # pixels: side of the picture that shows whether a scene refuses an estimator


class Estimator(NamedTuple):
    """One way of rendering a scene, in the words of Settings."""

    integrator: str
    strategy: str
    sampler: str
    precision: int
    adaptive: str = "off"  # which of engine.plan.GOALS render is asked for

    @property
    def name(self):
        """walk, direct, path-mis, path-light or path-bsdf."""
        return f"{self.integrator}-{self.strategy}" if self.integrator == "path" else self.integrator

    def settings(self, base, **more):
        """The settings `base` with this estimator, and `more` of them changed."""
        return replace(base, **{name: getattr(self, name) for name in MEASURED}, **more)

    def render(self, scene, base, progress=None, workers=1, steps=RIGHT, **more):
        """A picture by this estimator, with `more` of the settings `base` changed."""
        settings = self.settings(base, **more)
        return render(scene, settings, progress, workers, steps, adaptive=self.adaptive)


def estimators(integrators=(), strategies=(), samplers=(), precisions=(), adaptives=()):
    """Every Estimator of these words; where none are given, all integrators and strategies there are, and of
    the others the default.

    A strategy is path's: with strategies and no integrators, path alone.
    """
    choices = {name: Settings.__dataclass_fields__[name] for name in MEASURED}
    integrators = integrators or (("path",) if strategies else tuple(INTEGRATORS))
    strategies = strategies or choices["strategy"].metadata["choices"]
    samplers = samplers or (choices["sampler"].default,)
    precisions = precisions or (choices["precision"].default,)
    unknown = [word for word in adaptives if word not in GOALS]
    if unknown:
        raise TracerError(f"adaptive: {unknown[0]!r} is not known; choose one of {', '.join(GOALS)}")
    found = [
        Estimator(integrator, strategy, sampler, precision, adaptive)
        for integrator in integrators
        for strategy in (strategies if integrator == "path" else ("mis",))
        for sampler in samplers
        for precision in precisions
        for adaptive in adaptives or GOALS[:1]
    ]
    for one in found:
        one.settings(Settings())  # TracerError for a word that is not known
    return list(dict.fromkeys(found))


def refusal(scene, estimator, base, spp=1, steps=RIGHT):
    """Why the scene refuses an estimator, or it so few samples, in one line; None if it does not."""
    try:
        estimator.render(scene, base, steps=steps, width=TRIAL, height=TRIAL, spp=spp)
    except TracerError as error:
        return str(error)
    return None


@dataclass(frozen=True)
class Reference:
    """The picture that errors are measured against."""

    mean: np.ndarray = field(repr=False)  # (H, W, 3) float64
    variance: np.ndarray | None = field(repr=False)  # (H, W, 3) of that mean; None where it is not known
    origin: str  # where it comes from, in words

    @classmethod
    def of(cls, picture, origin):
        """From anything with .rgb and .variance. TracerError where it cannot serve as one."""
        mean, variance = picture.rgb.astype(np.float64), picture.variance
        if not np.isfinite(mean).all():
            raise TracerError(f"{origin}: has pixels that are not finite, so it is no reference")
        known = variance is not None and np.isfinite(variance).all()
        return cls(mean, variance.astype(np.float64) if known else None, origin)

    @property
    def mse(self):
        """Its own expected MSE; 0 where it is not known."""
        return 0.0 if self.variance is None else float(self.variance.mean())

    @property
    def rel_mse(self):
        """Its own expected relMSE; 0 where it is not known."""
        return 0.0 if self.variance is None else float((self.variance / (self.mean**2 + SMALL)).mean())

    def errors(self, rgb):
        """MSE and relMSE, mean((v - ref)^2 / (ref^2 + 0.01)), of a picture (H, W, 3), the reference's own
        taken off: unbiased where the two are independent, and so perhaps a little below 0."""
        squared = (rgb.astype(np.float64) - self.mean) ** 2
        relative = squared / (self.mean**2 + SMALL)
        return float(squared.mean()) - self.mse, float(relative.mean()) - self.rel_mse


def long_render(scene, base, spp, workers=1, progress=None):
    """The picture a Reference is made of: path with both strategies, independent samples, no bug.

    KeyboardInterrupt where it was stopped.
    """
    right = Estimator("path", "mis", "independent", base.precision)
    picture = right.render(scene, base, progress, workers, spp=spp, bug=None)
    if not picture.complete:
        raise KeyboardInterrupt
    return picture


class Run(NamedTuple):
    """One picture that was rendered and judged."""

    estimator: Estimator
    spp: int
    seed: int
    seconds: float
    kernel: float  # seconds of the calibration kernel just before
    mse: float
    rel_mse: float
    paths: int
    rays: int
    dropped: int


def measure(scene, estimators, base, spps, seeds, reference, workers=1, steps=RIGHT):
    """Yield a Run for every seed, number of samples and estimator, in that order, so that what disturbs the
    machine disturbs all alike and what was done when it is stopped is a whole measurement.

    KeyboardInterrupt where it was stopped.
    """
    for one in estimators:  # what happens once, such as making the scene ready, is not what is timed
        one.render(scene, base, workers=workers, steps=steps, spp=min(spps))
    for seed in seeds:
        for spp in spps:
            for one in estimators:
                kernel = kernel_seconds()
                picture = one.render(scene, base, workers=workers, steps=steps, spp=spp, seed=seed)
                if not picture.complete:
                    raise KeyboardInterrupt
                mse, rel_mse = reference.errors(picture.rgb)
                cost = {name: getattr(picture, name) for name in ("seconds", "paths", "rays", "dropped")}
                yield Run(one, spp, seed, kernel=kernel, mse=mse, rel_mse=rel_mse, **cost)


def memory(scene, estimator, base, spp, steps=RIGHT):
    """Most bytes that one untimed render in this process holds at once.

    More samples than two blocks of the film do not take more, so no more are rendered.
    """
    return peak_bytes(lambda: estimator.render(scene, base, steps=steps, spp=min(spp, 2 * BLOCK)))


class Point(NamedTuple):
    """One number of samples on an estimator's curve. Of several seeds: median, smallest and largest."""

    spp: int
    seconds: tuple
    mse: tuple
    rel_mse: tuple
    kernel: float
    paths_per_second: float
    rays_per_second: float
    dropped: int  # of all seeds

    @property
    def rmse(self):
        """Root of the MSE, median, smallest and largest; NaN below 0, where the reference is too coarse."""
        return tuple(math.sqrt(v) if v >= 0.0 else math.nan for v in self.mse)

    @property
    def efficiency(self):
        """1 / (time x MSE) of the medians; NaN where there is no error to be seen."""
        return 1.0 / (self.seconds[0] * self.mse[0]) if self.mse[0] > 0.0 else math.nan


def curve(runs):
    """The Points of one estimator's Runs, by number of samples."""
    return [_point(spp, [run for run in runs if run.spp == spp]) for spp in sorted({run.spp for run in runs})]


def _point(spp, runs):
    return Point(
        spp,
        _spread([run.seconds for run in runs]),
        _spread([run.mse for run in runs]),
        _spread([run.rel_mse for run in runs]),
        statistics.median(run.kernel for run in runs),
        statistics.median(run.paths / run.seconds for run in runs),
        statistics.median(run.rays / run.seconds for run in runs),
        sum(run.dropped for run in runs),
    )


def _spread(values):
    return statistics.median(values), min(values), max(values)


def slope(points):
    """Exponent s of RMSE ~ N^s by least squares; -0.5 for independent samples. NaN with fewer than two
    numbers of samples at which there is an error."""
    seen = [(math.log(p.spp), 0.5 * math.log(p.mse[0])) for p in points if p.mse[0] > 0.0]
    if len(seen) < 2:
        return math.nan
    x, y = np.array(seen).T
    return float(((x - x.mean()) * (y - y.mean())).sum() / ((x - x.mean()) ** 2).sum())
