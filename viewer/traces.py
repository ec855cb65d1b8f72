"""A pixel's paths as solids and labels: what belongs to an event, a path, the other paths. Pure geometry."""

import numpy as np

from viewer import solids
from viewer.caption import light_outcome

MOST_OTHERS = 256  # more faint paths than this are only fog
LONG = 0.13  # of an arrow, as a share of the scene's diagonal
# of the arrows
NAMES = {"n": "n", "wo": "ωₒ", "wi": "ωᵢ", "light": "ωᵢ → q", "ng": "n_g", "h": "h"}


class Strokes:
    """Draws for one scene; size is its diagonal, from which every thickness follows."""

    def __init__(self, size):
        self.size, self.thin, self.thick = size, 0.0016 * size, 0.0032 * size
        self._of, self._lines = None, []  # the paths whose corners are known already

    def others(self, paths, selected):
        """The faint paths, as line segments."""
        if paths is not self._of:
            self._of, self._lines = paths, [vertices(p, self.size) for p in paths[: MOST_OTHERS + 1]]
        shown = [line for k, line in enumerate(self._lines) if k != selected][:MOST_OTHERS]
        points = np.concatenate([np.zeros((0, 3)), *shown])
        starts, ends, at = [], [], 0
        for line in shown:
            starts.append(np.arange(at, at + len(line) - 1))
            at += len(line)
        starts = np.concatenate([np.zeros(0, int), *starts])
        ends = starts + 1
        return {"others": (points, np.column_stack([starts, ends]))}

    def path(self, path):
        """The light samples of the selected path: lit ones end in a ball, blocked ones in a cross."""
        parts = {"lit": [], "blocked": [], "idle": []}
        for hit, sample in light_samples(path):
            outcome = light_outcome(sample)
            p, q = np.asarray(hit["p"], float), np.asarray(sample["q"], float)
            if not np.all(np.isfinite([p, q])):  # a log may lack either
                continue
            if outcome == "lit":
                parts["lit"] += [solids.rods(p, q, self.thin), solids.balls(q, 3 * self.thin)]
            elif outcome in ("blocked", "denied"):
                stop = p + float(sample["blocker_distance"]) * np.asarray(sample["wi"], float)
                stop = stop if np.all(np.isfinite(stop)) else q
                parts["blocked"] += [
                    solids.dashes(p, stop, self.thin, 8 * self.thin),
                    solids.cross(stop, 9 * self.thin, self.thin),
                ]
            else:
                parts["idle"].append(solids.dashes(p, q, 0.7 * self.thin, 3 * self.thin))
        return {name: solids.merge(*some) for name, some in parts.items()}

    def companion(self, path, since=0):
        """A path beside the selected one, dashed, with the lamps it sees, from an event on."""
        line, dash = vertices(path, self.size)[vertices_until(path, since) :], 5 * self.thick
        parts = [
            solids.dashes(a, b, 0.9 * self.thick, dash) for a, b in zip(line[:-1], line[1:], strict=True)
        ]
        for hit, sample in light_samples(path, since):
            if light_outcome(sample) == "lit":
                p, q = np.asarray(hit["p"], float), np.asarray(sample["q"], float)
                parts += [
                    solids.dashes(p, q, 1.1 * self.thin, 3 * self.thick),
                    solids.balls(q, 2.5 * self.thin),
                ]
        return solids.merge(*parts, solids.balls(line[1:], 1.8 * self.thick))

    def parting(self, path, other):
        """A place on another path where it has left this one, or else on its first light sample that fell
        elsewhere; its last place where all is the same."""
        here, there = vertices(path, self.size), vertices(other, self.size)
        apart = [k for k, place in enumerate(there) if k >= len(here) or not np.allclose(place, here[k])]
        if apart:
            return there[apart[0] - 1 : apart[0] + 1].mean(axis=0).tolist()
        for (hit, one), (_, was) in zip(light_samples(other), light_samples(path), strict=False):
            if not np.allclose(one["q"], was["q"]):
                return (0.5 * (np.asarray(hit["p"], float) + np.asarray(one["q"], float))).tolist()
        return there[-1].tolist()

    def event(self, path, index):
        """The way walked so far, the way ahead, and the vectors of the current event."""
        line, reached = vertices(path, self.size), vertices_until(path, index)
        walked = solids.rods(line[:reached], line[1 : reached + 1], self.thick)
        joints = solids.balls(line[1 : reached + 1], 1.5 * self.thick)
        ahead = solids.rods(line[reached:-1], line[reached + 1 :], 0.45 * self.thick, sides=5)
        drawn = {"walked": solids.merge(walked, joints), "ahead": ahead, "here": solids.EMPTY}
        drawn |= dict.fromkeys(("n", "wo", "wi", "light"), solids.EMPTY)
        place = here(path, index)
        if place is not None:
            drawn["here"] = solids.balls(place, 3.2 * self.thick)
        for name, start, direction, length in self.vectors(path, index):
            drawn[name] = solids.arrow(start, direction, length, 1.15 * self.thick)
        return drawn

    def vectors(self, path, index):
        """(layer, start, unit vector, length) of what the current event knows."""
        event, hit = path.events[index], last_hit(path, index)
        v, long = event.values, LONG * self.size
        if event.kind.name == "camera":
            return [("wi", v["o"], np.asarray(v["d"], float), long)]
        if hit is None or event.kind.name == "end":
            return []
        arrows = [("n", hit["p"], hit["n"], 0.8 * long), ("wo", hit["p"], hit["wo"], long)]
        if event.kind.name == "light":
            arrows.append(("light", hit["p"], v["wi"], min(long, float(v["distance"]))))
        elif event.kind.name == "bounce":
            arrows.append(("wi", hit["p"], v["wi"], long))
        elif event.kind.name == "escape":
            arrows.append(("wi", hit["p"], v["d"], long))
        return arrows

    def labels(self, path, index):
        """Words at places: {text, layer, at} for the browser to project."""
        marks = []
        for name, start, direction, length in self.vectors(path, index):
            at = np.asarray(start, float) + 1.12 * length * np.asarray(direction, float)
            if np.isfinite(at).all():
                marks.append({"text": NAMES[name], "layer": name, "at": at.tolist()})
        return marks


def vertices(path, size):
    """The corners of a path (K, 3); a ray that escapes is drawn a short way."""
    corners = []
    for event in path.events:
        v = event.values
        if event.kind.name == "camera":
            corners.append(v["o"])
        elif event.kind.name == "hit":
            corners.append(v["p"])
        elif event.kind.name == "escape":
            corners.append(np.asarray(corners[-1], float) + 0.3 * size * np.asarray(v["d"], float))
    return np.array(corners, float).reshape(-1, 3)


def vertices_until(path, index):
    """How many stretches of the path have been walked at an event."""
    return sum(e.kind.name in ("hit", "escape") for e in path.events[: index + 1])


def last_hit(path, index):
    """The values of the surface point the reader stands at; None before the first."""
    for event in reversed(path.events[: index + 1]):
        if event.kind.name == "hit":
            return event.values
    return None


def here(path, index):
    """The point to mark: the surface, or the camera at the start."""
    hit = last_hit(path, index)
    return path.events[0].values["o"] if hit is None else hit["p"]


def light_samples(path, since=0):
    """Every light sample of a path, from an event on, with the surface it was taken from."""
    samples = ((k, e) for k, e in enumerate(path.events) if e.kind.name == "light" and k >= since)
    return [(last_hit(path, k), e.values) for k, e in samples]
