"""What a twin run found, as text."""

from rich.cells import cell_len
from rich.console import Console
from rich.text import Text

from lessons.zoo import several
from viewer.folded import Folded
from viewer.numerals import luminance
from viewer.twin_shares import decimals_of, print_shares, short_names, table
from viewer.twin_words import (
    all_that_differs,
    event_of,
    in_digits,
    kind_of,
    range_of,
    told_apart,
    what_differs,
)
from viewer.words import Speaker
from viewer.zoo import title_of

_WIDEST = 100
_NEARLY = 0.9  # of the pairs
_CAUSES = 8  # most kinds of parting that are listed


def print_twin(twin, sides, bug=None, console=None):
    """A Twin of two Sides; bug: id of the planted one."""
    console, say = console or Console(highlight=False), Speaker()
    console.width = min(console.width, _WIDEST)
    names = (say("twin.right"), say("twin.wrong")) if bug else twin.names
    _print_head(twin, names, sides, bug, say, console)
    if twin.same:
        _print_same(twin, bug, say, console)
        return
    if not twin.differing:
        console.print(say("twin.no_twins"))
        return
    if not bug and _out_of_step(twin, sides):
        console.print(Folded(Text(say("twin.other_numbers"), style="bold yellow")))
        if any(side.trace.culled for side in sides):
            console.print(Folded(Text(say("twin.own_seed"), style="yellow")))
    _print_causes(twin, names, say, console)
    if twin.told is not None:
        print_shares(twin, names, say, console)
    _print_example(twin.largest[0], names, sides, say, console)
    _print_largest(twin, sides, say, console)


def _print_head(twin, names, sides, bug, say, console):
    one = sides[0].trace
    about = {name: getattr(one.settings, name) for name in ("width", "height", "spp", "integrator", "seed")}
    title = say("twin.and", one=names[0], other=names[1])
    if bug:
        title = say("twin.title", bug=bug, title=say.listed(*(title_of(one, say) for one in several(bug))))
    console.print(Folded(Text(title, style="bold")))
    console.print(Folded(Text(say("twin.head", scene=one.scene.name, **about))))
    console.print(say("twin.pairs", pairs=twin.pairs))
    for name, count in zip(names, twin.alone, strict=True):
        if count:
            console.print(Folded(Text(say("twin.alone", count=count, name=name), style="yellow")))
    for note in twin.notes:
        console.print(Folded(Text(note, style="yellow")))
    if twin.uncompared:
        fields = [say("twin.only", field=place, name=names[which]) for place, which in twin.uncompared]
        console.print(Folded(Text(say("twin.uncompared", fields=say.listed(*fields)), style="dim")))
    console.print()


def _print_same(twin, bug, say, console):
    said = say("twin.rounded", count=twin.rounded) if twin.rounded else say("twin.same")
    console.print(Folded(Text(said, style="bold green")))
    if not bug:
        return
    known = [one for one in several(bug) if not one.only_cost]
    if not known:
        console.print(say("twin.cost", bug=bug))
        return
    console.print(say("twin.elsewhere", bug=bug))
    for one in known:
        words = one.command.replace("castray render", "castray twin", 1)
        console.print(Text(words, style="cyan"), soft_wrap=True)


def _out_of_step(twin, sides):
    """Whether paths part as those do that have nothing in common: at the camera or, of logs, which need not
    have that, nearly all at the first surface."""
    if twin.differing == twin.pairs and all(c.kinds[0] == "camera" for c in twin.causes):
        return True
    early = sum(cause.pairs for cause in twin.causes if max(cause.depths) == 0)
    return sides[0].trace.culled and early >= _NEARLY * twin.pairs


