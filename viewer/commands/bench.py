"""The command `castray bench`: which estimator for this scene? Run time against error, measured."""

import sys
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

import tracer
from tracer.settings import TracerError
from viewer.options import (
    BenchOptions,
    Json,
    Whole,
    print_json,
    scene_of,
    settings_and_steps,
    several_whole,
    shrunk,
)
from viewer.progress import watched
from viewer.words import Speaker

FINER = 16  # the reference has so many times the samples of the finest picture, unless said
MOST_SEEDS = 1000

Words = Annotated[list[str] | None, Parameter(negative=())]
WholeNumbers = Parameter(converter=several_whole, consume_multiple=True, negative=())


@dataclass
class Study:
    """What one scene was asked, and what came of it."""

    scene: Any
    base: Any  # Settings: all that is not measured
    spps: tuple
    seeds: range
    workers: int
    reference: Any = None
    made: Any = None  # the Picture the reference was made of here
    willing: list = field(default_factory=list)  # the Estimators that the scene takes
    skipped: list = field(default_factory=list)  # (Estimator, why the scene refuses it)
    memory: dict = field(default_factory=dict)  # Estimator -> bytes
    runs: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    complete: bool = False

    @property
    def curves(self):
        """{Estimator: its Points}, of those that were measured."""
        from tracer.testing import efficiency

        runs = {one: [run for run in self.runs if run.estimator == one] for one in self.willing}
        return {one: efficiency.curve(of_one) for one, of_one in runs.items() if of_one}

    def label(self, one):
        """What an estimator is called here: its sampler and precision only where there are several."""
        several = {name for name in one._fields if len({getattr(other, name) for other in self.willing}) > 1}
        more = [str(getattr(one, name)) for name in ("sampler", "precision") if name in several]
        if one.adaptive != "off":
            more.append(f"adaptive {one.adaptive}")
        return ", ".join((one.name, *more))


def bench(
    *scenes: str,
    integrator: Words = None,
    strategy: Words = None,
    sampler: Words = None,
    precision: Annotated[list[int] | None, WholeNumbers] = None,
    adaptive: Words = None,
    spp: Annotated[list[int] | None, WholeNumbers] = None,
    seeds: Annotated[int, Whole] = 5,
    reference: Path | None = None,
    reference_spp: Annotated[int | None, Whole] = None,
    workers: Annotated[int, Whole] = 1,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    options: BenchOptions | None = None,
    json: Json = False,
):
    """Measure run time against error: which estimator for this scene? A table and a picture.

    The error is that of whole pictures against a reference, median over several seeds; efficiency is
    1 / (time x MSE). Estimators that a scene refuses are left out, and it is said why.

    Parameters
    ----------
    scenes
        Scene files, or bare names of those that come with castray.
    integrator
        Only this one, or several: may be given again (default: walk, direct and path).
    strategy
        Only this one of path's, or several (default: mis, light and bsdf).
    sampler
        This one, or several.
    precision
        This one, or several.
    adaptive
        Where the samples go, off, mse or relmse as in `castray render`, or several (default: off).
    spp
        Samples per pixel, one or several (default: 4 16 64).
    seeds
        How many pictures of each kind: with the seeds after --seed, which is the reference's.
    reference
        A picture that counts as the truth: .exr of `castray render`, whose own error is taken into account,
        or .npy. Without it one is made by path.
    reference_spp
        Samples per pixel of the reference that is made (default: 16 times the most that are measured).
    workers
        Processes that render.
    output
        Where a picture of the curves goes, .png or .svg; none is drawn without it.
    """
    from tracer.testing import efficiency

    _check(scenes, seeds, workers, reference, reference_spp, output)
    base, steps = settings_and_steps(options)
    spps = tuple(sorted(set(spp or (4, 16, 64))))
    measured = range(base.seed + 1, base.seed + 1 + seeds)
    for one in spps:
        replace(base, spp=one, seed=measured[-1])  # TracerError where that cannot be
    found = efficiency.estimators(
        *(tuple(words or ()) for words in (integrator, strategy, sampler, precision, adaptive))
    )
    studies = []
    for scene in (scene_of(name, options) for name in scenes):
        study = Study(scene, _at_size(base, scene, reference), spps, measured, workers)
        study.willing = _willing(study, found, steps)
        studies.append(study)
    for study in studies:
        _conduct(study, reference, reference_spp or FINER * spps[-1], steps)
        if not study.complete:
            break
    return _show(studies, output, json)


