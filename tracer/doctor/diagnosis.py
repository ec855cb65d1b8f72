"""Findings of a trace, the first cause first."""

from dataclasses import dataclass, fields, replace

import numpy as np

from tracer.doctor import statistics
from tracer.doctor.causes import led_astray, ranked
from tracer.doctor.evidence import Evidence
from tracer.doctor.laws import LAWS
from tracer.doctor.naming import named
from tracer.doctor.rule import CLEAN, FIRED, NOT_TESTABLE, Outcome, Verdict, applied
from tracer.trace.folder import view_command

_VERTICES = 1 << 18  # that are judged at once, about 300 MB


@dataclass(frozen=True)
class Finding:
    """A law that a trace breaks.

    bug: id of the most likely mistake of the catalogue, None where none fits; alike: ids that no trace tells
    from it; count of checked events; first: where it shows, {x, y, sample, depth}, with the kind of event and
    its step in the path; recorded and right: the number there, side by side; p: of a statistical law;
    follows: id of the finding that this one comes from, None for a cause of its own; confirmed: of a
    statistical law whether fresh data break it as well, None where none could be had.
    """

    rule: str
    title: str
    law: str
    formula: str
    bug: str | None
    alike: tuple
    count: int
    checked: int
    first: dict | None
    what: str
    recorded: list | None
    right: list | None
    explanation: str
    command: str | None
    follows: str | None = None
    p: float | None = None
    lesson: int | None = None
    confirmed: bool | None = None

    def as_dict(self):
        """Plain values."""
        return {
            name: list(value) if isinstance(value, tuple) else value for name, value in vars(self).items()
        }


@dataclass(frozen=True)
class Diagnosis:
    """What the doctor says of a trace: findings, the first cause first, and every rule's verdict."""

    findings: tuple
    rules: tuple

    @property
    def causes(self):
        """The findings that do not follow from others."""
        return tuple(f for f in self.findings if f.follows is None)

    def replayed_with(self, words):
        """The same, with words at the end of each command that replays a path."""
        more = (replace(f, command=f.command and f"{f.command} {words}") for f in self.findings)
        return replace(self, findings=tuple(more))

    def shown_in(self, folder):
        """The same of a recording, each finding with the command that opens the viewer at its event."""
        names = ("x", "y", "sample", "step")
        return self.shown_by(lambda first: view_command(folder, [first[name] for name in names]))

    def shown_by(self, command):
        """The same, each finding with command(first), which opens a viewer at its event."""
        more = (replace(f, command=command(f.first) if f.first else None) for f in self.findings)
        return replace(self, findings=tuple(more))

    def explained_by(self, about):
        """The same, each finding with the lesson that explains its bug: about(bug id), a number or None."""
        told = (replace(f, lesson=about(f.bug) if f.bug else None) for f in self.findings)
        return replace(self, findings=tuple(told))

    @property
    def bugs(self):
        """Ids of the mistakes that are named, the first cause first, each once."""
        return tuple(dict.fromkeys(f.bug for f in self.causes if f.bug))

    def as_dict(self):
        """Plain values, as `castray doctor --json` prints them."""
        rules = [
            {
                "rule": v.rule.id, "title": v.rule.title, "law": v.rule.law, "formula": v.rule.formula,
                "state": v.state, "checked": v.checked, "failed": v.failed, "abstained": v.abstained,
                "missing": v.missing or None, "p": v.outcome.p if v.outcome else None,
            }
            for v in self.rules
        ]  # fmt: skip
        return {"findings": [f.as_dict() for f in self.findings], "rules": rules}


def examine(trace, only=None):
    """Hold the laws of light transport against a Trace; the Diagnosis. What made the trace is not asked.

    only: ids of laws, to hold these alone. Memory beside the trace is bounded but for what distributions
    need: events are judged a range of paths at a time.
    """
    single = [_Judged(rule) for rule in LAWS if only is None or rule.id in only]
    whole = Evidence(trace)
    for begin, end in _ranges(trace):
        evidence = whole if end - begin == trace.size else Evidence(trace.span(begin, end))
        first = {kind: np.searchsorted(table.path, begin) for kind, table in trace.tables.items()}
        for judged in single:
            judged.add(applied(judged.rule, evidence), evidence, first.get(judged.rule.kind, begin))
    many = statistics.judged(whole, only)
    findings = [judged.finding for judged in single if judged.finding is not None]
    findings += [_finding(whole, verdict) for verdict in many if verdict.state == FIRED]
    return Diagnosis(
        ranked(findings, led_astray(trace, single)), (*(judged.verdict for judged in single), *many)
    )


