"""What the viewer knows: a scene, its settings, the picked pixel's paths and the place in them. No web."""

from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np

import tracer
from lessons.zoo import planted
from tracer.scene_file.change import changed
from tracer.what_if import supposed
from viewer.cursor import Cursor
from viewer.history import History
from viewer.link import Link
from viewer.numerals import luminance
from viewer.replay import inspect_command
from viewer.understanding.waterfall import waterfall

KEPT = (
    "scene", "settings", "spp_done", "picture", "numpy_why", "recording", "given", "overlay", "record",
    "cursor", "history", "supposing",
)  # fmt: skip


@dataclass(frozen=True)
class Supposing:
    """What is supposed of one path, {(depth, kind): value}, and the path as it would be."""

    of: object  # the path as it is
    what: dict
    path: object


class Session:
    """The one truth behind every panel.

    load: from the name of a scene a link may ask for to that scene; TracerError where it may not.
    shelf: what panels keep whatever the scene, by their names.
    recording: the Folder that scene and settings come from, if there is one. given: the paths of another
    tracer (viewer.opening.given.Given), in place of castray's own.
    """

    def __init__(self, scene, settings, load, recording=None):
        self.load, self.desk, self.shelf = load, {}, {}
        self.uploaded = {}  # scenes that came from the page, by name
        self.rivals, self.against = {}, ""  # what may be compared with beside tracers, by name; what is
        self.adopt(scene, settings)
        self.at_start = self.settings
        self._fall = None, ()  # a record and its waterfall
        self.recording = recording

    def adopt(self, scene, settings):
        """Turn to another scene or other settings; no pixel is picked yet."""
        self.close()
        self.scene, self.settings = scene, settings.at_size_of(scene)
        self.spp_done, self.picture = 0, None
        self.numpy_why = ""  # why NumPy made the picture, where gl was asked for
        self.recording, self.given, self.overlay = None, None, None
        self.record, self.cursor, self.history = None, None, History()
        self.supposing = None

    def close(self):
        """Forget what the panels keep of the scene: desk has it by their names."""
        for kept in self.desk.values():
            kept.close()
        self.desk = {}

    def pick(self, x, y):
        """Re-trace a pixel with the recorder on, or take what is given of it, and stand at the start of its
        brightest path."""
        if self.given is not None:
            self.record = self.given.record(x, y)
        else:
            self.record = tracer.inspect(self.scene, self.settings, x, y, steps=planted(self.settings))
        lengths = tuple(len(path.events) for path in self.record.paths)
        self.cursor = Cursor(x, y, lengths, brightest(self.record))
        self.history.add((x, y))

    def spread(self, values):
        """Values (H, W, ...) of pixels as they are shown: given paths may leave out pixels."""
        return values if self.given is None else self.given.spread(values)

    def open(self, link):
        """Turn to what a link says; True if that needs a new picture."""
        here = link.scene == self.scene.name
        scene = self.scene if here else self.uploaded.get(link.scene) or self.load(link.scene)
        if link.changes != scene.definition.changes:
            scene = changed(scene, link.changes)
        settings = link.settings.at_size_of(scene)
        renewed = scene is not self.scene or settings != self.settings
        with self._unchanged_by_errors():
            if renewed:
                self.adopt(scene, settings)
            self.stand(link.place)
            self.suppose(link.what_if)
        self._compare(link.compare)
        return renewed

    def _compare(self, name):
        """Compare with the tracer that a link names; without one, only a file stays compared with."""
        name = name or (self.against if self.against in self.rivals else "")
        if name != self.against:
            self.against, before = name, self.desk.pop("compare", None)
            if before:
                before.close()

    def alter(self, scene, settings):
        """Turn to the same scene said differently, or to other settings, and stay as near as can be to the
        place. Raises TracerError, with nothing changed, where that cannot be."""
        before, history = self.cursor, self.history
        with self._unchanged_by_errors():
            self.adopt(scene, settings)
            self.history = history
            self.pick(min(before.x, self.settings.width - 1), min(before.y, self.settings.height - 1))
        self.cursor = self.cursor.on(before.path).at(before.event)

    def give(self, given):
        """Turn to the paths of another tracer, and stay as near as can be to the place; where nothing was
        given before, to where they are to be opened."""
        first, before, history = self.given is None, self.cursor, self.history
        with self._unchanged_by_errors():
            self.adopt(given.scene, given.settings)
            self.given, self.history, self.desk["doctor"] = given, history, given.chart
            if first or not self._stand_near(before):
                self.stand(given.start)

    def _stand_near(self, place):
        """Stand at a cursor's place or near it; False where nothing was recorded."""
        try:
            self.pick(min(place.x, self.settings.width - 1), min(place.y, self.settings.height - 1))
        except tracer.TracerError:
            return False
        self.cursor = self.cursor.on(place.path).at(place.event)
        return True

    @contextmanager
    def _unchanged_by_errors(self):
        """What is KEPT is again as it was where the block raises."""
        kept = {name: getattr(self, name) for name in KEPT}
        try:
            yield
        except (tracer.TracerError, IndexError):
            vars(self).update(kept)
            raise

    def stand(self, place):
        """Go to (x, y, path, event), path None to the brightest, event None to where it is given most;
        without a place, where the scene has most to tell."""
        if place is None:
            self.pick(*telling_pixel(self.scene, self.settings))
            self.cursor = self.cursor.at(most_giving(self.path))
            return
        x, y, path, event = place
        if self.cursor is None or (x, y) != (self.cursor.x, self.cursor.y):
            self.pick(x, y)
        path = brightest(self.record) if path is None else path
        self.cursor = Cursor(x, y, self.cursor.lengths, path)
        event = most_giving(self.path) if event is None else event
        self.cursor = Cursor(x, y, self.cursor.lengths, path, event)

    def suppose(self, what):
        """Suppose {(depth, kind): value} of the path, nothing if it is empty. Raises TracerError."""
        if not what:
            self.supposing = None
            return
        if self.given is not None:
            raise tracer.TracerError(
                f"what_if: is for castray's own paths, not for those of {self.given.name}"
            )
        c, steps = self.cursor, planted(self.settings)
        record = supposed(self.scene, self.settings, c.x, c.y, self.path.sample, what, steps)
        self.supposing = Supposing(self.path, dict(what), record.paths[0])

    @property
    def supposition(self):
        """The Supposing of the path that the reader stands on, if there is one."""
        there = self.supposing
        return there if there is not None and there.of is self.path else None

    @property
    def suppositions(self):
        """What is supposed of this path, {(depth, kind): value}."""
        return self.supposition.what if self.supposition else {}

    @property
    def path(self):
        """The recorded path the reader stands on."""
        return self.record.paths[self.cursor.path]

    @property
    def waterfall(self):
        """The Bars of the picked pixel; worked out once, since every step to another path asks for them."""
        if self._fall[0] is not self.record:
            self._fall = self.record, waterfall(self.record)
        return self._fall[1]

    @property
    def event(self):
        """The recorded event the reader stands at."""
        return self.path.events[self.cursor.event]

    @property
    def pace(self):
        """Seconds that a path of this picture took NumPy, None before it has made one."""
        if self.picture is None or self.picture.engine != "numpy":
            return None
        return self.picture.seconds / self.picture.paths

    @property
    def link(self):
        """The moment as a link, without a key."""
        c = self.cursor
        place = (c.x, c.y, c.path, c.event) if c else None
        return Link(
            self.scene.name,
            self._asked_settings(),
            place,
            self.scene.definition.changes,
            self.suppositions if c else {},
            "" if self.against in self.rivals else self.against,
        )

    @property
    def command(self):
        """`castray inspect` of the path, in words; of what is given the command that judges it."""
        if self.given is not None:
            return self.given.command
        place = self.cursor.x, self.cursor.y, self.path.sample, self.cursor.event
        changes = self.scene.definition.changes
        return inspect_command(self.scene.name, self.settings, place, changes, self.suppositions)

    @property
    def why_command(self):
        """`castray inspect` that says why the pixel is what it is; of what is given as `command`."""
        if self.given is not None:
            return self.given.command
        place = self.cursor.x, self.cursor.y, None, None
        changes = self.scene.definition.changes
        return inspect_command(self.scene.name, self.settings, place, changes) + " --why"

    def _asked_settings(self):
        """The settings, the size left out where it is the scene's own."""
        s = self.settings
        own = (s.width, s.height) == (self.scene.width, self.scene.height)
        return replace(s, width=None, height=None) if own else s


