"""The command `castray log`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import tracer
from tracer.settings import ANY_DEPTH, TracerError
from viewer.options import Json, print_json
from viewer.words import Speaker


def log(
    file: Path | None = None,
    /,
    *,
    scene: str | None = None,
    schema: Annotated[bool, Parameter(negative=())] = False,
    header: Path | None = None,
    json: Json = False,
):
    """Check the log of your own tracer; write castray.h, which logs from C++.

    It says the first mistakes by line and field, and what castray makes of the rest.

    Exit code 0 if it can be read, 2 if it cannot.

    Parameters
    ----------
    file
        A log in JSON Lines.
    scene
        The scene that it is of: a file, or the bare name of one that comes with castray.
    schema
        Print the page that documents the format.
    header
        Write castray.h there, which logs from C++.
    """
    from tracer.trace.jsonl import header_file, read_log, schema_text

    if file is None and not schema and header is None:
        raise TracerError("give a log, --schema or --header FILE")
    if schema:
        print(schema_text(Speaker().optional), end="")
    if header is not None:
        _write(header, header_file())
    if file is None:
        return
    found = read_log(file, None if scene is None else tracer.load(scene))
    if json:
        print_json(as_dict(found))
        return
    say = Speaker()
    print(f"{file}: {_counts(found, say)}")
    for mistake in found.mistakes:
        print(say.error(str(mistake)))
    more = found.read.mistaken - len(found.mistakes)
    if more:
        print(say("log.more", n=more))
    for note in found.notes:
        print(say("log.note", note=say.error(note)))
    if found.read_off:
        known = ((name, value) for name, value in found.read_off.items() if value != ANY_DEPTH)
        said = say.listed(*(f"{name} {value}" for name, value in known))
        print(say("log.read_off", what=said))


def _write(path, source):
    try:
        path.write_bytes(source.read_bytes())
    except OSError as error:
        raise TracerError(f"{path}: {error.strerror or error}") from None


def _counts(found, say):
    if found.trace is None:
        return say("log.lines", lines=found.read.lines)
    trace = found.trace
    sizes = {name: table.path.size for name, table in trace.tables.items()}
    events = say.listed(*(f"{n} {say('kind.' + name)}" for name, n in sizes.items() if n))
    counts = {"lines": found.read.lines, "paths": trace.size, "vertices": trace.vertices}
    return say("log.holds", events=events, **counts)


def as_dict(found):
    """Plain values, as `castray log --json` prints them."""
    trace = found.trace
    return {
        "lines": found.read.lines,
        "paths": None if trace is None else trace.size,
        "vertices": None if trace is None else int(trace.vertices),
        "events": {} if trace is None else {name: t.path.size for name, t in trace.tables.items()},
        "mistakes": [vars(mistake) for mistake in found.mistakes],
        "mistaken": found.read.mistaken,
        "notes": list(found.notes),
        "read_off": found.read_off,
        "rebuilt": [] if trace is None else sorted(trace.rebuilt),
    }
