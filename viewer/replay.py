"""The commands that show a path again, as a person types them."""

import shlex
from dataclasses import fields

import tracer
from tracer import what_if
from tracer.scene_file.change import written
from tracer.settings import Settings
from tracer.trace import pixels
from tracer.trace.folder import at
from viewer.link import Link


def inspect_command(scene, settings, place, changes=None, supposed=None):
    """`castray inspect` of the path at (x, y, sample, step) of a scene, by the name it was asked for; of all
    paths of the pixel where sample is None.

    changes: of the scene's words, {key: value}; supposed: of the path, {(depth, kind): value}.
    """
    x, y, sample, _ = place
    words = [f"castray inspect {shlex.quote(scene)} --pixel {x} {y}"]
    words += [] if sample is None else [f"--sample {sample}"]
    words += [*_options(settings, changes or {}), *_what_if(supposed or {})]
    return " ".join(words)


def _options(settings, changes):
    """Settings and changes as a command's options; those that have their default are left out."""
    words = [f"--size {settings.width} {settings.height}"]
    for f in fields(Settings):
        value = getattr(settings, f.name)
        if f.name not in ("width", "height") and value != f.default:
            option = f.name.replace("_", "-")
            words.append(f"--no-{option}" if value is False else f"--{option} {value}")
    return words + [f"--set {shlex.quote(text)}" for text in written(changes)]


def _what_if(supposed):
    return [f"--what-if {text}" for text in what_if.written(supposed)]


def view_command(scene, settings, place, changes=None):
    """`castray view` at (x, y, sample, step); None for a scene that a link cannot name."""
    return opening(Link(scene, settings, place, changes or {}))


def serving(scene, settings, changes):
    """`castray view` of a scene by the name it was asked for, be it a file."""
    return " ".join([f"castray view {shlex.quote(scene)}", *_options(settings, changes)])


def opening(link):
    """`castray view` of a Link; None for a scene that a link cannot name."""
    if link.scene not in tracer.built_in_scenes():
        return None
    return f"castray view {shlex.quote('#' + link.write())}"


def of_scene(file, scene, place=None):
    """A file of another tracer and its scene, as the commands that judge or open it take them; with
    (x, y, path, event) for castray view, which opens it there."""
    named = shlex.quote(str(file)) if place is None else at(file, place)
    return f"{named} --scene {shlex.quote(str(scene))}"


def view_of(file, scene, trace, first):
    """`castray view` of a file of another tracer, whose Trace is without gaps or a log's, at the event that
    {x, y, sample, step} name."""
    return f"castray view {of_scene(file, scene, pixels.place(trace, first))}"


def shown_in_log(diagnosis, trace, file, scene):
    """The diagnosis of a log's Trace, each finding with the command that opens it at its event."""
    return diagnosis.shown_by(lambda first: view_of(file, scene, trace, first))


def replayed(diagnosis, scene, settings, recording=None):
    """A diagnosis of a scene's paths whose commands replay them as they are: with the bug and the changes,
    which the doctor does not know; of a recording's folder, in that."""
    if recording is not None:
        return diagnosis.shown_in(recording)
    if settings.bug:
        diagnosis = diagnosis.replayed_with(f"--bug {settings.bug}")
    for text in written(scene.definition.changes):
        diagnosis = diagnosis.replayed_with(f"--set {shlex.quote(text)}")
    return diagnosis
