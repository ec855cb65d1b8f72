"""A learner's own tracer in Python: run, judged, and run again whenever its file is saved."""

import threading
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from lessons.course import about
from tracer.events import LIGHT
from tracer.learner.run import run
from tracer.settings import TracerError
from tracer.trace.jsonl.geometry import ask
from tracer.trace.trace import Trace
from viewer.checking.learner import held, said, together
from viewer.examining import charted
from viewer.opening.given import Given
from viewer.worker import Stopped, outcome

SECONDS = 300.0  # that it may take
LOOKED_EVERY = 0.25  # seconds: how soon a saved file is seen


def given(file, scene, settings, stopped=lambda: None):
    """What a learner's tracer does on a scene (a file or name), as Given. Raises TracerError."""
    whole, used = run(file, scene, settings, SECONDS, stopped=stopped)
    first, later = held(whole, used)
    chart = charted(whole, together(first, later).explained_by(about), {v.rule.id: used for v in later.rules})
    return Given(str(file), scene, _with_f(whole, used), chart, "check", said(settings))


def _with_f(whole: Trace, used: Trace):
    """The trace of all light samples, each with f: that of those that brought something as it was used, of
    the others as it has to be."""
    table = whole.tables[LIGHT.name]
    columns = dict(table.columns)
    hits = whole.tables["hit"].take(whole.hit_of(LIGHT.name)).columns
    f = ask(whole.scene, "eval", hits, columns["wi"])
    there = used.tables[LIGHT.name]["f"]
    if there is not None and there.shape[-1]:
        f[:, np.asarray(columns["visible"], bool)] = there
    return replace(whole, tables=whole.tables | {LIGHT.name: replace(table, columns=columns | {"f": f})})


class Watched:
    """A learner's file, run again whenever it is saved: what became of the last run, and the last good one.
    at: the (x, y, path, event) to open it at, the first finding's where its paths do not go there.

    show(Given) and told() are called in the page's loop, which `back` hands calls over to.
    """

    def __init__(self, file, scene, settings, at=None):
        self.file, self.scene, self.settings, self.at = Path(file), scene, settings, at
        self.busy, self.error, self.good, self.runs = True, None, None, 0
        self._ended = threading.Event()

    @property
    def name(self):
        """Of the file, without its folder."""
        return self.file.name

    def start(self, back, show, told):
        """Run it, and look from now on whether it was saved."""
        self._back, self._show, self._told = back, show, told
        self._thread = threading.Thread(target=self._look, daemon=True)
        self._thread.start()

    def stop(self):
        """Look no more; what runs is given up."""
        self._ended.set()
        self._thread.join(2.0)

    def _look(self):
        ran, before = None, self._stamp()
        with suppress(RuntimeError):  # the page is closed, and its loop with it
            while not self._ended.is_set():
                now = self._stamp()
                if now is not None and now == before and now != ran:  # saved, and not still being written
                    ran = now
                    self._run(ran)
                before = now
                self._ended.wait(LOOKED_EVERY)

    def _stamp(self):
        """What tells one state of the file from another; None while it is not there."""
        try:
            there = self.file.stat()
        except OSError:
            return None
        return there.st_mtime_ns, there.st_size

    def _run(self, stamp):
        def stopped():
            if self._ended.is_set() or self._stamp() not in (stamp, None):
                raise Stopped

        self._back(self._begun)
        self._back(
            *outcome(lambda: given(self.file, self.scene, self.settings, stopped), self._done, self._failed)
        )

    def _begun(self):
        self.busy = True
        self._told()

    def _done(self, found):
        with suppress(TracerError):
            found = found.opened_at(self.at)
        self.busy, self.error, self.good, self.runs = False, None, found, self.runs + 1
        self._show(found)

    def _failed(self, error: TracerError):
        self.busy, self.error = False, error
        self._told()
