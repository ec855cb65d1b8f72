"""The events of a whole picture, to be asked: a recording, or a few samples of each pixel traced for it."""

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import tracer
from lessons.zoo import planted
from tracer.settings import TracerError
from tracer.trace.asker import Asker

MOST_PATHS = 1 << 18  # traced to be asked: a few seconds, about 150 MB on disk
PACE, RECORDING = 2e-6, 10.0  # seconds a path takes where none is known; so many times that to record it
LONGEST = 20.0  # seconds a question from the page may take


@dataclass
class Survey:
    """What can be asked. settings: those of its paths, the first samples of each of the picture's pixels."""

    asker: Asker
    settings: tracer.Settings
    kept: tempfile.TemporaryDirectory | None = None  # where it lies, if it was traced for this
    seconds: float = 0.0

    @property
    def level(self):
        """Whether events are in it, or paths only."""
        return self.asker.place.level

    @property
    def paths(self):
        """How many paths."""
        return paths_of(self.settings)

    def close(self):
        """Forget it."""
        self.asker.close()
        if self.kept:
            self.kept.cleanup()


def paths_of(settings):
    """How many paths a picture with these settings has."""
    return settings.width * settings.height * settings.spp


def planned(settings):
    """The Settings of the few samples that are traced. Raises TracerError for a picture that is too large."""
    pixels = settings.width * settings.height
    spp = min(settings.spp, MOST_PATHS // pixels)
    spp -= spp % settings.replicates
    if spp < 1:
        raise TracerError(
            f"find: {settings.width} x {settings.height} pixels are too many to be traced with every event "
            "in a few seconds; give a smaller --size, or castray render --record-level events and view that"
        )
    return settings.at_spp(spp)


def traced(scene, settings, progress):
    """Trace the Survey that is planned. progress(done, paths) may raise to give up."""
    few, kept = planned(settings), tempfile.TemporaryDirectory(prefix="castray-", ignore_cleanup_errors=True)
    began = time.perf_counter()
    try:
        path = Path(kept.name) / "picture"
        tracer.record(scene, few, path, "events", progress, steps=planted(few))
        return Survey(Asker(path), few, kept, time.perf_counter() - began)
    except BaseException:
        kept.cleanup()
        raise


def of_recording(place):
    """The Survey of a recording's Folder."""
    return Survey(Asker(place.path), place.settings)
