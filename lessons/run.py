"""A lesson that runs: the numbers of its claim, the paths it speaks of, its texts with both filled in."""

from collections import deque
from dataclasses import replace
from functools import cached_property

import numpy as np

import tracer
from lessons.answer import right
from lessons.words import PLACEHOLDER
from lessons.zoo import planted
from tracer.engine import waves
from tracer.integrator.wave import Wave
from tracer.scene_file.change import changed, written
from tracer.settings import Settings, TracerError

PLACE = ("x", "y", "path", "event")


class Run:
    """Everything that a lesson computes, each thing once and when it is first asked for."""

    def __init__(self, lesson):
        self.lesson = lesson
        self._scenes, self._changed, self._records = {}, {}, {}

    @cached_property
    def values(self):
        """Name -> number, of the claim's experiment. TracerError where the claim does not hold."""
        try:
            return self.lesson.claim.experiment(self)
        except AssertionError as error:
            why = f": {error}" if str(error) else ""
            raise TracerError(
                f"lesson {self.lesson.number}: its claim does not hold on this machine{why}"
            ) from error

    def scene(self, name=None):
        """A scene that comes with castray; the lesson's own without a name."""
        name = name or self.lesson.front["scene"]
        if name not in self._scenes:
            self._scenes[name] = tracer.load(name)
        return self._scenes[name]

    def scene_of(self, moment="start"):
        """The scene of a moment, with what the moment says differently."""
        at = self.lesson.moments[moment]
        key = at.scene, written(at.changes)
        if key not in self._changed:
            scene = self.scene(at.scene)
            self._changed[key] = changed(scene, at.changes) if at.changes else scene
        return self._changed[key]

    def settings(self, moment="start"):
        """The Settings of a moment, the picture's size included."""
        return Settings(**self.lesson.moments[moment].settings).at_size_of(self.scene_of(moment))

    def pixel(self, x, y, moment="start"):
        """The record of a pixel in the picture of a moment."""
        scene, settings = self.scene_of(moment), self.settings(moment)
        key = (x, y, scene, settings)
        if key not in self._records:
            self._records[key] = tracer.inspect(scene, settings, x, y, steps=planted(settings))
        return self._records[key]

    def wave(self, moment="start", **differently):
        """The pixel of a moment, traced without a record and with some settings said differently, as a Wave
        that is done: radiance (3, spp), rays, dropped."""
        at, settings = self.lesson.moments[moment], replace(self.settings(moment), **differently)
        x, y = np.full(settings.spp, at.x), np.full(settings.spp, at.y)
        wave = Wave(x, y, np.arange(settings.spp), settings, planted(settings))
        deque(waves.events(self.scene_of(moment), settings, wave), maxlen=0)
        return wave

    def path(self, moment="start"):
        """The recorded path of a moment."""
        at = self.lesson.moments[moment]
        return self.pixel(at.x, at.y, moment).paths[at.path]

    def event(self, moment="start"):
        """The event of a moment as plain values, with its kind, step and depth; IndexError if the path is
        shorter."""
        at = self.lesson.moments[moment]
        prepared = self.scene_of(moment).at(self.settings(moment))
        return self.path(moment).events[at.event].as_dict(prepared)

    def fill(self, text):
        """A text with its numbers in the places of `{{name}}`. Raises TracerError for a name without one."""
        return PLACEHOLDER.sub(lambda found: _written(self.value(found[1]), found[2]), text)

    def value(self, name):
        """What is behind a name: a value of the claim, MOMENT.FIELD of a recorded event (or x, y, path,
        event), or task.ID, the right answer; .0, .1, ... behind it take one of several."""
        first, _, rest = name.partition(".")
        if not rest:
            if name in self.values:
                return self.values[name]
            raise TracerError(f"lesson {self.lesson.number}: {name!r} is no value of its claim")
        field, *indices = rest.split(".")
        value = right(self, self.lesson.task(field)) if first == "task" else self._of_moment(first, field)
        for index in indices:
            value = value[int(index)]
        return value

    def _of_moment(self, name, field):
        if name not in self.lesson.moments:
            raise TracerError(f"lesson {self.lesson.number}: {name!r} is none of its moments")
        if field in PLACE:
            return getattr(self.lesson.moments[name], field)
        event = self.event(name)
        if field not in event:
            raise TracerError(f"lesson {self.lesson.number}: the event of {name!r} has no {field!r}")
        return event[field]


def _written(value, spec):
    if isinstance(value, (float, np.floating)):
        return format(float(value), spec or ".3g")
    return format(value, spec or "")
