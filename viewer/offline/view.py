"""What the 3D view of a page is given: scenes, pictures and places in them, as plain values."""

import base64
import io
import json

import numpy as np

from tracer.picture import to_srgb
from viewer import hemisphere
from viewer.caption import caption, light_outcome
from viewer.surfaces import BACKGROUND, COLOURS, sight, surfaces, viewpoint
from viewer.traces import NAMES, Strokes, here, light_samples, vertices, vertices_until

WORDS = ("picture", "stage", "home", "first", "previous", "next", "last", "up", "down", "no_webgl")
DIGITS = 5


class View:
    """Collects what a page shows in 3D, in one language; equal scenes and pictures are kept once."""

    def __init__(self, say):
        self.say = say
        self._scenes, self._pictures, self.places = {}, {}, []

    def add(self, name, scene, pixel, paths, path=0, event=0, rgb=None, over=None):
        """Add a place: a pixel (x, y), the recorded paths that are drawn, and where in them one stands; rgb
        (H, W, 3): the picture beside it; over: the Hemisphere over that event. The place's number."""
        number, size = self._scene(scene)
        told = [self._path(index, one, scene, size) for index, one in enumerate(paths)]
        at = {"name": name, "scene": number, "x": pixel[0], "y": pixel[1], "picture": self._picture(rgb)}
        shown = over and {"path": path, "event": event, **_over(over)}
        self.places.append(at | {"paths": told, "path": path, "event": event, "over": shown})
        return len(self.places) - 1

    def script(self, start=0):
        """The data as text that may stand in a script element."""
        words = {name: self.say(f"ui.{name}") for name in WORDS}
        data = {
            "start": start,
            "words": words,
            "names": NAMES,
            "background": BACKGROUND,
            "colours": COLOURS,
            "scenes": [found for _, found in self._scenes.values()],
            "pictures": list(self._pictures.values()),
            "places": self.places,
        }
        text = json.dumps(data, allow_nan=False, separators=(",", ":"), ensure_ascii=False)
        return text.replace("<", "\\u003c")

    def _scene(self, scene):
        """Number and size of a scene."""
        low, high = sight(scene)
        size = float(np.linalg.norm(high - low))
        if id(scene) not in self._scenes:
            found = {"size": size, "camera": viewpoint(scene, low, high)}
            self._scenes[id(scene)] = scene, found | {"surfaces": [_surface(s) for s in surfaces(scene)]}
        return list(self._scenes).index(id(scene)), size

    def _picture(self, rgb):
        """Number of a picture, counted from 1; 0 without one."""
        if rgb is None:
            return 0
        height, width = rgb.shape[:2]
        source = f"data:image/png;base64,{_text(png(rgb))}"
        self._pictures.setdefault(source, {"source": source, "width": width, "height": height})
        return list(self._pictures).index(source) + 1

    def _path(self, index, path, scene, size):
        strokes, line = Strokes(size), vertices(path, size)
        line = line[: _known(line)]
        events = [self._event(path, step, scene, strokes, len(line)) for step in range(len(path.events))]
        lights = [_light(hit, sample) for hit, sample in light_samples(path)]
        return {
            "index": index,
            "head": self.say("offline.path", path=path.sample),
            "line": _plain(line),
            "events": events,
            "lights": [light for light in lights if light is not None],
        }

    def _event(self, path, step, scene, strokes, corners):
        event, say = path.events[step], self.say
        place = here(path, step)
        arrows = [
            [name, _plain(start), _plain(way), _plain(length)]
            for name, start, way, length in strokes.vectors(path, step)
            if np.all(np.isfinite(way)) and np.all(np.isfinite(start))
        ]
        head = say("timeline.mark", event=step, kind=say(f"kind.{event.kind.name}"), depth=event.depth)
        return {
            "head": head,
            "text": caption(event, scene, say),
            "reached": min(vertices_until(path, step), corners - 1),
            "here": None if place is None or not np.all(np.isfinite(place)) else _plain(place),
            "arrows": arrows,
        }


def png(rgb):
    """A linear picture as the bytes of a PNG file."""
    from PIL import Image

    kept = io.BytesIO()
    Image.fromarray(to_srgb(rgb)).save(kept, "png", optimize=True)
    return kept.getvalue()


def _surface(surface):
    looks = surface.colour, surface.opacity, not surface.lamp, bool(surface.one_sided)
    return _mesh(surface.vertices, surface.faces, *looks)


def _over(over):
    """A Hemisphere as meshes in the order in which they are drawn; faces of two places are lines."""
    meshes = []
    for name, colour in hemisphere.COLOURS.items():
        points, cells = over.drawn[name]
        if len(cells):
            lit = name in hemisphere.LIT
            meshes.append(_mesh(points, cells, colour, hemisphere.OPACITY.get(name, 1.0), lit, lit))
    labels = [{"text": one["text"], "at": _plain(one["at"])} for one in over.labels]
    return {"meshes": meshes, "labels": labels, "camera": over.viewpoint()}


def _mesh(points, cells, colour, opacity, lit, culled):
    return {
        "colour": _plain(colour),
        "opacity": opacity,
        "lit": lit,
        "culled": culled,
        "width": cells.shape[1],
        "points": _text(np.ascontiguousarray(points, "<f4").tobytes()),
        "faces": _text(np.ascontiguousarray(cells, "<u4").tobytes()),
    }


def _light(hit, sample):
    """[outcome, from, to] of a light sample; None where it leads nowhere."""
    outcome = light_outcome(sample)
    p, end = np.asarray(hit["p"], float), np.asarray(sample["q"], float)
    if outcome == "blocked":
        stop = p + float(sample["blocker_distance"]) * np.asarray(sample["wi"], float)
        end = stop if np.all(np.isfinite(stop)) else end
    outcome = outcome if outcome in ("lit", "blocked") else "idle"
    return [outcome, _plain(p), _plain(end)] if np.all(np.isfinite([p, end])) else None


def _known(line):
    """How many corners of a path come before one that is no place."""
    unknown = np.flatnonzero(~np.isfinite(line).all(axis=1))
    return int(unknown[0]) if len(unknown) else len(line)


def _text(raw):
    return base64.b64encode(raw).decode("ascii")


def _plain(values):
    """Numbers with as many digits as a drawing needs."""
    rounded = [float(f"{v:.{DIGITS}g}") for v in np.ravel(np.asarray(values, float))]
    shape = np.shape(values)
    return rounded[0] if shape == () else np.reshape(rounded, shape).tolist()
