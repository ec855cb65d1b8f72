"""The command `castray doctor`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import tracer
from tracer.picture import check_place, write_whole
from tracer.settings import TracerError
from viewer.options import DoctorOptions, Json, print_json, scene_of, settings_and_steps, shrunk
from viewer.replay import replayed, shown_in_log


def doctor(
    what: str,
    /,
    *,
    scene: str | None = None,
    html: Path | None = None,
    gamma: float | None = None,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    options: DoctorOptions | None = None,
    json: Json = False,
):
    """Hold the laws of light transport against a trace: what is wrong, where, and which mistake.

    Exit code 0 if nothing is found, 1 if something is. A picture alone gives hypotheses, and exit code 0.

    Parameters
    ----------
    what
        A scene file, or the bare name of one that comes with castray: it is traced with the path options.
        Or a folder that castray render --record made with --record-level events, or the log of another
        tracer, FILE.jsonl (castray log --schema). Or a picture (.png, .ppm, .exr, .npy, ...) of your tracer.
    scene
        The scene that a log or a picture is of.
    html
        Where a report goes, too: one page that opens without a network, with the first finding's path in 3D.
    gamma
        Of a picture: the power to which light was raised before it was written; the homework's is 0.6.
    output
        Of a picture: a file for it, the right one and their ratio side by side.
    """
    from lessons.course import about
    from lessons.zoo import planted
    from tracer.doctor.fresh import by_chance, confirmed, fresh
    from tracer.picture import is_picture
    from tracer.trace import gather
    from viewer.recorded import is_recording

    if is_picture(what):
        if html is not None:
            raise TracerError(f"--html: is for a trace; {what} is a picture")
        return _picture(Path(what), scene, options, gamma, output, json)
    if gamma is not None or output is not None:
        raise TracerError(f"--{'gamma' if gamma is not None else 'output'}: is for a picture; {what} is none")
    if html is not None:
        check_place(html)
    recorded, logged = is_recording(what), what.lower().endswith(".jsonl")
    trace = _recorded(what, scene, options) if recorded else _trace(what, scene, options)
    diagnosis = tracer.examine(trace)
    if by_chance(diagnosis) and not recorded and not logged:
        diagnosis = confirmed(diagnosis, gather(trace.scene, fresh(trace.settings), planted(trace.settings)))
    diagnosis = diagnosis.explained_by(about)
    if logged:
        diagnosis = shown_in_log(diagnosis, trace, what, scene)
    else:
        diagnosis = replayed(diagnosis, trace.scene, trace.settings, what if recorded else None)
    if html is not None:
        _write(html, diagnosis, trace, again=not logged)
    if json:
        print_json(diagnosis.as_dict())
    else:
        from viewer.doctor_report import print_diagnosis

        print_diagnosis(diagnosis, trace)
    return 1 if diagnosis.findings else 0


def _picture(path, scene, options, gamma, output, json):
    """Hypotheses from a picture; they are no findings."""
    from viewer.picture_doctor import opinion_of
    from viewer.picture_report import as_dict, drawing, print_opinion

    opinion, loaded, known = opinion_of(path, scene, options, gamma, output)
    if output is not None:
        tracer.write(drawing(opinion, known), output)
    if json:
        print_json(as_dict(opinion, path, loaded, known))
    else:
        print_opinion(opinion, path, scene, known, gamma is None)
    return 0


def _write(file, diagnosis, trace, again):
    """The report as a page; again: whether the trace's paths can be traced again."""
    from viewer.sharing.report import report
    from viewer.words import Speaker

    text = report(diagnosis, trace.scene, trace.settings, trace.size, Speaker(), again)
    write_whole(file, lambda beside: Path(beside).write_text(text, encoding="utf-8"))


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
