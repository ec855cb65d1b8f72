"""A diagnosis as text: the first finding in full, the others in short, and what every rule says."""

import re
from collections import Counter

from rich.console import Console
from rich.table import Table
from rich.text import Text

from viewer.folded import Folded
from viewer.numerals import several
from viewer.words import Speaker

_STYLE = {"fired": "bold red", "clean": "green", "not_testable": "dim"}
_WIDEST = 100
_OF_THE_POINT = ("light.wi", "light.distance", "light.primitive", "light.light")


def print_diagnosis(diagnosis, trace, console=None):
    """Findings and rules of a Trace."""
    console, say = console or Console(highlight=False), Speaker()
    console.width = min(console.width, _WIDEST)
    settings = trace.settings
    about = {name: getattr(settings, name) for name in ("width", "height", "spp", "integrator")}
    head = say("doctor.head", scene=trace.scene.name, paths=trace.size, vertices=trace.vertices, **about)
    console.print(head)
    console.print()
    if all(verdict.state == "not_testable" for verdict in diagnosis.rules):
        console.print(Text(say("doctor.unjudged"), style="bold yellow"))
    elif not diagnosis.findings:
        console.print(Text(say("doctor.nothing"), style="bold green"))
    for number, finding in enumerate(diagnosis.findings):
        if number == 0:
            _print_first(finding, say, console)
        else:
            _print_other(finding, say, console)
    if trace.culled and (more := lacking(diagnosis.rules)):  # of a log
        console.print(Text(say("doctor.more", names=say.listed(*more)), style="yellow"))
    console.print()
    _print_rules(diagnosis.rules, say, console)


def lacking(verdicts, most=4):
    """Names of the few columns of a log whose lack leaves most laws untested, the first the most."""
    names = Counter(
        name
        for verdict in verdicts
        if verdict.state == "not_testable" and "." in verdict.missing
        for name in re.findall(r"^\w+\.\w+(?=[,]|$)|(?<=, )\w+\.\w+", verdict.missing)
    )
    if names["light.q"]:  # which says all of them
        names -= Counter(dict.fromkeys(_OF_THE_POINT, names.total()))
    return [name for name, count in names.most_common(most) if count > 1]


def _print_first(finding, say, console):
    console.print(_head(finding, say))
    for bug in filter(None, (finding.bug, *finding.alike)):
        said = (
            bug_title(bug, say)
            if bug == finding.bug
            else say("doctor.or_title", bug=bug, title=bug_title(bug, say))
        )
        console.print(Text(f"  {said}", style="italic"))
    table = Table(box=None, show_header=False, padding=(0, 0, 0, 2))
    for name, said in _said(finding, say):
        table.add_row(Text(say(f"doctor.{name}"), style="dim"), Folded(said))
    console.print(table)
    console.print()


def _head(finding, say):
    head = Text(bugs(finding, say) or finding.rule, style="bold red")
    head.append(f"  {say('doctor.not_so', **counted(finding, say))}", style="bold")
    return head


def bugs(finding, say):
    """The mistake that is named, with those that no trace tells from it; "" where none is."""
    if finding.bug and finding.alike:
        return say("doctor.or", bug=finding.bug, others=say.listed(*finding.alike))
    return finding.bug or ""


def counted(finding, say):
    """A finding's law, and how often it is broken, as words take them."""
    title = say.optional(f"rule.{finding.rule}", finding.title)
    return {"title": title, "count": finding.count, "checked": finding.checked}


def following(finding, findings, say):
    """What a finding that is no cause says on a page: it follows from another, which is told by its title."""
    cause = next((counted(f, say)["title"] for f in findings if f.rule == finding.follows), finding.follows)
    return say("doctor.follows", cause=say("doctor.quoted", title=cause), **counted(finding, say))


def _said(finding, say):
    """Names and texts, line by line."""
    yield "law", Text(say.optional(f"law.{finding.rule}", finding.law))
    yield "formula", Text(say.formula(finding.rule, finding.formula), style="cyan")
    for name in ("recorded", "right"):
        value = getattr(finding, name)
        if value is not None:
            yield name, Text(equation(say.quantity(finding.what), value, say))
    if finding.explanation:
        yield "why", Text(say.clue(finding.explanation))
    if finding.p is not None:
        yield "chance", Text(chance(finding, say))
    if finding.first is not None:
        yield "first", Text(place(finding.first, say))
        if finding.command:
            yield "see", Text(finding.command)
    for bug, wrong in wrong_code(finding, say):
        yield "code", Text(f"{bug}: {wrong}" if finding.alike else wrong)
    if finding.lesson is not None:
        yield "lesson", Text(lesson(finding))


