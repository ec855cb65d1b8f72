"""A diagnosis as text: the first finding in full, the others in short, and what every rule says."""

from rich.console import Console
from rich.table import Table
from rich.text import Text

from viewer.numerals import several

_STYLE = {"fired": "bold red", "clean": "green", "not_testable": "dim"}
_WIDEST = 100


def print_diagnosis(diagnosis, trace, console=None):
    """Findings and rules of a Trace."""
    console = console or Console(highlight=False)
    console.width = min(console.width, _WIDEST)
    settings = trace.settings
    console.print(
        f"{trace.scene.name}, {settings.width} x {settings.height}, {settings.spp} spp, "
        f"{settings.integrator}: "
        f"{trace.size} paths, {trace.vertices} vertices"
    )
    console.print()
    if not diagnosis.findings:
        console.print(Text("No law is broken.", style="bold green"))
    for number, finding in enumerate(diagnosis.findings):
        if number == 0:
            _print_first(finding, console)
        else:
            _print_other(finding, console)
    console.print()
    _print_rules(diagnosis.rules, console)


def _print_first(finding, console):
    console.print(_head(finding))
    if _title(finding.bug):
        console.print(Text(f"  {_title(finding.bug)}", style="italic"))
    table = Table(box=None, show_header=False, padding=(0, 0, 0, 2))
    for name, said in _said(finding):
        table.add_row(Text(name, style="dim"), said)
    console.print(table)
    console.print()


def _head(finding):
    head = Text(_bug(finding), style="bold red")
    head.append(f"  {finding.title}: not so at {_share(finding)}", style="bold")
    return head


def _bug(finding):
    if finding.bug is None:
        return finding.rule
    return finding.bug + (f" (or {', '.join(finding.alike)})" if finding.alike else "")


def _share(finding):
    return f"{finding.count} of {finding.checked}"


def _said(finding):
    """Names and texts, line by line."""
    yield "law", Text(finding.law)
    yield "formula", Text(finding.formula, style="cyan")
    for name in ("recorded", "right"):
        value = getattr(finding, name)
        if value is not None:
            yield name, Text(f"{finding.what} = {_numbers(value)}")
    if finding.explanation:
        yield "why", Text(finding.explanation)
    if finding.p is not None:
        yield "chance", Text(f"a right tracer does as badly once in {1 / max(finding.p, 1e-300):.3g} traces")
    if finding.first is not None:
        place = finding.first
        event = (
            ""
            if place["depth"] is None
            else f", depth {place['depth']}, event {place['step']} ({place['kind']})"
        )
        yield "first at", Text(f"pixel ({place['x']}, {place['y']}), sample {place['sample']}{event}")
        if finding.command:
            yield "see it", Text(finding.command)


def _title(bug):
    from lessons.zoo import ZOO

    return ZOO[bug].title if bug in ZOO else None


def _numbers(values):
    return several([float("nan") if v is None else v for v in values])


def _print_other(finding, console):
    line = (
        _head(finding)
        if finding.follows is None
        else Text(
            f"{finding.rule}  {finding.title}: not so at {_share(finding)}; follows from {finding.follows}",
            style="dim",
        )
    )
    console.print(line)
    if finding.explanation and finding.follows is None:
        console.print(Text(f"  {finding.explanation}"))


def _print_rules(verdicts, console):
    table = Table(box=None, pad_edge=False)
    table.add_column("rule", no_wrap=True)
    table.add_column("says", no_wrap=True)
    for name in ("checked", "failed", "abstained"):
        table.add_column(name, justify="right", no_wrap=True)
    for verdict in sorted(verdicts, key=lambda v: v.state != "fired"):
        if verdict.state == "not_testable":
            continue
        state = Text(verdict.state, style=_STYLE[verdict.state])
        counts = (str(count or "") for count in (verdict.failed, verdict.abstained))
        table.add_row(verdict.rule.id, state, str(verdict.checked), *counts)
    console.print(table)
    _print_untestable([v for v in verdicts if v.state == "not_testable"], console)


def _print_untestable(verdicts, console):
    """What could not be judged, and what is missing for it."""
    lacking = {}
    for verdict in verdicts:
        lacking.setdefault(verdict.missing, []).append(verdict.rule.id)
    for missing, rules in lacking.items():
        console.print(Text(f"not testable here ({missing}): {', '.join(rules)}", style="dim"))
