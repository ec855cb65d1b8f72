"""The command `castray query`."""

import shlex
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from tracer.picture import check_path
from tracer.settings import TracerError
from tracer.trace import folder
from tracer.trace.asker import ask
from tracer.trace.breakpoints import BREAKPOINTS, condition
from tracer.trace.query import SECONDS, strangers
from viewer.link import Link
from viewer.options import Json, Whole, print_json
from viewer.words import Speaker

MOST_ROWS = 1_000_000
_STOPS = "; ".join(f"{name}: {b.about}" for name, b in BREAKPOINTS.items())


def query(
    trace: Path | None = None,
    text: str | None = None,
    /,
    *,
    break_: Annotated[str | None, Parameter(name="--break", help=f"A named breakpoint. {_STOPS}.")] = None,
    mask: Path | None = None,
    limit: Annotated[int, Whole] = 20,
    seconds: float = SECONDS,
    schema: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
):
    """Find the paths of a recording that did something: castray query DIR "depth >= 2 AND pdf < 1e-4".

    Parameters
    ----------
    trace
        A folder that castray render --record made.
    text
        A condition on the view events (on paths, where only those were recorded), or one SELECT. Vectors are
        p.x, colours beta.r; macros dot(n, wi), length(p), luminance, largest, smallest, no_number of colours.
    mask
        A picture of where the paths are, over the grey picture (.png).
    limit
        Most paths or rows shown.
    seconds
        Longest a query may take.
    schema
        Say what a recording consists of: files, views, every column with its meaning and unit.
    """
    if schema:
        from tracer.trace.views import schema as page

        print(page(Speaker().optional))
        return 0
    if trace is None:
        raise TracerError("query: name a recording's folder, or ask --schema")
    if (text is None) == (break_ is None):
        raise TracerError("query: give a condition or a SELECT, or one of --break " + ", ".join(BREAKPOINTS))
    if not 1 <= limit <= MOST_ROWS:
        raise TracerError(f"limit: {limit} is not between 1 and {MOST_ROWS}")
    if not 0.0 < seconds < 1e6:
        raise TracerError(f"seconds: {seconds} is not a time")
    if mask is not None:
        check_path(mask)
    place = folder.whole(trace)
    asked = text if text is not None else condition(break_, place.level)
    answer = ask(trace, asked, limit, seconds)
    if mask is not None:
        _write_mask(place, answer, mask)
    if "found" not in answer:
        print_json(answer) if json else _print_rows(answer)
        return 0
    for path in answer["found"]:
        path["link"] = _link(place, path)
        path["view"] = _command(trace, path)
    if json:
        print_json({"trace": str(trace), "condition": asked, **answer})
    else:
        _print_paths(answer)
        if not answer["found"]:
            _print_strangers(strangers(place, asked))
        if mask is not None:
            print(Speaker()("told.mask", file=mask))
    return 0


def _print_strangers(names):
    """Why nothing was found: names that nothing in the recording has."""
    say = Speaker()
    for name, near in names:
        said = say("query.near", near=say.listed(*map(repr, near))) if near else ""
        print(say.sentences(say("query.stranger", name=repr(name)), said))


def _link(place, path):
    """The moment as castray view opens it."""
    where = (path["x"], path["y"], path["sample"], path["step"])
    return "#" + Link(place.header["scene"]["name"], place.settings, where).write()


def _command(trace, path):
    """The command that opens the viewer there."""
    words = f"{trace}#x={path['x']}&y={path['y']}&path={path['sample']}&event={path['step']}"
    return f"castray view {shlex.quote(words)}"


def _print_paths(answer):
    """How many match, the first of them, and how to look at the first."""
    say = Speaker()
    print(say("query.count", **{name: answer[name] for name in ("events", "paths", "pixels")}))
    if not answer["found"]:
        return
    rows = [
        [
            f"{p['x']} {p['y']}",
            p["sample"],
            say.optional(f"kind.{p['kind']}", ""),
            "" if p["depth"] is None else p["depth"],
            p["events"],
        ]
        for p in answer["found"]
    ]
    _print_table([say(f"query.{name}") for name in ("pixel", "sample", "first", "depth", "events")], rows)
    if len(rows) < answer["paths"]:
        print(say("query.more", n=answer["paths"] - len(rows)))
    print(say("query.look", command=answer["found"][0]["view"]))


def _print_rows(answer):
    _print_table(answer["columns"], answer["rows"])
    if answer["more"]:
        print(Speaker()("query.more_rows"))


def _print_table(names, rows):
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, padding=(0, 2, 0, 0))
    for name in names:
        table.add_column(Text(str(name)), overflow="fold")
    for row in rows:
        table.add_row(*(Text("" if v is None else str(v)) for v in row))
    Console(highlight=False, soft_wrap=True).print(table)


def _write_mask(place, answer, path):
    """The pixels with matches in colour over the grey picture, brighter where more of their paths match."""
    import numpy as np

    import tracer
    from tracer.trace.reading import picture

    found = answer.get("mask")
    if found is None:
        raise TracerError("mask: is for a condition; a SELECT has no pixels")
    rgb = picture(place)
    grey = np.clip(rgb @ np.array([0.2126, 0.7152, 0.0722], np.float32), 0.0, 1.0) * 0.35
    shown = np.repeat(grey[..., None], 3, axis=2).astype(np.float32)
    for x, y, paths in found:
        share = paths / place.settings.spp
        shown[y, x] = (0.3 + 0.7 * share, 0.25 * share, 0.02)
    tracer.write(shown, path)
