"""The command `castray twin`."""

from dataclasses import dataclass, replace
from typing import Annotated, Any

from cyclopts import Parameter

from tracer.settings import TracerError
from viewer.options import DoctorOptions, Json, Whole, print_json, scene_of, settings_and_steps, shrunk

MOST = 1000


@dataclass(frozen=True)
class Side:
    """One of the two: what to call it, its Trace, and from (x, y, sample, step) to commands that show it."""

    name: str
    trace: Any
    commands: Any


def twin(
    what: str,
    other: str | None = None,
    /,
    *,
    scene: str | None = None,
    limit: Annotated[int, Whole] = 5,
    exact: Annotated[bool, Parameter(negative=())] = False,
    options: DoctorOptions | None = None,
    json: Json = False,
):
    """Run right and wrong in step with the same random numbers: where do paths part, and what does it do?

    For each path it finds the first event that differs, and it says which share of the difference enters at
    which depth and technique. Exit code 0 if no event differs, 1 if some do.

    Parameters
    ----------
    what
        A scene, with --bug: the right tracer beside the wrong one. Or a trace, and another one beside it: a
        folder that castray render --record made with --record-level events, or a tracer's log, FILE.jsonl.
    other
        The other trace.
    scene
        The scene that logs are of.
    limit
        Most paths listed of those that differ most.
    exact
        Every bit counts; otherwise roundings of one number are the same.
    """
    from tracer.twin import compare

    if not 1 <= limit <= MOST:
        raise TracerError(f"limit: {limit} is not between 1 and {MOST}")
    sides = _planted(what, scene, options) if other is None else _recorded(what, other, scene, options)
    one, other_one = sides
    found = compare(one.trace, other_one.trace, (one.name, other_one.name), limit, exact)
    bug = sides[1].trace.settings.bug if other is None else None
    if json:
        from viewer.twin_plain import as_dict

        print_json(as_dict(found, sides))
    else:
        from viewer.twin_report import print_twin

        print_twin(found, sides, bug)
    return 0 if found.same else 1


def _planted(what, scene, options):
    """The right tracer and the one with the bug."""
    from lessons.zoo import RIGHT
    from tracer.trace import gather
    from viewer.recorded import is_recording

    if what.lower().endswith(".jsonl") or is_recording(what):
        raise TracerError(f"twin: {what} is one trace; name the other one, too")
    if scene is not None:
        raise TracerError(f"--scene: is for logs, FILE.jsonl; {what} is none")
    settings, steps = settings_and_steps(options)
    if settings.bug is None:
        raise TracerError("twin: give --bug ID (castray bugs lists them), or two traces")
    loaded = scene_of(what, options)
    wrong = shrunk(settings, loaded)
    sides = ("right", replace(wrong, bug=None), RIGHT), ("wrong", wrong, steps)
    return tuple(
        Side(name, gather(loaded, asked, with_steps), _scene_commands(what, loaded, asked))
        for name, asked, with_steps in sides
    )


def _scene_commands(what, scene, settings):
    from viewer.replay import inspect_command, view_command

    def commands(place):
        changes = scene.definition.changes
        both = (command(what, settings, place, changes) for command in (inspect_command, view_command))
        return [command for command in both if command]

    return commands


def _recorded(what, other, scene, options):
    """Two traces that are there."""
    if options is not None:
        raise TracerError("twin: two traces have their own settings; leave out the path options")
    return tuple(_side(name, scene) for name in (what, other))


def _side(what, scene):
    from tracer.trace.folder import view_command
    from viewer.given import logged_trace, recorded_trace
    from viewer.recorded import is_recording
    from viewer.replay import view_of

    if what.lower().endswith(".jsonl"):
        trace, names = logged_trace(what, scene), ("x", "y", "sample", "step")
        return Side(
            what,
            trace,
            lambda place: [view_of(what, scene, trace, dict(zip(names, place, strict=True)))],
        )
    if not is_recording(what):
        raise TracerError(f"twin: {what} is neither a recording's folder nor a log, FILE.jsonl")
    return Side(what, recorded_trace(what), lambda place: [view_command(what, place)])
