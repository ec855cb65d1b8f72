"""Whether a trace keeps the laws of light transport, as an assertion."""

import os
import shlex

from tracer.doctor import examine
from tracer.doctor.rule import NOT_TESTABLE
from tracer.settings import TracerError
from tracer.trace import Trace, read_trace
from tracer.trace.folder import at
from tracer.trace.pixels import place

MOST = 3  # findings told in full


def assert_healthy(trace, scene=None):
    """AssertionError if a Trace breaks a law; it says which, how often, at which vertex, and how to see it.

    trace: a Trace, the folder of a recording with events, or the log of another tracer (FILE.jsonl). scene:
    the Scene that a log is of, or the name of one. Statistical laws fire on a right trace once in 10 000.
    Raises TracerError for what cannot be read; a trace of which nothing can be judged is not healthy.
    """
    found, folder = _read(trace, scene)
    diagnosis = examine(found)
    if folder is not None and found.culled:
        diagnosis = diagnosis.shown_by(
            lambda first: f"castray view {at(folder, place(found, first))}{_of(scene)}"
        )
    elif folder is not None:
        diagnosis = diagnosis.shown_in(folder)
    elif found.settings.bug:
        diagnosis = diagnosis.replayed_with(f"--bug {found.settings.bug}")
    judged = [verdict for verdict in diagnosis.rules if verdict.state != NOT_TESTABLE]
    if not judged:
        missing = sorted({verdict.missing for verdict in diagnosis.rules})
        raise AssertionError(f"no law could be held against the trace: {'; '.join(missing[:MOST])}")
    if diagnosis.findings:
        raise AssertionError("\n".join(_said(diagnosis, len(judged))))


def _read(trace, scene):
    """(the Trace, the folder or log that it was read from, if any)."""
    if isinstance(trace, Trace):
        return trace, None
    path = os.fspath(trace)
    if path.lower().endswith(".jsonl"):
        from tracer.scene_file.load import load
        from tracer.trace.jsonl import read_log

        if scene is None:
            raise TracerError(f"{path}: name the scene that this log is of")
        return read_log(path, load(scene) if isinstance(scene, (str, os.PathLike)) else scene).trace, path
    return read_trace(path, scene), path


def _said(diagnosis, judged):
    """What is wrong, line by line, the first cause first."""
    causes = diagnosis.causes
    follow = len(diagnosis.findings) - len(causes)
    yield f"the trace breaks {len(causes)} of {judged} laws" + (f", and {follow} follow" if follow else "")
    for finding in causes[:MOST]:
        named = f", as {finding.bug} does (castray bugs {finding.bug})" if finding.bug else ""
        yield f"{finding.rule}: {finding.title}: not so at {finding.count} of {finding.checked}{named}"
        yield f"  {finding.law}  {finding.formula}"
        if finding.recorded is not None and finding.right is not None:
            yield f"  {finding.what}: recorded {_numbers(finding.recorded)}, right {_numbers(finding.right)}"
        if finding.explanation:
            yield f"  {finding.explanation}"
        if finding.first is not None:
            yield f"  first at {_place(finding.first)}"
            yield from filter(None, [finding.command and f"  {finding.command}"])
    if len(causes) > MOST:
        yield f"... and {', '.join(finding.rule for finding in causes[MOST:])}"


def _of(scene):
    return (
        f" --scene {shlex.quote(os.fspath(scene) if isinstance(scene, (str, os.PathLike)) else scene.name)}"
    )


def _place(first):
    event = (
        "" if first["kind"] is None else f", event {first['step']} ({first['kind']}, depth {first['depth']})"
    )
    return f"pixel ({first['x']}, {first['y']}), sample {first['sample']}{event}"


def _numbers(values):
    return " ".join("NaN" if value is None else f"{value:.6g}" for value in values)
