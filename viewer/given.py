"""Traces that a command is given: a recording's folder, or the log of another tracer."""

import sys
from pathlib import Path

import numpy as np

import tracer
from tracer.settings import TracerError
from tracer.trace import folder, join, read_parts
from viewer.words import Speaker

MOST_PATHS = 1 << 19  # of a recording looked at together: about half a gigabyte


def recorded_trace(path, most=None):
    """The Trace of a recording's folder; of a large one parts from all over the picture, about `most` paths,
    which is told on standard error. Raises TracerError."""
    place = folder.whole(path)
    if not place.kinds:
        raise TracerError(f"{path}: has one row a path and no events; record with --record-level events")
    paths = place.settings.width * place.settings.height * place.settings.spp
    numbers = None
    if most is not None and paths > most:
        few = max(1, int(place.parts * most / paths))
        numbers = np.unique(np.linspace(0, place.parts - 1, few).astype(int)).tolist()
        said = Speaker()("told.some_parts", path=path, paths=paths, n=len(numbers), parts=place.parts)
        print(said, file=sys.stderr)
    return join(read_parts(path, numbers=numbers))


def logged_trace(file, scene, name=None):
    """The Trace of a log of a scene (a file, a name or a Scene), told of under a name; what was found out in
    reading it goes to standard error. Raises TracerError."""
    from tracer.trace.jsonl import read_log

    if not Path(file).is_file():
        raise TracerError(f"{file}: there is no such file")
    if scene is None:
        raise TracerError(f"{file}: give --scene, the scene that this log is of")
    name = name or file
    found = read_log(file, tracer.load(scene) if isinstance(scene, str) else scene)
    more = found.read.mistaken - len(found.mistakes)
    say = Speaker()
    said = [say.error(str(one)) for one in (*found.mistakes, *found.notes)]
    said.insert(len(found.mistakes), say("log.more", n=more) if more else "")
    for line in filter(None, said):
        print(f"{name}: {line}", file=sys.stderr)
    return found.trace