def wrong_code(finding, say):
    """What to look for in one's own program: (id, code) of the mistake that is named and of those like it."""
    from lessons.zoo import ZOO
    from viewer.zoo import wrong_of

    named = filter(None, (finding.bug, *finding.alike))
    return [(bug, wrong_of(ZOO[bug], say)) for bug in named if bug in ZOO and ZOO[bug].wrong]


def place(first, say):
    """Where a finding shows first."""
    if first["depth"] is None:
        return say("doctor.place", **{name: first[name] for name in ("x", "y", "sample")})
    return say("doctor.place_event", **{**first, "kind": say(f"kind.{first['kind']}")})


def bug_title(bug, say):
    from lessons.zoo import ZOO

    return say.optional(f"bug.{bug}", ZOO[bug].title) if bug in ZOO else bug


def equation(what, values, say):
    """What a finding is about, with its numbers."""
    if all(v is None for v in values):
        return f"{what} = {say('doctor.no_number')}"
    return f"{what} = {several([float('nan') if v is None else v for v in values])}"


def chance(finding, say):
    """How rarely a right tracer does that, in words."""
    said = say("doctor.chance_is", times=f"{1 / max(finding.p, 1e-300):.3g}")
    return f"{said}; {say('doctor.chance_again' if finding.confirmed else 'doctor.chance_once')}"


def lesson(finding):
    """The command that explains a finding's mistake."""
    return f"castray lesson {finding.lesson}"


def _print_other(finding, say, console):
    if finding.follows is None:
        console.print(_head(finding, say))
        if finding.explanation:
            console.print(Text(f"  {say.clue(finding.explanation)}"))
        return
    said = say("doctor.follows", cause=finding.follows, **counted(finding, say))
    console.print(Text(f"{finding.rule}  {said}", style="dim"))


def _print_rules(verdicts, say, console):
    """What fired or abstained with its counts, what holds by name: the finding stays in sight."""
    holding = [v for v in verdicts if v.state == "clean" and not v.abstained]
    rest = [v for v in verdicts if v.state != "not_testable" and v not in holding]
    if rest:
        _print_counts(rest, say, console)
    if holding:
        said = say("doctor.holding", n=len(holding), rules=say.listed(*(v.rule.id for v in holding)))
        console.print(Folded(Text(said, style="dim")))
    _print_untestable([v for v in verdicts if v.state == "not_testable"], say, console)


def _print_counts(verdicts, say, console):
    table = Table(box=None, pad_edge=False)
    for name in ("rule", "says"):
        table.add_column(say(f"doctor.{name}"), no_wrap=True)
    for name in ("checked", "failed", "abstained"):
        table.add_column(say(f"doctor.{name}"), justify="right", no_wrap=True)
    for verdict in sorted(verdicts, key=lambda v: v.state != "fired"):
        state = Text(say(f"doctor.{verdict.state}"), style=_STYLE[verdict.state])
        counts = (str(count or "") for count in (verdict.failed, verdict.abstained))
        table.add_row(verdict.rule.id, state, str(verdict.checked), *counts)
    console.print(table)


def _print_untestable(verdicts, say, console):
    """What could not be judged, and what is missing for it; what each law would have worked out itself is
    one row."""
    lacking, own = {}, []
    for verdict in verdicts:
        if verdict.missing == f"{verdict.rule.needs[0]} is worked out by this law":
            own.append(verdict.rule.id)
        else:
            lacking.setdefault(verdict.missing, []).append(verdict.rule.id)
    if own:
        said = say("doctor.untestable_own", rules=say.listed(*own))
        console.print(Folded(Text(said, style="dim")))
    for missing, rules in lacking.items():
        said = say("doctor.untestable", missing=say.lacking(missing), rules=say.listed(*rules))
        console.print(Folded(Text(said, style="dim")))
