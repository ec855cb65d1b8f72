"""The doctor's report as one HTML file that asks nobody for anything, with the path of the first finding."""

from html import escape
from pathlib import Path

import tracer
from lessons.zoo import planted
from viewer.cursor import Cursor
from viewer.doctor_report import bug_title, bugs, chance, counted, equation, following, lesson, place
from viewer.offline import BEGIN, document, figure, furniture
from viewer.render import preview

STYLES = Path(__file__).parent / "report.css"
STATES = ("fired", "clean", "not_testable")


def report(diagnosis, scene, settings, paths, say, again=True):
    """The report on so many paths of a scene. again: whether its paths can be traced again, to be shown."""
    told = _about(scene, settings, paths, say)
    causes = [f for f in diagnosis.findings if f.follows is None]
    proof = next((f.first for f in causes if f.first and f.first.get("step") is not None), None)
    shown = _proof(scene, settings, proof, say) if again and proof else ""
    title = say("share.report", scene=scene.name)
    body = "".join(
        (
            f'<main class="report"><h1>{escape(title)}</h1><p class="dim">{escape(told)}</p>',
            f'<p class="verdict">{escape(_verdict(diagnosis, causes, say))}</p>',
            "".join(_cause(finding, say) for finding in causes),
            shown,
            _following(diagnosis, say),
            _rules(diagnosis, say),
            "</main>",
        )
    )
    styles, scripts = furniture() if shown else ("", "")
    styles += STYLES.read_text(encoding="utf-8")
    return document(title, body, say.language, styles, f"{scripts}\n{BEGIN}" if shown else "")


def _about(scene, settings, paths, say):
    names = ("width", "height", "spp", "integrator", "seed")
    said = {name: getattr(settings, name) for name in names}
    told = say("share.examined", scene=scene.name, paths=paths, **said)
    return say("share.examined_bug", examined=told, bug=settings.bug) if settings.bug else told


def _verdict(diagnosis, causes, say):
    if all(verdict.state == "not_testable" for verdict in diagnosis.rules):
        return say("doctor.unjudged")
    return say("exam.found", n=len(causes)) if diagnosis.findings else say("doctor.nothing")


def _cause(finding, say):
    """A finding with a cause of its own, in full."""
    said = counted(finding, say)
    name = bug_title(finding.bug, say) if finding.bug else said["title"]
    rows = [
        ("law", say.optional(f"law.{finding.rule}", finding.law)),
        ("formula", say.formula(finding.rule, finding.formula)),
    ]
    rows += [
        (key, equation(say.quantity(finding.what), value, say))
        for key, value in (("recorded", finding.recorded), ("right", finding.right))
        if value is not None
    ]
    rows += [("why", say.clue(finding.explanation))]
    rows += [("chance", chance(finding, say))] if finding.p is not None else []
    rows += [("first", place(finding.first, say))] if finding.first else []
    rows += [("see", finding.command)]
    rows += [("lesson", lesson(finding))] if finding.lesson is not None else []
    cells = "".join(
        f'<tr class="{key}"><th scope="row">{escape(say(f"doctor.{key}"))}</th><td>{escape(text)}</td></tr>'
        for key, text in rows
        if text
    )
    head = f"{escape(bugs(finding, say))} {escape(name)}".strip()
    return (
        f'<section class="finding" data-rule="{escape(finding.rule)}" data-bug="{escape(finding.bug or "")}">'
        f"<h2>{head}</h2><p>{escape(say('doctor.not_so', **said))}</p><table>{cells}</table></section>"
    )


def _many(count):
    return f"{count:,}" if count else ""


def _proof(scene, settings, first, say):
    """The picture, and the path that the first finding names, at its event."""
    x, y = first["x"], first["y"]
    record = tracer.inspect(scene, settings, x, y, steps=planted(settings))
    cursor = Cursor(x, y, tuple(len(p.events) for p in record.paths), first["sample"], first["step"])
    head, view = say("share.proof", x=x, y=y), figure(scene, record, cursor, say, preview(scene, settings))
    return f"<h2>{escape(head)}</h2>{view}<p>{escape(say('offline.help'))}</p>"


def _following(diagnosis, say):
    told = [following(f, diagnosis.findings, say) for f in diagnosis.findings if f.follows]
    items = "".join(f"<li>{escape(text)}</li>" for text in told)
    return f"<h2>{escape(say('exam.following', n=len(told)))}</h2><ul>{items}</ul>" if told else ""


def _rules(diagnosis, say):
    """Every law and what became of it."""
    heads = "".join(
        f'<th scope="col">{escape(say(f"doctor.{k}"))}</th>' for k in ("rule", "says", "checked", "failed")
    )
    rows = []
    for verdict in sorted(diagnosis.rules, key=lambda v: STATES.index(v.state)):
        rule, state = verdict.rule, verdict.state
        law = escape(say.optional(f"law.{rule.id}", rule.law))
        said = say(f"doctor.{state}") if state != "not_testable" else say.lacking(verdict.missing)
        rows.append(
            f'<tr class="{state}" data-rule="{escape(rule.id)}" data-state="{state}" title="{law}">'
            f"<td>{escape(say.optional(f'rule.{rule.id}', rule.title))}</td><td>{escape(said)}</td>"
            f"<td>{_many(verdict.checked)}</td><td>{_many(verdict.failed)}</td></tr>"
        )
    head = escape(say("share.laws", n=len(rows)))
    table = f"<thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody>"
    return f'<h2>{head}</h2><table class="rules">{table}</table>'
