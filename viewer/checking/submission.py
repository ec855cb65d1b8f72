"""One submission: what kind of file it is, and what there is to say of it in a row of a table."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tracer
from tracer.doctor.rule import FIRED, NOT_TESTABLE
from tracer.events import KINDS
from tracer.picture import is_picture
from tracer.settings import TracerError
from viewer.replay import of_scene, shown_in_log

RIGHT, WRONG, MAYBE, FAILED, SKIPPED = "right", "findings", "hypotheses", "failed", "skipped"
STATES = (RIGHT, WRONG, MAYBE, FAILED, SKIPPED)
_ORDER = [kind.name for kind in KINDS]


@dataclass(frozen=True)
class Row:
    """What there is to say of a submission.

    state: one of STATES. passed, failed: kinds of event, with path for what is asked of whole paths, of which
    no law is broken, or one. found: a Finding of a trace, a Hypothesis of a picture, or None. error: the line
    that says why it could not be judged, with its path or its name. command: shows it alone. more: all
    findings with a cause of their own, each with the command that opens the viewer at its event, or all
    hypotheses. opens: opens the viewer on a picture, beside the right one.
    """

    name: str
    state: str
    passed: tuple = ()
    failed: tuple = ()
    found: Any = None
    more: tuple = ()
    error: str = ""
    path: str = ""
    command: str = ""
    opens: str = ""


def row_of(path, name, scene, options, seconds):
    """The Row of one file: whatever happens to it, it is a row."""
    try:
        if path.suffix.lower() == ".py":
            return _of_tracer(path, name, scene, options, seconds)
        if path.suffix.lower() == ".jsonl":
            return _of_log(path, name, scene)
        if is_picture(path.name):
            return _of_picture(path, name, scene)
    except TracerError as error:
        return Row(name, FAILED, error=" ".join(str(error).split()), path=str(path))
    except MemoryError:
        return Row(name, FAILED, error="not enough memory to judge it")
    except Exception as error:  # one submission never costs the others their rows
        return Row(name, FAILED, error=f"castray could not judge it: {type(error).__name__}: {error}")
    return Row(name, SKIPPED)


def _of_tracer(path, name, scene, options, seconds):
    from viewer.checking.learner import examined, said, settings_of

    diagnosis, _ = examined(path, scene, options, seconds, quiet=True)
    traced = said(settings_of(options))
    return _of_diagnosis(name, diagnosis, f"castray check {of_scene(path, scene)}{traced}")


def _of_log(path, name, scene):
    from tracer.trace.jsonl import read_log

    trace = read_log(str(path), tracer.load(scene)).trace
    diagnosis = shown_in_log(tracer.examine(trace), trace, path, scene)
    if all(verdict.state == NOT_TESTABLE for verdict in diagnosis.rules):
        return Row(name, FAILED, error="no law could be held against it: too few fields are logged")
    return _of_diagnosis(name, diagnosis, f"castray doctor {of_scene(path, scene)}")


def _of_diagnosis(name, diagnosis, command):
    from lessons.course import about

    causes = diagnosis.explained_by(about).causes
    tested = {v.rule.kind for v in diagnosis.rules if v.state != NOT_TESTABLE}
    kind_of = {v.rule.id: v.rule.kind for v in diagnosis.rules if v.state == FIRED}
    failed = {kind_of[f.rule] for f in causes}
    return Row(
        name,
        WRONG if causes else RIGHT,
        _sorted(tested - failed),
        _sorted(failed),
        causes[0] if causes else None,
        causes,
        command=command,
    )


def _of_picture(path, name, scene):
    from tracer.doctor.picture import opened
    from viewer.picture_doctor import album_of, opinion_on
    from viewer.picture_report import beside

    given = opened(path)
    loaded, known = album_of(scene)
    opinion, _ = opinion_on(given, loaded, known=known)
    command = f"castray doctor {of_scene(path, scene)}"
    if opinion.is_right:
        return Row(name, RIGHT, command=command)
    first = opinion.hypotheses[0] if opinion.hypotheses else None
    return Row(name, MAYBE, found=first, more=opinion.hypotheses, command=command, opens=beside(path, scene))


def _sorted(kinds):
    return tuple(sorted(kinds, key=lambda kind: _ORDER.index(kind) if kind in _ORDER else -1))


def files_in(folder):
    """Every file below a folder with its name there, sorted; hidden ones and caches are left out. Raises
    TracerError where there is none."""
    folder = Path(folder)
    try:
        found = sorted(path for path in folder.rglob("*") if path.is_file() and not _hidden(path, folder))
    except OSError as error:
        raise TracerError(f"{folder}: cannot be read: {error.strerror or error}") from None
    if not found:
        raise TracerError(f"{folder}: is empty; put tracers (.py), logs (.jsonl) or pictures into it")
    return [(path, path.relative_to(folder).as_posix()) for path in found]


def _hidden(path, folder):
    return any(part.startswith(".") or part == "__pycache__" for part in path.relative_to(folder).parts)
