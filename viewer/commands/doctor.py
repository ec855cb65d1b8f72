"""The command `castray doctor`."""

import sys

import tracer
from tracer.settings import TracerError
from viewer.options import DoctorOptions, Json, print_json, settings_and_steps, shrunk


def doctor(
    what: str, /, *, scene: str | None = None, options: DoctorOptions | None = None, json: Json = False
):
    """Hold the laws of light transport against a trace: what is wrong, where, and which mistake.

    Exit code 0 if nothing is found, 1 if something is.

    Parameters
    ----------
    what
        A scene file, or the bare name of one that comes with castray: it is traced with the path options.
        Or the log of another tracer, FILE.jsonl (castray log --schema).
    scene
        The scene that a log is of.
    """
    from lessons.course import about

    trace = _trace(what, scene, options)
    diagnosis = tracer.examine(trace).explained_by(about)
    if trace.settings.bug:  # which the doctor does not know
        diagnosis = diagnosis.replayed_with(f"--bug {trace.settings.bug}")
    if json:
        print_json(diagnosis.as_dict())
    else:
        from viewer.doctor_report import print_diagnosis

        print_diagnosis(diagnosis, trace)
    return 1 if diagnosis.findings else 0


def _trace(what, scene, options):
    """The Trace that the argument stands for."""
    from tracer.trace import gather

    if what.lower().endswith(".jsonl"):
        return _logged(what, scene)
    if scene is not None:
        raise TracerError(f"--scene: is for a log, FILE.jsonl; {what} is none")
    settings, steps = settings_and_steps(options)
    loaded = tracer.load(what)
    return gather(loaded, shrunk(settings, loaded), steps)


def _logged(file, scene):
    """The Trace of a log; what was found out in reading it goes to standard error."""
    from tracer.trace.jsonl import read_log

    if scene is None:
        raise TracerError(f"{file}: give --scene, the scene that this log is of")
    found = read_log(file, tracer.load(scene))
    more = found.read.mistaken - len(found.mistakes)
    said = [*map(str, found.mistakes), *([f"... and {more} more mistakes"] if more else []), *found.notes]
    for line in said:
        print(f"{file}: {line}", file=sys.stderr)
    return found.trace
