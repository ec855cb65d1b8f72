"""`castray bench` in words and as JSON."""

import math
import statistics

from tracer.testing import efficiency
from tracer.testing.machine import KERNEL, machine
from viewer.words import Speaker


def as_dict(studies, out=None):
    """The JSON of `castray bench`.

    machine: processor, cores, system, python, numpy. kernel_is: the calibration kernel, whose time stands
    beside every time. memory_is: what memory means. out: the picture, or null. scenes, each with: scene,
    width, height, workers, seeds (those measured), settings (all that is not measured), complete,
    notes (sentences); reference: origin, rmse and rel_mse (its own error, taken off; null if it is not
    known), seconds (null if it was read); estimators, each with name, integrator, strategy, sampler,
    precision, adaptive; skipped: the same and a reason. Of estimators also memory (bytes), slope (s of
    RMSE ~ N^s) and points: spp; seconds, rmse and rel_mse (median, smallest, largest of the seeds),
    efficiency (1 / (time x MSE) of the medians), resolved (above the reference's own), paths_per_second,
    rays_per_second, kernel (seconds, median), dropped (samples), and runs: seed, seconds, kernel, mse,
    rel_mse. null stands where there is no error to be seen.
    """
    return {
        "machine": machine(),
        "kernel_is": KERNEL,
        "memory_is": MEMORY,
        "out": None if out is None else str(out),
        "scenes": [_scene_dict(study) for study in studies],
    }


WIDEST = 110  # columns: of the tables, where estimators have long names
MEMORY = "most bytes that Python and NumPy held at once in one untimed render with one process"


def _scene_dict(study):
    settings = study.base.as_dict()
    for name in ("width", "height", "seed", "spp", *efficiency.MEASURED):
        settings.pop(name)
    reference, known = study.reference, study.reference.variance is not None
    return {
        "scene": study.scene.name,
        "width": study.base.width,
        "height": study.base.height,
        "workers": study.workers,
        "seeds": sorted({run.seed for run in study.runs}),
        "settings": settings,
        "complete": study.complete,
        "notes": study.notes,
        "reference": {
            "origin": reference.origin,
            "rmse": math.sqrt(reference.mse) if known else None,
            "rel_mse": reference.rel_mse if known else None,
            "seconds": study.made.seconds if study.made else None,
        },
        "skipped": [{"name": one.name, **one._asdict(), "reason": why} for one, why in study.skipped],
        "estimators": [_estimator_dict(study, one, points) for one, points in study.curves.items()],
    }


def _estimator_dict(study, one, points):
    return {
        "name": one.name,
        **one._asdict(),
        "memory": study.memory[one],
        "slope": _number(_slope(study, points)),
        "points": [
            {
                "spp": point.spp,
                "seconds": list(point.seconds),
                "rmse": [_number(v) for v in point.rmse],
                "rel_mse": list(point.rel_mse),
                "efficiency": _number(point.efficiency),
                "resolved": _resolved(point, study.reference),
                "paths_per_second": point.paths_per_second,
                "rays_per_second": point.rays_per_second,
                "kernel": point.kernel,
                "dropped": point.dropped,
                "runs": [
                    {name: getattr(run, name) for name in ("seed", "seconds", "kernel", "mse", "rel_mse")}
                    for run in study.runs
                    if run.estimator == one and run.spp == point.spp
                ],
            }
            for point in points
        ],
    }


def _number(value):
    return value if math.isfinite(value) else None


def print_studies(studies, out=None):
    """The tables of all scenes."""
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    console.width = max(console.width, WIDEST)
    say, about = Speaker(), machine()
    about = {name: about[name] for name in ("processor", "cores", "python", "numpy")}
    for line in (
        say("bench.machine", **about),
        say("bench.kernel", kernel=say.error(KERNEL)),
        say("bench.memory", memory=say.error(MEMORY)),
    ):
        console.print(line, markup=False)
    for study in studies:
        _print_study(study, say, console)
    if out is not None:
        console.print("\n" + say("bench.curves", file=out), markup=False)


def _print_study(study, say, console):
    base, curves = study.base, study.curves
    about = say.clauses(f"{base.width} x {base.height}", *_seeds(study, say))
    console.print("\n" + say.clauses(f"[bold]{study.scene.name}[/bold]", about))
    console.print(_about_reference(study.reference, say), markup=False)
    for note in study.notes:
        console.print(say("bench.note", note=say.error(note)), markup=False)
    if not study.complete:
        console.print(say("bench.stopped"))
    console.print(_curve_table(study, curves, say))
    console.print(_estimator_table(study, curves, say))
    for one, why in study.skipped:
        console.print(say("bench.left_out", label=study.label(one), why=say.error(why)), markup=False)
    console.print(verdict(study, say), markup=False)