def _print_causes(twin, names, say, console):
    """Kinds of first difference, the most frequent first."""
    console.print(
        say(
            "twin.part_rounded" if twin.rounded else "twin.part",
            count=twin.differing,
            share=f"{100.0 * twin.differing / twin.pairs:.3g} %",
            same=twin.pairs - twin.differing,
            rounded=twin.rounded,
        )
    )
    console.print()
    console.print(Folded(Text(say("twin.where"), style="bold")))
    rows = table()
    for name in ("event", "what"):
        rows.add_column(say(f"twin.{name}"), overflow="fold")
    for name in ("count", "at_depth", "red", "green", "blue"):
        rows.add_column(say(f"twin.{name}"), justify="right", no_wrap=True)
    decimals = decimals_of(c.difference for c in twin.causes if c.difference)
    for cause in twin.causes[:_CAUSES]:
        brought = [f"{v:+.{decimals}f}" for v in cause.difference or ()] or ["", "", ""]
        depths = range_of(cause.depths, say)
        rows.add_row(
            event_of(cause.kinds, say), all_that_differs(cause, say), str(cause.pairs), depths, *brought
        )
    console.print(rows)
    rest = twin.causes[_CAUSES:]
    if rest:
        said = say("twin.more", count=sum(cause.pairs for cause in rest), ways=len(rest))
        console.print(Folded(Text(said, style="dim")))
    if twin.told is not None:
        console.print(Folded(Text(say("twin.brought", one=names[0], other=names[1]), style="dim")))
    console.print()


def _place(parting, say):
    """Where a pair parts, as words take it."""
    step, depth = (next(v for v in of_both if v is not None) for of_both in (parting.steps, parting.depths))
    where = {name: getattr(parting, name) for name in ("x", "y", "sample")}
    return where | {"step": step, "depth": depth, "event": event_of(parting.kinds, say)}


def _print_example(parting, names, sides, say, console):
    """The pair with the largest difference, at the event where it parts."""
    console.print(Folded(Text(say("twin.example", **_place(parting, say)), style="bold")))
    console.print(Folded(Text(say("twin.before"), style="dim")))
    short = short_names(names, say)
    rows = [("", *short, "")]
    if not parting.numbers:
        rows.append((say("twin.event"), *(kind_of(kind, say) for kind in parting.kinds), ""))
    for n in parting.numbers:
        meaning = say.optional(f"field.{parting.kinds[0]}.{n.field.name}", n.field.meaning)
        rows.append((n.field.name, *told_apart(n, [side.trace.scene for side in sides], say), meaning))
    if parting.radiance is not None and parting.what != "radiance":
        rows.append((say("twin.radiance"), *(in_digits(v, 5) for v in parting.radiance), say("twin.of_path")))
    _print_columns(rows, parting.what, console)
    for name, side, step in zip(short, sides, parting.steps, strict=True):
        for command in side.commands(parting.place(step)):
            console.print(Text(say("twin.command", name=name)).append(command, style="cyan"), soft_wrap=True)
    console.print()


def _print_columns(rows, what, console):
    """Rows of name, both values, meaning, which is cut off at the edge; the one named `what` stands out."""
    widths = [max(cell_len(row[k]) for row in rows) + 2 for k in range(3)]
    for *columns, meaning in rows:
        name, one, other = (
            text + " " * (w - cell_len(text)) for text, w in zip(columns, widths, strict=True)
        )
        line = Text(name, style="bold green" if columns[0] == what else "green")
        line.append(one + other, style="bold" if columns[0] == what else "default")
        line.append(meaning, style="dim not bold")
        line.truncate(console.width, overflow="ellipsis")
        line.rstrip()
        console.print(line, soft_wrap=True)


def _print_largest(twin, sides, say, console):
    """More pairs, a line each, with a command."""
    if len(twin.largest) < 2:
        return
    console.print(Folded(Text(say("twin.others"), style="bold")))
    for parting in twin.largest[1:]:
        values = "?"
        if parting.radiance is not None:
            values = " -> ".join(f"{luminance(v):.5g}" for v in parting.radiance)
        said = say("twin.other", values=values, what=what_differs(parting.what, say), **_place(parting, say))
        console.print(Folded(Text(said)))
        for command in sides[1].commands(parting.place(parting.steps[1]))[-1:]:
            console.print(Text(f"  {command}", style="cyan"), soft_wrap=True)
