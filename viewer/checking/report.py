"""What the rows of a folder say: as a table in the terminal, as CSV, as one HTML file, as JSON."""

import csv
import io
import re
from html import escape
from pathlib import Path, PurePath

from rich.console import Console
from rich.table import Table
from rich.text import Text

from tracer.doctor.picture import Hypothesis
from viewer.checking.submission import FAILED, MAYBE, RIGHT, SKIPPED, WRONG
from viewer.doctor_report import bug_title, bugs, chance, counted, equation, lesson, place
from viewer.folded import Folded
from viewer.offline import document

COLUMNS = ("name", "state", "passed", "failed", "finding", "certainty", "where", "command")
_STYLE = {RIGHT: "green", WRONG: "bold red", MAYBE: "yellow", FAILED: "red", SKIPPED: "dim"}
_FORMULA = tuple("=+-@\t\r\n")  # what a spreadsheet takes for the start of a formula
_STYLES = Path(__file__).parent.parent / "sharing" / "report.css"
_COPY = Path(__file__).parent / "copy.js"


def cells(row, say):
    """The texts of a row by COLUMNS."""
    return {
        "name": row.name,
        "state": say(f"check.{row.state}"),
        "passed": _parts(row.passed, say),
        "failed": _parts(row.failed, say),
        "finding": finding(row, say),
        "certainty": certainty(row, say),
        "where": where(row, say),
        "command": row.command,
    }


def _parts(kinds, say):
    return say.listed(*(say.optional(f"kind.{kind}", kind) for kind in kinds))


def finding(row, say):
    """What is wrong, in short."""
    if row.state == FAILED:
        return _without_name(say.error(row.error), row, say)
    if row.found is None:
        return say("check.unknown") if row.state == MAYBE else ""
    if isinstance(row.found, Hypothesis):
        if row.found.factor is not None:
            return say("pic.factor", factor=row.found.factor)
        if not row.found.bugs:
            return say("check.black")
        return " + ".join(f"{bug} {bug_title(bug, say)}" for bug in row.found.bugs)
    named = bugs(row.found, say)
    if not named:  # the law itself is in the next column
        return say.clue(row.found.explanation) or counted(row.found, say)["title"]
    return f"{named} {bug_title(row.found.bug, say)}"


def _without_name(said, row, say):
    """An error without the file that it is of, which the row has; a line's number is called one."""
    for name in (row.path, PurePath(row.path).name):
        for mark in (":", "\N{FULLWIDTH COLON}"):
            if name and said.startswith(f"{name}{mark}"):
                said = said.removeprefix(f"{name}{mark}").strip()
                break
    line = re.match(r"(\d+)[:\N{FULLWIDTH COLON}]\s*(.*)", said)
    return say("check.line", line=line[1], error=line[2]) if line else said


def certainty(row, say):
    """How sure that is: a law that is broken, a chance, or a hypothesis."""
    found = row.found
    if found is None:
        return ""
    if isinstance(found, Hypothesis):
        if found.explains is None:
            return say("check.hypothesis")
        return say("check.hypothesis_fits", explains=found.explains)
    return chance(found, say) if found.p is not None else say("doctor.not_so", **counted(found, say))


def where(row, say):
    """Where it shows first."""
    first = getattr(row.found, "first", None)
    return place(first, say) if first else ""


def print_rows(rows, say, console=None):
    """A table of all but those that were skipped, and these in a line."""
    console = console or Console(highlight=False)
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    shown = ("name", "state", "failed", "finding")
    for name in shown:
        table.add_column(say(f"check.column_{name}"), overflow="fold")
    for row in rows:
        if row.state == SKIPPED:
            continue
        said = {name: printable(text) for name, text in cells(row, say).items()}
        told = Text(said["finding"])
        if said["certainty"]:
            told.append(f"\n{said['certainty']}", style="dim")
        table.add_row(
            Text(said["name"]),
            Text(said["state"], style=_STYLE[row.state]),
            Folded(Text(said["failed"])),
            Folded(told),
        )
    console.print(table)
    skipped = [printable(row.name) for row in rows if row.state == SKIPPED]
    if skipped:
        console.print(Text(say("check.skipped_files", files=say.listed(*skipped)), style="dim"))
    commands = [row.command for row in rows if row.state in (WRONG, MAYBE) and row.command]
    if commands:
        console.print(Text(f"\n{say('check.proof')}"))
        for command in commands:
            console.print(Text(printable(command)), soft_wrap=True)


