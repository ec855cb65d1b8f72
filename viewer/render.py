"""The picture, rendered beside the window: coarse at once, then finer, until all samples are in."""

import threading
from dataclasses import replace

import tracer

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
    """Renders in a thread of its own and tells what it has.

    done(rgb, samples) and progress(share, samples) are called in that thread; failed(text) where it cannot go on.
    """

    def __init__(self, scene, settings, done, progress, failed):
        self._asked = scene, settings, done, progress, failed
        self._stop = threading.Event()
        threading.Thread(target=self._work, daemon=True).start()

    def stop(self):
        """Give up at the next report of progress."""
        self._stop.set()

    def _work(self):
        scene, settings, done, progress, failed = self._asked

        def report(part, total):
            if self._stop.is_set():
                raise Stopped
            progress(part / max(total, 1), spp)

        try:
            for spp in passes(settings.spp):
                picture = tracer.render(scene, replace(settings, spp=spp), progress=report)
                if self._stop.is_set():
                    return
                done(picture.rgb, spp)
        except Stopped:
            return
        except (tracer.TracerError, MemoryError, OSError) as error:
            failed(str(error))
