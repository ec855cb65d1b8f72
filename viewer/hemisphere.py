"""The hemisphere over a vertex in 3D: lobes, vectors, directions as solids and labels; pure geometry."""

import numpy as np

from viewer import solids
from viewer.numerals import short
from viewer.surfaces import COLOURS as PATHS
from viewer.surfaces import VIEW_ANGLE, rgb
from viewer.traces import LONG, NAMES
from viewer.understanding.draws import OFF, RINGS, SECTORS

# In the order in which they are drawn: what is seen through comes last.
COLOURS = {
    "shell": rgb("#667286"),
    "ng": rgb("#9a62ea"),
    "h": rgb("#d93678"),
    "tried_bounce": PATHS["wi"],
    "tried_lit": PATHS["lit"],
    "tried_blocked": PATHS["blocked"],
    "tried_idle": rgb("#a9b2c2"),
    "lobe_p": rgb("#5fc7d8"),
    "lobe_f": rgb("#ffd257"),
    "more": rgb("#ff7a70"),
    "fewer": rgb("#668cff"),
}
OPACITY = {"lobe_f": 0.5, "more": 0.4, "fewer": 0.3}
LIT = ("lobe_f",)
AWAY, ABOVE = 5.2, 0.45  # where it is looked at from: so many times `reach`, so much of it along the normal
NO_LINES = np.zeros((0, 3)), np.zeros((0, 2), int)
SAME = 0.99999  # cosine between normals that are drawn as one
MOST_TRIED = 256  # balls
ARC = 48  # stretches of a circle
PATCH = 5  # places along an edge of a cell


