"""The vertex of an event as text: vectors, where bounces go, the terms behind f, and both ends of its ray."""

from rich.console import Console
from rich.table import Table
from rich.text import Text

from viewer.caption import caption, named
from viewer.numerals import several
from viewer.traces import last_hit
from viewer.understanding import microscope
from viewer.understanding.lens_words import NAMES, judged, lobes, tried, vector
from viewer.words import Speaker

_STYLES = {"good": "green", "warning": "bold red", "dim": "dim"}


def print_vertex(record, scene, event, lens, ends, console=None):
    """The Lens over an event of a record's one path, and the Ends of its ray (None where it casts none)."""
    console, say = console or Console(highlight=False, soft_wrap=True), Speaker()
    path = record.paths[0]
    hit = last_hit(path, event)
    console.print(Text(caption(path.events[event], scene, say), style="bold"))
    names = {name: named(name, hit[name], scene) for name in ("shape", "bsdf")}
    console.print(say("lens.at", **names) + "\n")
    _print_lines(((NAMES[name], vector(w, say)) for name, w in lens.vectors.items()), console)
    verdict = judged(lens, say)
    console.print(Text(verdict["verdict"], style=_STYLES[verdict["judged"]]))
    for line in (*lobes(lens, say), tried(lens, say)):
        console.print(line)
    if lens.terms:
        table = Table(box=None, padding=(0, 2, 0, 0))
        for head in ("", say("ui.vertex_here"), say("ui.vertex_head_on")):
            table.add_column(head, no_wrap=True)
        table.add_column("")
        for name, (here, head_on) in lens.terms.items():
            table.add_row(name, several(here), several(head_on), Text(say(f"term.{name}"), style="dim"))
        console.print()
        console.print(table)
    if ends is not None:
        console.print("\n" + say("ui.vertex_microscope"))
        _print_lines(
            ((say(f"microscope.{n}"), said) for n, said in microscope.lines(ends, scene, say)), console
        )
        console.print(microscope.verdict(ends, say))


def _print_lines(lines, console):
    """Names and words, line by line."""
    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    for name, said in lines:
        table.add_row(Text(name, style="cyan"), said)
    console.print(table)