def brightest(record):
    """Which path adds most to the pixel."""
    return int(np.argmax([luminance(path.radiance) for path in record.paths]))


def most_giving(path):
    """Which event of a path adds most to it; the first if none adds anything."""
    return int(np.argmax([luminance(e.values.get("contribution", (0, 0, 0))) for e in path.events]))


def throughput(events, index):
    """What the path's light is multiplied by at an event: the last throughput recorded up to it."""
    for event in reversed(events[: index + 1]):
        if "beta" in event.values:
            return event.values["beta"]
    return np.ones(3)


def telling_pixel(scene, settings, tries=9):
    """A pixel worth opening with: of a few over the picture, the one whose brightest path shows most."""
    steps = planted(settings)
    few = settings.at_spp(min(settings.spp, 8))
    places = [
        (int((0.3 + 0.2 * (k % 3)) * settings.width), int((0.5 + 0.15 * (k // 3)) * settings.height))
        for k in range(tries)
    ]
    return max(places, key=lambda xy: _telling(tracer.inspect(scene, few, xy[0], xy[1], steps=steps)))


def _telling(record):
    """How much the brightest path shows: a seen and a blocked light sample, on a path that is soon walked."""
    path = record.paths[brightest(record)]
    samples = [e.values for e in path.events if e.kind.name == "light"]
    seen = any(np.any(v["contribution"] > 0) for v in samples)
    blocked = any(v["blocker"] >= 0 for v in samples)
    return 2 * seen + 2 * blocked + (luminance(path.radiance) > 0) - abs(len(path.events) - 10) / 4