def _ranges(trace):
    """Yield (first path, end) of parts of about _VERTICES vertices, none smaller than half of it."""
    ends = np.cumsum(np.bincount(trace.tables["hit"].path, minlength=trace.size))
    parts = max(1, round(float(ends[-1]) / _VERTICES))
    cuts = np.searchsorted(ends, np.arange(1, parts) * ends[-1] / parts)
    bounds = np.unique((0, *cuts, trace.size))
    yield from zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)


class _Judged:
    """What a rule says of all parts of a trace together.

    The name is that of the part in which it fires most often.
    """

    def __init__(self, rule):
        self.rule, self.finding, self._most = rule, None, 0
        self.verdict = Verdict(rule, NOT_TESTABLE)

    def where(self, trace):
        """Path and step of each event that breaks the rule, both (K,)."""
        table = trace.tables[self.verdict.outcome.kind]
        rows = self.verdict.outcome.rows[self.verdict.outcome.wrong]
        return table.path[rows], table.step[rows]

    def add(self, verdict, evidence, first):
        """One part's verdict; first: number of the part's first event in the trace."""
        if verdict.failed > self._most:
            self._most = verdict.failed
            self.finding = _finding(evidence, verdict)
        self.verdict = _both(self.verdict, verdict, first)
        if self.finding is not None:
            self.finding = replace(self.finding, count=self.verdict.failed, checked=self.verdict.checked)


def _both(so_far, verdict, first):
    """The Verdict on two parts; its events are those that are wrong, by their numbers in the trace."""
    if verdict.state == NOT_TESTABLE:
        return so_far if so_far.state != NOT_TESTABLE or so_far.missing else verdict
    return Verdict(
        verdict.rule,
        FIRED if FIRED in (so_far.state, verdict.state) else CLEAN,
        so_far.checked + verdict.checked,
        so_far.failed + verdict.failed,
        so_far.abstained + verdict.abstained,
        outcome=_wrong_of_both(so_far.outcome, verdict.outcome, first),
    )


def _wrong_of_both(so_far, outcome, first):
    rows = outcome.rows[outcome.wrong] + first
    if so_far is not None:
        rows = np.concatenate((so_far.rows, rows))
    return Outcome(outcome.kind, rows, np.ones(rows.size, bool), np.zeros(rows.size, bool), what=outcome.what)


def _finding(evidence, verdict):
    rule, outcome = verdict.rule, verdict.outcome
    clue = named(evidence, rule, outcome)
    k = int(np.flatnonzero(outcome.wrong)[0])
    first = _place(evidence, outcome.kind, int(outcome.rows[k]))
    recorded, right = (_plain(column, k) for column in (outcome.recorded, outcome.right))
    words = clue.words
    if not words and outcome.note:
        words = outcome.note
    return Finding(
        rule.id, rule.title, rule.law, rule.formula, clue.bug, clue.alike, verdict.failed, verdict.checked,
        first, outcome.what, recorded, right, words, _command(evidence, first), p=outcome.p,
    )  # fmt: skip


def _place(evidence, kind, row):
    trace = evidence.trace
    table = trace.tables.get(kind)
    path = row if table is None else int(table.path[row])
    place = {name: int(trace.paths[name][path]) for name in ("x", "y", "sample")}
    if table is None:
        return place | {"depth": None, "kind": None, "step": None}
    return place | {"depth": int(table.depth[row]), "kind": kind, "step": int(table.step[row])}


def _plain(column, k):
    if column is None:
        return None
    values = np.atleast_1d(np.asarray(column[..., k], float)).ravel()
    return [float(v) if np.isfinite(v) else None for v in values]


def _command(evidence, first):
    """The words that show the path again; None of a log, whose paths castray would not trace."""
    if first is None or evidence.trace.culled:
        return None
    words = [
        f"castray inspect {evidence.scene.name} --pixel {first['x']} {first['y']} --sample {first['sample']}"
    ]
    settings = evidence.settings
    if settings.width and settings.height:
        words.append(f"--size {settings.width} {settings.height}")
    for f in fields(settings):
        value = getattr(settings, f.name)
        if f.name in ("width", "height", "bug") or value == f.default:
            continue
        option = f.name.replace("_", "-")
        words.append(f"--no-{option}" if value is False else f"--{option} {value}")
    return " ".join(words)
