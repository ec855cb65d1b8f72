"""The command `castray check`."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import tracer
from tracer.settings import TracerError
from viewer.options import CheckOptions, Json, print_json, settings_and_steps

SIDE, SPP = 24, 8  # of the small picture that is traced unless said


def check(
    file: Path,
    /,
    *,
    scene: str = "cornell",
    new: Annotated[bool, Parameter(negative=())] = False,
    seconds: float = 300.0,
    options: CheckOptions | None = None,
    json: Json = False,
):
    """Run your own cast_ray and hold the laws of light transport against what it did.

    Exit code 0 if nothing is found, 1 if something is.

    Parameters
    ----------
    file
        A Python file with a function cast_ray(scene, ray, depth).
    scene
        What it is asked to trace: a scene file, or the bare name of one that comes with castray.
    new
        Write a tracer to start from into that file, and do no more.
    seconds
        Most time it may take.
    """
    if new:
        _write_starter(file)
        return 0
    if not 0.0 < seconds < float("inf"):
        raise TracerError(f"seconds: {seconds} is not a time")
    from lessons.course import about
    from tracer.learner.run import run

    traces = run(file, scene, _settings(options), seconds)
    diagnosis = _together(*(tracer.examine(trace) for trace in traces)).explained_by(about)
    if json:
        print_json(diagnosis.as_dict())
    else:
        from viewer.doctor_report import print_diagnosis

        print_diagnosis(diagnosis, traces[0])
    return 1 if diagnosis.findings else 0


def _write_starter(file):
    from tracer.learner import starter

    if file.exists():
        raise TracerError(f"{file}: is there already; choose another name")
    try:
        file.write_text(Path(starter.__file__).read_text(encoding="utf-8"), encoding="utf-8")
    except OSError as error:
        raise TracerError(f"{file}: {error.strerror}") from None
    print(f"{file}: a tracer to start from; castray check {file} judges it")


def _settings(options):
    """float64, pixel centres and lamps sampled by area, as the homework has them."""
    settings, _ = settings_and_steps(options)
    if settings.width is None:
        settings = replace(settings, width=SIDE, height=SIDE)
    if options is None or options.spp == CheckOptions().spp:
        settings = replace(settings, spp=SPP)
    return replace(settings, precision=64, integrator="direct", light_sampling="area", jitter=False)


def _together(first, second):
    """One diagnosis of two: what the first could not test is what the second says. The commands that would
    replay castray's own paths are left out."""
    open_ = {verdict.rule.id for verdict in first.rules if verdict.state == "not_testable"}
    later = {verdict.rule.id: verdict for verdict in second.rules}
    rules = tuple(later[v.rule.id] if v.rule.id in open_ else v for v in first.rules)
    more = [f for f in second.findings if f.rule in open_]
    seen = [f for f in first.findings if f.p is None]
    means = [f for f in first.findings if f.p is not None]
    if more:  # what is off on average is so because of them
        cause = next((f.rule for f in (*seen, *more) if f.follows is None), None)
        means = [replace(f, follows=cause, bug=None, alike=()) for f in means]
    findings = tuple(replace(f, command=None) for f in (*seen, *more, *means))
    return replace(first, findings=findings, rules=rules)