def _seeds(study, say):
    """Which seeds, and how many processes."""
    seeds = sorted({run.seed for run in study.runs})
    if len(seeds) == 1:
        yield say("bench.seed", first=seeds[0])
    else:
        yield say("bench.seeds", first=seeds[0], last=seeds[-1])
    yield say("bench.process" if study.workers == 1 else "bench.processes", n=study.workers)


def _about_reference(reference, say):
    origin = say.error(reference.origin)
    if reference.variance is None:
        return say("bench.reference_unknown", origin=origin)
    return say("bench.reference", origin=origin, rmse=f"{math.sqrt(reference.mse):.2g}")


def _table(say, *columns):
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for name in columns:
        head = say(f"bench.{name}")
        table.add_column(head, justify="left" if name == "estimator" else "right", no_wrap=True)
    return table


def _curve_table(study, curves, say):
    """Every point: medians, and the smallest and largest of the seeds."""
    names = ("estimator", "spp", "seconds", "kernel_ms", "rmse", "range", "rel_mse", "per_second")
    table = _table(say, *names)
    for one, points in curves.items():
        for k, point in enumerate(points):
            middle, low, high = (_shown(v, study.reference.mse) for v in point.rmse)
            relative = point.rel_mse[0]
            table.add_row(
                study.label(one) if k == 0 else "",
                str(point.spp),
                f"{point.seconds[0]:.3g}",
                f"{1e3 * point.kernel:.2f}",
                middle,
                f"{low} .. {high}",
                f"{relative:.2g}"
                if relative > study.reference.rel_mse
                else f"< {study.reference.rel_mse:.2g}",
                _efficiency(point, study.reference),
            )
    return table


def _shown(rmse, own):
    """An RMSE; what a reference with the MSE `own` cannot resolve is bounded by its error."""
    if rmse >= 0.0 and rmse * rmse >= own:
        return f"{rmse:.3g}"
    return f"< {math.sqrt(own):.2g}"


def _efficiency(point, reference):
    """1 / (time x MSE), where the reference resolves the MSE."""
    return f"{point.efficiency:.3g}" if _resolved(point, reference) else "-"


def _resolved(point, reference):
    return point.mse[0] > 0.0 and point.mse[0] >= reference.mse


def _estimator_table(study, curves, say):
    """One line an estimator, at its largest number of samples."""
    table = _table(say, "estimator", "efficiency", "slope", "paths", "rays", "kernel_ms", "held")
    resolved = [points[-1] for points in curves.values() if _resolved(points[-1], study.reference)]
    best = max((point.efficiency for point in resolved), default=1.0)
    for one, points in curves.items():
        last = points[-1]
        table.add_row(
            study.label(one),
            f"{100.0 * last.efficiency / best:.3g} %" if last in resolved else "-",
            f"{slope:+.2f}" if math.isfinite(slope := _slope(study, points)) else "-",
            f"{last.paths_per_second:.3g}",
            f"{last.rays_per_second:.3g}",
            f"{1e3 * last.kernel:.2f}",
            f"{study.memory[one] / 2**20:.3g} MiB",
        )
    return table


def _slope(study, points):
    """The slope over the points that the reference resolves."""
    return efficiency.slope([point for point in points if _resolved(point, study.reference)])


def verdict(study, say):
    """One line: the estimator that reaches the same error in the least time; those that some seed puts
    before it are named with it."""
    most = study.spps[-1]
    costs = {one: _costs(study, one, most) for one in study.curves}
    costs = {one: of_one for one, of_one in costs.items() if of_one}
    if not costs:
        return say("bench.none")
    if len(costs) == 1:
        return say("bench.alone", label=study.label(*costs))
    middle = {one: statistics.median(of_one.values()) for one, of_one in costs.items()}
    exact = [one for one in costs if middle[one] == 0.0]
    if exact:
        return say("bench.exact", spp=most, labels=say.listed(*map(study.label, exact)))
    first, second = sorted(costs, key=middle.__getitem__)[:2]
    seeds = set.intersection(*map(set, costs.values()))
    tied = [one for one in costs if one != first and any(costs[one][k] <= costs[first][k] for k in seeds)]
    said = {"label": study.label(first), "spp": most}
    if tied:
        return say("bench.tied", labels=say.listed(*map(study.label, tied)), **said)
    ratio = middle[second] / middle[first]
    return say("bench.best", times=f"{ratio:.2g}", second=study.label(second), **said)


def _costs(study, estimator, spp):
    """{seed: time x MSE} of an estimator at one number of samples; 0 where no error is to be seen."""
    runs = [run for run in study.runs if run.estimator == estimator and run.spp == spp]
    own = study.reference.mse
    return {run.seed: run.seconds * run.mse if run.mse >= own else 0.0 for run in runs}