def printable(text):
    """A text without what would steer a terminal, or cannot be written."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def as_csv(rows, say):
    """The table for spreadsheets; no cell of it is taken for a formula."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow([say(f"check.column_{name}") for name in COLUMNS])
    for row in rows:
        said = cells(row, say)
        writer.writerow([_harmless(printable(said[name])) for name in COLUMNS])
    return "\N{ZERO WIDTH NO-BREAK SPACE}" + out.getvalue()  # without the mark Excel misreads Chinese


def _harmless(text):
    return f"'{text}" if text.lstrip().startswith(_FORMULA) else text


def as_html(rows, folder, scene, say):
    """The table as a page that needs nothing else; each name leads to what was found there, and each finding
    to the command that opens the viewer at the event that proves it."""
    shown = ("name", "state", "passed", "failed", "finding", "certainty")
    heads = "".join(f'<th scope="col">{escape(say(f"check.column_{name}"))}</th>' for name in shown)
    lines, sections = [], []
    for number, row in enumerate(rows):
        said = {name: escape(printable(text)) for name, text in cells(row, say).items()}
        name = f'<a href="#s{number}">{said["name"]}</a>' if row.more else said["name"]
        rest = "".join(f"<td>{said[column]}</td>" for column in shown[1:])
        lines.append(f'<tr class="{row.state}" data-state="{row.state}"><td>{name}</td>{rest}</tr>')
        if row.more:
            parts = "".join(_detail(found, say) for found in row.more)
            commands = "".join(f"<p>{_command(text, say)}</p>" for text in (row.command, row.opens) if text)
            sections.append(f'<section id="s{number}"><h2>{said["name"]}</h2>{commands}{parts}</section>')
    title = say("check.title", folder=printable(str(folder)), scene=scene)
    body = (
        f'<main class="report submissions"><h1>{escape(title)}</h1><table><thead><tr>{heads}</tr></thead>'
        f"<tbody>{''.join(lines)}</tbody></table>{''.join(sections)}</main>"
    )
    styles, script = (file.read_text(encoding="utf-8") for file in (_STYLES, _COPY))
    return document(title, body, say.language, styles, script)


def _command(text, say):
    """A command, and a button that copies it."""
    label, done = (escape(say(f"ui.share_{name}")) for name in ("copy", "copied"))
    return f'<code>{escape(printable(text))}</code> <button data-copied="{done}">{label}</button>'


def _detail(found, say):
    """A finding or a hypothesis with its evidence."""
    if isinstance(found, Hypothesis):
        told = [f"{bug} {bug_title(bug, say)}" for bug in found.bugs]
        told += [say("pic.factor", factor=found.factor)] if found.factor is not None else []
        told += [say(f"pic.mark_{name}", value=value) for name, value in found.marks]
        head, rows = say("check.hypothesis"), [("", text) for text in told]
    else:
        head = f"{bugs(found, say)} {say('doctor.not_so', **counted(found, say))}".strip()
        rows = [(say("doctor.formula"), say.formula(found.rule, found.formula))]
        for name in ("recorded", "right"):
            value = getattr(found, name)
            if value is not None:
                rows.append((say(f"doctor.{name}"), equation(say.quantity(found.what), value, say)))
        rows += [(say("doctor.why"), say.clue(found.explanation))] if found.explanation else []
        rows += [(say("doctor.first"), place(found.first, say))] if found.first else []
        rows += [(say("doctor.lesson"), lesson(found))] if found.lesson is not None else []
    cells = [(text, escape(printable(value))) for text, value in rows]
    if getattr(found, "command", None):
        cells.append((say("doctor.see"), _command(found.command, say)))
    body = "".join(
        f'<tr><th scope="row">{escape(text)}</th><td>{cell}</td></tr>'
        if text
        else f'<tr><td colspan="2">{cell}</td></tr>'
        for text, cell in cells
    )
    return f'<div class="finding"><h3>{escape(printable(head))}</h3><table>{body}</table></div>'


def as_dict(rows, folder, scene, say):
    """The JSON: rows with all findings, and what was skipped."""
    return {
        "folder": str(folder),
        "scene": scene,
        "rows": [_row(row, say) for row in rows if row.state != SKIPPED],
        "skipped": [row.name for row in rows if row.state == SKIPPED],
    }


def _row(row, say):
    pictured = row.state == MAYBE
    return {
        "name": row.name,
        "state": row.state,
        "passed": list(row.passed),
        "failed": list(row.failed),
        "finding": finding(row, say),
        "certainty": certainty(row, say),
        "findings": [] if pictured else [found.as_dict() for found in row.more],
        "hypotheses": [list(found.bugs) for found in row.more] if pictured else [],
        "error": row.error or None,
        "command": row.command or None,
    }
