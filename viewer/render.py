"""The picture, rendered beside the window: coarse at once, then finer, until all samples are in."""

import threading
from functools import partial

import tracer
from lessons.zoo import planted

PREVIEW = 1 << 18  # paths of a picture that is made while one waits
FINER = 4  # each pass has this many times the samples of the one before
COMPARED = "two pictures are compared by the same paths"  # why both are NumPy's
READY_SOON = "gl is not ready yet"  # why a first, coarse picture is NumPy's


class Stopped(Exception):
    """The picture is not wanted any more."""


def passes(spp):
    """How many samples each pass has: 1, 4, 16, ... and at last all."""
    steps = []
    while not steps or steps[-1] < spp:
        steps.append(min(FINER ** len(steps), spp))
    return steps


class Painter:
    """Renders in a thread of its own and tells what it has.

    gl: the tracer.engine.gl.server.Server that is asked first; what it cannot do, NumPy does, and `why` says
    so. Without one NumPy does all.
    """

    def __init__(self, scene, settings, gl=None):
        self.scene, self.settings, self._gl, self._stop = scene, settings, gl, threading.Event()
        self.why = ""

    def start(self, done, progress, failed):
        """done(picture, samples), progress(share, samples) and failed(text) are called in that thread."""
        threading.Thread(target=self._work, args=(done, progress, failed), daemon=True).start()

    def stop(self):
        """Give up at the next report of progress."""
        self._stop.set()

    def _work(self, done, progress, failed):
        todo = passes(self.settings.spp)
        try:
            if self._gl is not None:
                self._by_gl(todo, done, progress)
            for spp in todo:
                self._by_numpy(spp, done, progress)
        except Stopped:
            return
        except (tracer.TracerError, MemoryError, OSError) as error:
            failed(str(error))

    def _by_gl(self, todo, done, progress):
        """Do the passes and take them from the list; those that gl cannot do are left, and `why` says so."""
        coarse = partial(self._by_numpy, todo[0], done, progress) if len(todo) > 1 else None
        try:
            self.why = READY_SOON
            while todo:
                settings = self.settings.at_spp(todo[0])
                report = self._reporter(progress, todo[0])
                picture = self._gl.render(self.scene, settings, planted(settings), report, coarse)
                self._check()
                done(picture, todo.pop(0))
                coarse = None
        except tracer.TracerError as error:
            self.why = str(error).removeprefix("engine: ").removesuffix("; choose engine numpy")

    def _by_numpy(self, spp, done, progress):
        settings, report = self.settings.at_spp(spp), self._reporter(progress, spp)
        picture = tracer.render(self.scene, settings, progress=report, steps=planted(settings))
        self._check()
        done(picture, spp)

    def _reporter(self, progress, spp):
        def report(part, total):
            self._check()
            if part < total:  # else the picture itself tells, and the page is drawn once, not twice
                progress(part / total, spp)

        return report

    def _check(self):
        if self._stop.is_set():
            raise Stopped


def preview(scene, settings):
    """The picture (H, W, 3), of as many samples as take no time to speak of; None where that is none."""
    spp = min(settings.spp, PREVIEW // (settings.width * settings.height)) // settings.replicates
    if spp < 1:
        return None
    few = settings.at_spp(spp * settings.replicates)
    return tracer.render(scene, few, steps=planted(few)).rgb
