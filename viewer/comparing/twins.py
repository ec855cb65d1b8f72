"""The picked pixel in two tracers with the same random numbers: which of its paths part, and where."""

from dataclasses import dataclass
from typing import Any

import numpy as np

import tracer
from lessons.zoo import planted
from tracer.trace import gather, join, parts
from tracer.twin import compare
from viewer.comparing.rival import Rival
from viewer.examining import planned

MOST_PATHS = 1 << 15  # compared of a whole picture: a few seconds
LISTED = 12  # paths of the pixel that are named, those that differ most first
NAMES = ("a", "b")


@dataclass(frozen=True)
class Beside:
    """A path of the rival beside the one with the same random numbers; parting: where they part
    (tracer.twin.Parting), None where no event differs by more than rounding."""

    path: Any  # tracer.recorder.RecordedPath
    parting: Any

    @property
    def since(self):
        """The twin's event where it parts, its last where it is over before that."""
        step = self.parting.steps[1]
        return len(self.path.events) - 1 if step is None else step


def whole(scene, settings, rival: Rival, stopped):
    """The Twin of paths from all over the picture. stopped(): raises to give up. Raises TracerError."""
    traces = []
    for its, asked in ((scene, settings), (rival.scene, rival.settings)):
        few, pixels = planned(asked, MOST_PATHS)
        found = []
        for part in parts(its, few, planted(few), pixels):
            stopped()
            found.append(part)
        traces.append(join(found))
    mine, its = traces
    return compare(mine, its, NAMES, most=0)


class PixelTwin:
    """A pixel in both tracers. Raises TracerError where their random numbers cannot be the same."""

    def __init__(self, scene, settings, rival: Rival, x, y):
        self.record = tracer.inspect(rival.scene, rival.settings, x, y, steps=planted(rival.settings))
        sides = (scene, settings), (rival.scene, rival.settings)
        self._traces = tuple(
            gather(its, asked, planted(asked), np.array([y * asked.width + x])) for its, asked in sides
        )
        mine, its = self._traces
        self.found = compare(mine, its, NAMES, most=LISTED)
        self.scenes = tuple(trace.scene for trace in self._traces)

    def beside(self, sample):
        """What is Beside a sample's path; None where the rival has fewer samples."""
        if sample >= min(trace.size for trace in self._traces):
            return None
        mine, its = (trace.take([sample]) for trace in self._traces)
        found = compare(mine, its, NAMES, most=1)
        return Beside(self.record.paths[sample], found.largest[0] if found.largest else None)
