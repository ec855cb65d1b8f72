"""The doctor in the viewer: examines some paths of the picture, and leads to what proves a finding."""

from dataclasses import dataclass, field, replace
from math import gcd
from typing import Any

import numpy as np

import tracer
from lessons.course import about
from lessons.zoo import planted
from tracer.settings import TracerError
from viewer import overlay
from viewer.doctor_report import counted
from viewer.given import recorded_trace
from viewer.worker import Stopped

MOST_PATHS = 1 << 16  # examined: some seconds
MOST_SAMPLES = 16  # of a pixel: many pixels say more than many samples of few
GOLDEN = 0.618034
SECONDS = 5e-5  # that a path takes, about, to be traced and examined


@dataclass
class Chart:
    """What the doctor said of a scene. broken: {rule: (H, W) events that break it}, of causes only."""

    busy: bool = False
    diagnosis: Any = None
    paths: int = 0
    broken: dict = field(default_factory=dict)
    now: int = -1  # which finding was gone to
    error: TracerError | None = None

    def close(self):
        """There is nothing to let go of."""


def planned(settings, most=MOST_PATHS):
    """The Settings of about so many paths that are examined, and the numbers (P,) of their pixels."""
    spp = min(settings.spp, MOST_SAMPLES)
    spp = max(spp - spp % settings.replicates, min(settings.spp, settings.replicates))
    few, pixels = settings.at_spp(spp), settings.width * settings.height
    number = min(pixels, max(1, most // spp))
    step = round(GOLDEN * pixels)
    while gcd(step, pixels) > 1:
        step += 1
    return few, np.sort(np.arange(number) * step % pixels)  # all over the picture, in no rows or columns


def examined(scene, settings, recording, stopped):
    """The Chart of a scene with these settings, or of its recording. stopped(): raises to give up."""
    from tracer.doctor.fresh import by_chance, confirmed, fresh
    from tracer.trace import join, parts

    if recording is not None:
        trace = recorded_trace(recording.path, MOST_PATHS)
    else:
        few, pixels = planned(settings)
        traces = []
        for part in parts(scene, few, planted(few), pixels):
            stopped()
            traces.append(part)
        trace = join(traces)
    stopped()
    diagnosis = tracer.examine(trace)
    if recording is None and by_chance(diagnosis):
        stopped()
        few = fresh(few)
        diagnosis = confirmed(diagnosis, join(parts(scene, few, planted(few), pixels)))
    return charted(trace, diagnosis.explained_by(about))


def charted(trace, diagnosis, elsewhere=None):
    """The Chart of a diagnosis. elsewhere: {rule: the other Trace that it was tested on}."""
    causes, others = {finding.rule for finding in diagnosis.causes}, elsewhere or {}
    broken = {
        v.rule.id: _where(others.get(v.rule.id, trace), v.outcome)
        for v in diagnosis.rules
        if v.rule.id in causes
    }
    return Chart(diagnosis=_light(diagnosis), paths=trace.size, broken=broken)


def _light(diagnosis):
    """The diagnosis without the columns it was made from."""
    return replace(diagnosis, rules=tuple(replace(v, outcome=None) for v in diagnosis.rules))


def _where(trace, outcome):
    """How many events of each pixel (H, W) are wrong, NaN where none is."""
    rows = outcome.rows[outcome.wrong]
    table = trace.tables.get(outcome.kind)
    path = rows if table is None else table.path[rows]
    settings = trace.settings
    place = trace.paths["y"][path].astype(np.int64) * settings.width + trace.paths["x"][path]
    count = np.bincount(place, minlength=settings.width * settings.height).astype(np.float32)
    count[count == 0.0] = np.nan
    return count.reshape(settings.height, settings.width)


class Examiner:
    """What the page may ask of the doctor. worker: does what takes long."""

    def __init__(self, window, worker):
        self.window, self.session, self.worker = window, window.session, worker

    @property
    def chart(self):
        """The Chart of the session's scene."""
        return self.session.desk.setdefault("doctor", Chart())

    def examine(self):
        """Hold the laws against paths of the picture."""
        session, chart = self.session, self.chart
        if chart.busy or session.given:  # what is given was judged when it was read
            return
        chart.busy, chart.error = True, None
        scene, settings, recording = session.scene, session.settings, session.recording

        def stopped():
            if session.desk.get("doctor") is not chart:
                raise Stopped

        def done(made):
            if session.desk.get("doctor") is chart:
                session.desk["doctor"] = made
                self.window.show("doctor")

        def failed(error):
            chart.busy, chart.error = False, error
            self.window.show("doctor")

        self.worker.do(lambda: examined(scene, settings, recording, stopped), done, failed)
        self.window.show("doctor")

    def go(self, index):
        """Go to the event that proves a finding."""
        finding = self._finding(index)
        first = finding.first
        if first is None:
            raise TracerError(f"doctor: {finding.rule} is seen in many events together, not in one")
        self.chart.now = index
        given = self.session.given
        place = given.place(first) if given else (first["x"], first["y"], first["sample"], first["step"])
        self.window.go_to(place)
        self.window.show("doctor")

    def where(self, index):
        """Show over the picture where a finding's events are."""
        finding = self._finding(index)
        if finding.rule not in self.chart.broken:
            raise TracerError(f"doctor: {finding.rule} follows from {finding.follows}; look where that is")
        values = self.chart.broken[finding.rule]

        def rule(say):
            return counted(finding, say)["title"]

        self.window.cover(overlay.scaled("doctor", "exam.map", values, low=0.0, rule=rule))

    def _finding(self, index):
        diagnosis = self.chart.diagnosis
        findings = diagnosis.findings if diagnosis else ()
        if type(index) is not int or not 0 <= index < len(findings):
            raise TracerError(
                f"doctor: finding {str(index)[:20]!r} is not one of the {len(findings)} there are"
            )
        return findings[index]


def seconds(settings):
    """How long it takes, about."""
    return max(1, round(SECONDS * number_of_paths(settings)))


def number_of_paths(settings):
    """How many paths are examined."""
    few, pixels = planned(settings)
    return pixels.size * few.spp
