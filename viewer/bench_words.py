"""`castray bench` in words and as JSON."""

import math
import statistics

from tracer.testing import efficiency
from tracer.testing.machine import KERNEL, machine


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
    about = machine()
    console.print(
        f"{about['processor']}, {about['cores']} cores, Python {about['python']}, NumPy {about['numpy']}\n"
        f"kernel: {KERNEL}\nmemory: {MEMORY}",
        markup=False,
    )
    for study in studies:
        _print_study(study, console)
    if out is not None:
        console.print(f"\n{out}: the curves", markup=False)


def _print_study(study, console):
    base, curves = study.base, study.curves
    console.print(f"\n[bold]{study.scene.name}[/bold], {base.width} x {base.height}, {_seeds(study)}")
    console.print(_about_reference(study.reference), markup=False)
    for note in study.notes:
        console.print(f"note: {note}", markup=False)
    if not study.complete:
        console.print("stopped early: what follows is what was done by then")
    console.print(_curve_table(study, curves))
    console.print(_estimator_table(study, curves))
    for one, why in study.skipped:
        console.print(f"left out: {study.label(one)}: {why}", markup=False)
    console.print(verdict(study), markup=False)


def _seeds(study):
    seeds = sorted({run.seed for run in study.runs})
    said = f"seed {seeds[0]}" if len(seeds) == 1 else f"seeds {seeds[0]} to {seeds[-1]}"
    return f"{said}, {study.workers} {'process' if study.workers == 1 else 'processes'}"


def _about_reference(reference):
    if reference.variance is None:
        return f"reference: {reference.origin}; its own error is not known, and counts with the others'"
    rmse = math.sqrt(reference.mse)
    return f"reference: {reference.origin}; its own RMSE of {rmse:.2g} is taken off the others'"


def _table(*columns):
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for name in columns:
        table.add_column(name, justify="left" if name == "estimator" else "right", no_wrap=True)
    return table


def _curve_table(study, curves):
    """Every point: medians, and the smallest and largest of the seeds."""
    table = _table("estimator", "spp", "seconds", "kernel ms", "RMSE", "of the seeds", "relMSE", "1/(s MSE)")
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


def _estimator_table(study, curves):
    """One line an estimator, at its largest number of samples."""
    table = _table("estimator", "efficiency", "slope", "paths/s", "rays/s", "kernel ms", "memory")
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


def verdict(study):
    """One line: the estimator that reaches the same error in the least time; those that some seed puts
    before it are named with it."""
    most = study.spps[-1]
    costs = {one: _costs(study, one, most) for one in study.curves}
    costs = {one: of_one for one, of_one in costs.items() if of_one}
    if not costs:
        return "no estimator got as far as its last point"
    if len(costs) == 1:
        return f"{study.label(*costs)} alone was measured"
    middle = {one: statistics.median(of_one.values()) for one, of_one in costs.items()}
    exact = [one for one in costs if middle[one] == 0.0]
    if exact:
        return f"no error is to be seen at {most} samples per pixel: {', '.join(map(study.label, exact))}"
    first, second = sorted(costs, key=middle.__getitem__)[:2]
    seeds = set.intersection(*map(set, costs.values()))
    tied = [one for one in costs if one != first and any(costs[one][k] <= costs[first][k] for k in seeds)]
    said = f"{study.label(first)} is the most efficient at {most} samples per pixel"
    if tied:
        return f"{said}, but not under every seed: {', '.join(map(study.label, tied))}"
    ratio = middle[second] / middle[first]
    return f"{said}, {ratio:.2g} times as much as {study.label(second)}, and under every seed"


def _costs(study, estimator, spp):
    """{seed: time x MSE} of an estimator at one number of samples; 0 where no error is to be seen."""
    runs = [run for run in study.runs if run.estimator == estimator and run.spp == spp]
    own = study.reference.mse
    return {run.seed: run.seconds * run.mse if run.mse >= own else 0.0 for run in runs}