class Hemisphere:
    """What a Lens looks like in a scene whose diagonal is `size`.

    drawn: {name of COLOURS: (points (P, 3), cells)}, triangles or segments; labels: words at places, as the
    Stage has them; lobes: the Lobes that are shown; reach: how long 1 is, and the largest of f |cos| and p.
    """

    def __init__(self, lens, size, say):
        self.lens, self.reach, self._thin = lens, LONG * size, 0.0016 * size
        self._p = np.asarray(lens.vertex.hit["p"], float)
        self.lobes = lens.lobes
        self.drawn = dict.fromkeys(COLOURS, solids.EMPTY)
        self.labels = []
        self._shell()
        self._surfaces()
        self._diracs(say)
        self._vectors()
        self._tried()
        self._cells()

    def at(self, shown, length=1.0):
        """Places (N, 3) so far (N,) along shown directions (3, N), 1 is `reach`."""
        way = self.lens.vertex.world(shown).astype(float)
        return self._p + self.reach * (way * length).T

    def viewpoint(self):
        """Where to look from, as `viewer.surfaces.viewpoint`: n up and wo to the left, as in textbooks."""
        up, aside = self.lens.sides[0], np.sqrt(1.0 - ABOVE**2)
        eye = self.at(np.array([[0.0], [-aside], [up * ABOVE]]), AWAY)[0]
        to = self.at(np.array([[0.0], [0.0], [up]]), 0.3 if len(self.lens.sides) == 1 else 0.0)[0].tolist()
        look = {"position": eye.tolist(), "focalPoint": to, "viewUp": self._world((0.0, 0.0, up)).tolist()}
        return look | {"viewAngle": VIEW_ANGLE, "centerOfRotation": to}

    def legend(self, say):
        """What the marks mean, with the largest values: [{kind, text}]."""
        rows = [
            {"kind": f"lobe_{name}", "text": say(f"lens.{name}", most=short(self.lobes.peak(name)))}
            for name in "fp"
            if self.lobes.sheets
        ]
        if self.lobes.diracs:
            rows += [{"kind": "lobe_f", "text": say("lobes.f")}, {"kind": "lobe_p", "text": say("lobes.p")}]
        for name in ("more", "fewer"):
            if len(self.drawn[name][1]):
                rows.append({"kind": name, "text": say(f"lobes.{name}")})
        return rows

    def _shell(self):
        """The rim of the sides, and for each two half circles over the pole: the directions' unit sphere."""
        turn, full = np.linspace(0.0, np.pi, ARC + 1), np.linspace(0.0, 2.0 * np.pi, 2 * ARC + 1)
        zero = np.zeros_like(turn)
        arcs = [np.stack((np.cos(full), np.sin(full), np.zeros_like(full)))]
        for side in self.lens.sides:
            up = side * np.sin(turn)
            arcs += [np.stack((np.cos(turn), zero, up)), np.stack((zero, np.cos(turn), up))]
        self.drawn["shell"] = solids.merge(*(_line(self.at(arc)) for arc in arcs))

    def _surfaces(self):
        """Both lobes at one scale, so that one inside the other is a weight f |cos| / p below or above 1."""
        filled, wired = [], [NO_LINES]
        for sheet in self.lobes.sheets:
            filled.append((self.at(sheet.directions, sheet.f / self.lobes.most), sheet.faces))
            wired.append((self.at(sheet.directions, sheet.p / self.lobes.most), sheet.wires))
        self.drawn["lobe_f"], self.drawn["lobe_p"] = solids.merge(*filled), solids.merge(*wired)

    def _diracs(self, say):
        """Two arrows beside each other for a Dirac lobe, as long as its f and its p."""
        for dirac in self.lobes.diracs:
            way = self._world(dirac.direction)
            aside = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
            aside *= 5.0 * self._thin / np.linalg.norm(aside)
            for name, sign, length in (("lobe_f", 1.0, dirac.f), ("lobe_p", -1.0, dirac.p)):
                thick = min(1.8 * self._thin, 0.06 * length * self.reach)
                arrow = solids.arrow(self._p + sign * aside, way, length * self.reach, thick)
                cells = _edges(arrow[1]) if name == "lobe_p" else arrow[1]
                self.drawn[name] = solids.merge(self.drawn[name], (arrow[0], cells))
            name = say(f"choice.{dirac.name}")
            words = say("lobes.dirac", lobe=name, f=short(dirac.f), p=short(dirac.p))
            tip = self._p + (1.1 * max(dirac.f, dirac.p) * self.reach + 8.0 * self._thin) * way
            self.labels.append({"text": words, "layer": "dirac", "at": tip.tolist()})

    def _vectors(self):
        """ng and h; the other vectors are those of the event."""
        for name in ("ng", "h"):
            w = self.lens.vectors.get(name)
            if w is None or (name == "ng" and w @ self.lens.vectors["n"] > SAME):
                continue
            way, length = self._world(w), 0.9 * self.reach
            self.drawn[name] = solids.arrow(self._p, way, length, 2.0 * self._thin)
            place = (self._p + 1.14 * length * way).tolist()
            self.labels.append({"text": NAMES[name], "layer": name, "at": place})

    def _tried(self):
        """A ball for each direction that the pixel's paths tried."""
        for name in ("bounce", "lit", "blocked", "idle"):
            ways = [one.shown for one in self.lens.tried[:MOST_TRIED] if one.kind == name]
            ways = [way for way in ways if np.isfinite(way).all()]
            if ways:
                self.drawn[f"tried_{name}"] = solids.balls(self.at(np.stack(ways, axis=1)), 2.2 * self._thin)

    def _cells(self):
        """The cells of solid angle where far more or far fewer bounces go than p says."""
        off = [c for c in self.lens.counts if isinstance(c.where, tuple) and abs(c.off) >= OFF]
        for name, sign in (("more", 1.0), ("fewer", -1.0)):
            cells = [self._cell(*count.where) for count in off if sign * count.off > 0.0]
            self.drawn[name] = solids.merge(*cells)

    def _cell(self, side, ring, sector):
        z = 1.0 - (ring + np.linspace(0.0, 1.0, PATCH)) / RINGS
        turn = 2.0 * np.pi * (sector + np.linspace(0.0, 1.0, PATCH)) / SECTORS
        z, turn = (v.ravel() for v in np.meshgrid(z, turn, indexing="ij"))
        across = np.sqrt(np.maximum(1.0 - z * z, 0.0))
        k = np.arange(PATCH * PATCH).reshape(PATCH, PATCH)
        a, b, c, d = (v.ravel() for v in (k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]))
        faces = np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1)))
        return self.at(np.stack((across * np.cos(turn), across * np.sin(turn), side * z))), faces

    def _world(self, shown):
        return self.lens.vertex.world(np.reshape(shown, (3, 1)))[:, 0].astype(float)


def _line(points):
    """A line through points (N, 3)."""
    k = np.arange(len(points) - 1)
    return points, np.stack((k, k + 1), axis=1)


def _edges(faces):
    """The edges of triangles, each once."""
    pairs = np.sort(np.concatenate((faces[:, :2], faces[:, 1:], faces[:, ::2])), axis=1)
    return np.unique(pairs, axis=0)
