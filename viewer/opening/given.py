"""Paths of another tracer as the viewer shows them: read from a log, or made by a learner's own program."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

import tracer
from lessons.course import about
from tracer.settings import TracerError
from tracer.trace import Trace, pixels
from tracer.trace.lattice import lattice_of
from viewer.cursor import Cursor
from viewer.examining import Chart, charted
from viewer.given import logged_trace
from viewer.replay import of_scene


@dataclass(frozen=True)
class Given:
    """file: as a command names it; of: so the scene; trace: the paths, without gaps; chart: what the doctor
    says of them; judge: the command that judges them in a terminal; options: that it and castray view are
    told; at: (x, y, path, event) to open at, if it was asked for."""

    file: str
    of: str
    trace: Trace
    chart: Chart
    judge: str
    options: str = ""
    at: tuple | None = None

    @property
    def name(self):
        """Of the file, without its folder."""
        return Path(self.file).name

    @property
    def command(self):
        """What judges them in a terminal."""
        return f"castray {self.judge} {of_scene(self.file, self.of)}{self.options}"

    def opening(self, place):
        """`castray view` of them at (x, y, path, event)."""
        return f"castray view {of_scene(self.file, self.of, place)}{self.options}"

    @property
    def scene(self):
        """The scene that they are of."""
        return self.trace.scene

    @property
    def settings(self):
        """Their settings, as far as they are known."""
        return self.trace.settings

    @cached_property
    def picture(self):
        """What they make together."""
        return pixels.picture(self.trace)

    @cached_property
    def lattice(self):
        """The Lattice of its pixels, None where it has all of them or some that lie anyhow."""
        return lattice_of(self.trace)

    def near(self, x, y):
        """The pixel with paths that is meant where (x, y) is clicked."""
        return (x, y) if self.lattice is None else self.lattice.nearest(x, y)

    def spread(self, values):
        """Values (H, W, ...) of pixels as they are shown: a pixel of a lattice fills what is around it."""
        return values if self.lattice is None else self.lattice.spread(values)

    def record(self, x, y):
        """The PixelRecord of a pixel. Raises TracerError where no path was recorded."""
        return pixels.pixel(self.trace, x, y)

    @property
    def start(self):
        """(x, y, path, event) to open at: what was asked for, the event that proves the first finding,
        else where light arrives."""
        if self.at is not None:
            return self.at
        for finding in self.chart.diagnosis.causes:
            first: Any = finding.first
            if first is not None and first.get("step") is not None:
                return self.place(first)
        x, y, sample = (int(self.trace.paths[name][self._giving]) for name in ("x", "y", "sample"))
        return *self.place({"x": x, "y": y, "sample": sample, "step": None})[:3], None

    @property
    def _giving(self):
        """Which path is worth opening with: that of the light sample that gives most, else the brightest,
        else the first."""
        lit = self.trace.tables.get("light")
        added = None if lit is None else lit["contribution"]
        if added is not None and np.any(added > 0):
            return int(lit.path[np.argmax(np.nan_to_num(added).sum(axis=0))])
        radiance = self.trace.paths.get("radiance")  # a log need not have it
        return 0 if radiance is None else int(np.argmax(np.nan_to_num(radiance).sum(axis=0)))

    def place(self, first):
        """(x, y, path, event) of what a finding names."""
        return pixels.place(self.trace, first)

    def opened_at(self, place):
        """The same, to be opened at (x, y, path, event). Raises TracerError where that is not there."""
        if place is not None:
            x, y, path, event = place
            lengths = [len(one.events) for one in self.record(x, y).paths]
            try:
                Cursor(x, y, tuple(lengths), path, event)
            except IndexError as error:
                raise TracerError(f"link: {error}: there is no such place") from None
        return replace(self, at=place)


def of_log(file, scene, name=None, at=None):
    """The Given in a log of a scene (a file, a name or a Scene), shown under a name, to be opened at
    (x, y, path, event). Raises TracerError."""
    trace = pixels.without_gaps(logged_trace(str(file), scene, name))
    diagnosis = tracer.examine(trace).explained_by(about)
    name, of = name or str(file), scene if isinstance(scene, str) else scene.name
    return Given(name, of, trace, charted(trace, diagnosis), "doctor").opened_at(at)