def _show(studies, output, json):
    """Print and draw what was measured; the exit code."""
    from viewer import bench_words

    complete = all(study.complete for study in studies)
    studies = [study for study in studies if study.runs]
    if not studies:
        print(f"castray: {Speaker()('told.nothing_measured')}", file=sys.stderr)
        return 130
    if output is not None:
        from viewer import plot_bench, plots

        with plots.lettered() as say:
            plots.write(plot_bench.figure(studies, say), output)
    if json:
        print_json(bench_words.as_dict(studies, output))
    else:
        bench_words.print_studies(studies, output)
    return 0 if complete else 130


def _check(scenes, seeds, workers, reference, reference_spp, output):
    if not scenes:
        raise TracerError("bench: name a scene, as in castray bench cornell_unit")
    for name, value, most in (("seeds", seeds, MOST_SEEDS), ("workers", workers, 1024)):
        if not 1 <= value <= most:
            raise TracerError(f"{name}: {value} is not between 1 and {most}")
    if reference is not None and len(scenes) > 1:
        raise TracerError("reference: is of one scene; measure one at a time with it")
    if reference is not None and reference_spp is not None:
        raise TracerError("reference-spp: is for a reference that is made, and one is given")
    if reference_spp is not None:
        tracer.Settings(spp=reference_spp)
    if output is not None:
        from viewer import plots

        plots.check_path(output)


def _at_size(base, scene, reference):
    """The settings at the size asked for, the given reference's, or a small one of the scene's shape."""
    if base.width is not None or reference is not None:
        return base
    return shrunk(base, scene)


def _willing(study, estimators, steps):
    """The estimators that the scene takes; TracerError if that is none."""
    from tracer.testing import efficiency

    willing = []
    for one in estimators:
        why = efficiency.refusal(study.scene, one, study.base, study.spps[0], steps)
        if why:
            study.skipped.append((one, why))
        else:
            willing.append(one)
    if not willing:
        raise TracerError(f"{study.scene.name}: {study.skipped[0][1]}")
    return willing


def _conduct(study, file, spp, steps):
    """Measure; what was done when it is stopped stays in the Study."""
    from tracer.testing import efficiency

    scene, willing = study.scene, study.willing
    try:
        _find_reference(study, file, spp)
        for one in willing:
            study.memory[one] = efficiency.memory(scene, one, study.base, study.spps[-1], steps)
        with watched(Speaker()("progress.measuring", scene=scene.name)) as progress:
            runs = efficiency.measure(
                scene, willing, study.base, study.spps, study.seeds, study.reference, study.workers, steps
            )
            done, total = 0, sum(study.spps) * len(willing) * len(study.seeds)
            for run in runs:
                study.runs.append(run)
                done += run.spp
                if progress:
                    progress(done, total)
        study.complete = True
    except KeyboardInterrupt:
        pass


def _find_reference(study, file, spp):
    """Read the reference, or make it."""
    from tracer.testing import efficiency

    base = study.base
    if file is None:
        with watched(Speaker()("progress.reference", scene=study.scene.name)) as progress:
            study.made = efficiency.long_render(study.scene, base, spp, study.workers, progress)
        origin = f"path, {spp} samples per pixel, seed {base.seed}"
        study.reference = efficiency.Reference.of(study.made, origin)
        return
    stored = tracer.read(file)
    height, width = stored.rgb.shape[:2]
    if stored.eight_bits:
        raise TracerError(f"{file}: has 8 bits, too coarse for a reference; use .exr or .npy")
    if base.width is not None and (base.width, base.height) != (width, height):
        raise TracerError(f"{file}: is {width} x {height}, and --size says {base.width} x {base.height}")
    study.base = replace(base, width=width, height=height)
    said = stored.notes.get("settings", {})
    if said.get("seed") in study.seeds:
        raise TracerError(
            f"{file}: was made with seed {said['seed']}, which would be measured against itself; "
            f"choose another --seed: the {len(study.seeds)} after it are measured"
        )
    for name in ("max_depth", "jitter", "bug"):
        here = getattr(study.base, name)
        if name in said and said[name] != here:
            study.notes.append(
                f"{name} is {said[name]} in the reference and {here} here: what that changes counts as error"
            )
    study.reference = efficiency.Reference.of(stored, str(file))
