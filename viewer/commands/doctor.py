"""The command `castray doctor`."""

import shlex

import tracer
from tracer.scene_file.change import written
from tracer.settings import TracerError
from viewer.options import DoctorOptions, Json, print_json, scene_of, settings_and_steps, shrunk


def doctor(
    what: str, /, *, scene: str | None = None, options: DoctorOptions | None = None, json: Json = False
):
    """Hold the laws of light transport against a trace: what is wrong, where, and which mistake.

    Exit code 0 if nothing is found, 1 if something is.

    Parameters
    ----------
    what
        A scene file, or the bare name of one that comes with castray: it is traced with the path options.
        Or a folder that castray render --record made with --record-level events, or the log of another
        tracer, FILE.jsonl (castray log --schema).
    scene
        The scene that a log is of.
    """
    from lessons.course import about
    from viewer.recorded import is_recording

    recorded = is_recording(what)
    trace = _recorded(what, scene, options) if recorded else _trace(what, scene, options)
    diagnosis = tracer.examine(trace).explained_by(about)
    if recorded:
        diagnosis = diagnosis.shown_in(what)
    elif trace.settings.bug:  # which the doctor does not know
        diagnosis = diagnosis.replayed_with(f"--bug {trace.settings.bug}")
    for text in written(trace.scene.definition.changes):
        diagnosis = diagnosis.replayed_with(f"--set {shlex.quote(text)}")
    if json:
        print_json(diagnosis.as_dict())
    else:
        from viewer.doctor_report import print_diagnosis

        print_diagnosis(diagnosis, trace)
    return 1 if diagnosis.findings else 0


def _recorded(what, scene, options):
    """The Trace of a recording."""
    from viewer.given import MOST_PATHS, recorded_trace

    if options is not None or scene is not None:
        raise TracerError(
            f"{what}: a recording has its own scene and settings; leave out --scene and path options"
        )
    return recorded_trace(what, MOST_PATHS)


def _trace(what, scene, options):
    """The Trace that the argument stands for."""
    from tracer.trace import gather

    if what.lower().endswith(".jsonl"):
        if options is not None and options.set:
            raise TracerError(f"set: {what} is of the scene as it is; --set is for scenes that are traced")
        from viewer.given import logged_trace

        return logged_trace(what, scene)
    if scene is not None:
        raise TracerError(f"--scene: is for a log, FILE.jsonl; {what} is none")
    settings, steps = settings_and_steps(options)
    loaded = scene_of(what, options)
    return gather(loaded, shrunk(settings, loaded), steps)
