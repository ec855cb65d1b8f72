"""The picture, rendered beside the window: coarse at once, then finer, until all samples are in."""

import threading

import tracer
from lessons.zoo import planted

PREVIEW = 1 << 18  # paths of a picture that is made while one waits
FINER = 4  # each pass has this many times the samples of the one before


class Stopped(Exception):
    """The picture is not wanted any more."""


def passes(spp):
    """How many samples each pass has: 1, 4, 16, ... and at last all."""
    steps = []
    while not steps or steps[-1] < spp:
        steps.append(min(FINER ** len(steps), spp))
    return steps


class Painter:
    """Renders in a thread of its own and tells what it has."""

    def __init__(self, scene, settings):
        self.scene, self.settings, self._stop = scene, settings, threading.Event()

    def start(self, done, progress, failed):
        """done(picture, samples), progress(share, samples) and failed(text) are called in that thread."""
        threading.Thread(target=self._work, args=(done, progress, failed), daemon=True).start()

    def stop(self):
        """Give up at the next report of progress."""
        self._stop.set()

    def _work(self, done, progress, failed):
        try:
            for spp in passes(self.settings.spp):
                picture = tracer.render(
                    self.scene,
                    self.settings.at_spp(spp),
                    progress=self._reporter(progress, spp),
                    steps=planted(self.settings),
                )
                self._check()
                done(picture, spp)
        except Stopped:
            return
        except (tracer.TracerError, MemoryError, OSError) as error:
            failed(str(error))

    def _reporter(self, progress, spp):
        def report(part, total):
            self._check()
            progress(part / max(total, 1), spp)

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
