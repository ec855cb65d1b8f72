"""A pixel and its paths as text: event by event, names, numbers, units, and the ledger that adds up."""

import numpy as np
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from tracer.testing.errorbars import NO_ERROR
from viewer.caption import applies, caption, shown, unit_of, why_dead
from viewer.folded import Folded
from viewer.understanding.waterfall import bar_name, waterfall
from viewer.understanding.why import why
from viewer.words import Speaker

_LEDGER_KINDS = ("hit", "light", "escape")


def print_pixel(record, scene, console=None):
    """The pixel's samples, its brightest path event by event, and both sums."""
    console, say = _begun(record, scene, console)
    chosen = max(record.paths, key=lambda path: float(np.sum(path.radiance, dtype=np.float64)))
    _print_path(chosen, scene, say, console)
    _print_samples(record, chosen, say, console)


def print_why(record, scene, console=None):
    """Why the pixel is what it is, in sentences, and what it is made of."""
    console, say = _begun(record, scene, console)
    for reason in why(record, scene):
        line = Text("- " + reason.sentence(say))
        if reason.place:
            path, event = reason.place
            seen = say("why.see", path=record.paths[path].sample, event=event)
            line.append(f"  ({seen})", style="dim")
        console.print(line)
    table = _table("made_of", ("what", "red", "green", "blue"), "what", say)
    for bar in waterfall(record):
        table.add_row(bar_name(bar, say), *(f"{float(v):.8g}" for v in bar.value))
    table.add_row(say("inspect.sum"), *(str(v) for v in record.value), style="bold")
    console.print()
    console.print(table)


def _begun(record, scene, console):
    """The console, with the head of a report on it, and the words."""
    console, say = console or Console(highlight=False, soft_wrap=True), Speaker()
    about = {name: getattr(record.settings, name) for name in ("width", "height", "integrator", "seed")}
    console.print(say("inspect.head", x=record.x, y=record.y, scene=scene.name, **about) + "\n")
    return console, say


def print_needs(features, console=None):
    """What a picture needs of the tracer and what is skipped, a line each."""
    table, say = Table(box=None, show_header=False, padding=(0, 2, 0, 0)), Speaker()
    for need in features:
        word = say("render.on" if need.on else "render.off")
        why = Folded(Text(say.need(need.why)))
        table.add_row(word, say.need(need.name), why, style="" if need.on else "dim")
    (console or Console(highlight=False)).print(table)


def _print_path(path, scene, say, console):
    console.print(Text(say("inspect.path", sample=path.sample), style="bold"))
    explained = set()
    for event in path.events:
        console.print()
        head = Text(f"{event.step:>3}  {say(f'kind.{event.kind.name}')}", style="bold cyan")
        head.append(f"  ({say('inspect.depth', depth=event.depth)})  ", style="dim")
        head.append(caption(event, scene, say), style="default")
        console.print(head)
        for field in event.kind.fields:
            value = event.values[field.name]
            if applies(field, value):
                meaning = "" if event.kind in explained else say.meaning(event.kind, field.name)
                _print_field(field, value, meaning, scene, say, console)
        explained.add(event.kind)
    dead = why_dead(path, scene, say)
    if dead:
        console.print()
        console.print(dead)
    _print_ledger(path, say, console)


def _print_field(field, value, meaning, scene, say, console):
    """One line: name, value, unit, and what it means where the kind of event is met for the first time."""
    line = Text("     ")
    line.append(f"{field.name:<17}", style="green")
    said = shown(field, value, scene, say)
    line.append(said + " " * max(1, 39 - cell_len(said)))
    line.append(f"{unit_of(field):<9}")
    line.append(meaning, style="dim")
    line.rstrip()
    console.print(line)


def _table(title, names, left, say):
    """An empty table; the column `left` has words, the others numbers."""
    table = Table(title=say(f"inspect.{title}"), title_justify="left", box=None, title_style="bold")
    for name in names:
        table.add_column(say(f"inspect.{name}"), justify="left" if name == left else "right")
    return table


def _print_ledger(path, say, console):
    """Every contribution, and that they add up to the path's radiance."""
    table = _table("brings", ("event", "what", "red", "green", "blue"), "what", say)
    total = np.zeros(3, path.radiance.dtype)
    for event in path.events:
        if event.kind.name in _LEDGER_KINDS:
            contribution = event.values["contribution"]
            total = total + contribution
            if contribution.any():
                what = say("inspect.source", kind=say(f"kind.{event.kind.name}"), depth=event.depth)
                table.add_row(str(event.step), what, *(str(v) for v in contribution))
    table.add_row("", say("inspect.sum"), *(str(v) for v in total), style="bold")
    console.print()
    console.print(table)


def _print_samples(record, chosen, say, console):
    """Every sample, and that their mean is the pixel."""
    table = _table("made_of", ("sample", "vertices", "end", "red", "green", "blue"), "end", say)
    for path in record.paths:
        vertices = sum(event.kind.name == "hit" for event in path.events)
        mark = "*" if path is chosen else ""
        radiance = (str(v) for v in path.radiance)
        table.add_row(
            f"{mark}{path.sample}", str(vertices), say.optional(f"choice.{path.end}", path.end), *radiance
        )
    table.add_row(say("inspect.mean"), "", "", *(str(v) for v in record.value), style="bold")
    several, parts = len(record.paths) > 1, record.settings.parts
    if several and parts != 1:
        table.add_row(say("inspect.error"), "", "", *(f"{v:.2g}" for v in np.sqrt(record.variance)))
    console.print()
    console.print(table)
    if several and parts == 1:
        console.print(say("inspect.unknown", why=NO_ERROR))
    elif several and parts:
        console.print(say("inspect.replicates", parts=parts))
    console.print(say("inspect.shown") if several else "")
