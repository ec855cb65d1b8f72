"""The command `castray doctor`."""

import tracer
from viewer.options import DoctorOptions, Json, print_json, settings_and_steps, shrunk


def doctor(scene: str, /, *, options: DoctorOptions | None = None, json: Json = False):
    """Hold the laws of light transport against a trace: what is wrong, where, and which mistake.

    Exit code 0 if nothing is found, 1 if something is.

    Parameters
    ----------
    scene
        A scene file, or the bare name of one that comes with castray: it is traced with the path options.
    """
    trace = _trace(scene, options)
    diagnosis = tracer.examine(trace)
    if trace.settings.bug:  # which the doctor does not know
        diagnosis = diagnosis.replayed_with(f"--bug {trace.settings.bug}")
    if json:
        print_json(diagnosis.as_dict())
    else:
        from viewer.doctor_report import print_diagnosis

        print_diagnosis(diagnosis, trace)
    return 1 if diagnosis.findings else 0


def _trace(what, options):
    """The Trace that the argument stands for."""
    from tracer.trace import gather

    settings, steps = settings_and_steps(options)
    loaded = tracer.load(what)
    return gather(loaded, shrunk(settings, loaded), steps)
