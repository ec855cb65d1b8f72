"""What a log of events leaves out, and its other numbers and the scene say."""

import numpy as np

from tracer.bsdf import Plastic
from tracer.frame import dot, length, normalize
from tracer.trace.jsonl import conventions, geometry


class Completed:
    """The tables of a log of events with what follows from them and a Scene (of 64 bits). notes: in words;
    rebuilt: "kind.field" that were added; assumed: those of them that the law about them was asked for."""

    def __init__(self, scene, tables):
        self.scene, self.tables = scene, tables
        self.notes, self.rebuilt, self.assumed = [], set(), set()
        if tables["hit"]["p"] is None:
            return
        self.vertices = self._before("light"), self._before("bounce")
        self._hits()
        self._lights()
        self._bounces()

    def _add(self, kind, name, column, of_log=False):
        if self.tables[kind][name] is None:
            self.tables[kind].columns[name] = column
            self.rebuilt.add(f"{kind}.{name}")
            if not of_log:
                self.assumed.add(f"{kind}.{name}")

    def _before(self, kind, other="hit"):
        """For each event of a kind the row (E,) of its path's last event of `other` before it, -1."""
        here, there = self.tables[kind], self.tables[other]
        if not there.path.size:
            return np.full(here.path.shape, -1)
        most = 1 + max(int(table.step.max(initial=0)) for table in self.tables.values())
        keys = there.path.astype(np.int64) * most + there.step
        row = np.searchsorted(keys, here.path.astype(np.int64) * most + here.step) - 1
        return np.where((row >= 0) & (there.path.take(row) == here.path), row, -1)

    def _column(self, kind, name):
        return self.tables[kind][name].astype(np.float64)

    def _arrivals(self):
        """Directions (3, E) in which hits were come to; None where neither bounces nor points say it."""
        hits = self.tables["hit"]
        if hits["wo"] is not None:
            return -self._column("hit", "wo")
        d = np.full(hits["p"].shape, np.nan)
        for kind, name in (("camera", "d"), ("bounce", "wi")):
            if self.tables[kind][name] is not None:
                row = self._before("hit", kind)
                of_this = row >= 0  # a bounce is later than the camera, and the last one counts
                d[:, of_this] = self._column(kind, name)[:, row[of_this]]
        return d if np.isfinite(d).all() else None

    def _hits(self):
        hits, d = self.tables["hit"], self._arrivals()
        if d is None:
            return
        p = self._column("hit", "p")
        self._add("hit", "wo", -d)
        if hits["primitive"] is None:
            primitive = geometry.primitives_at(self.scene, p - d, d, p)
            hits.columns["primitive"] = np.maximum(primitive, 0)
            nowhere = int(np.count_nonzero(primitive < 0))
            if nowhere == primitive.size > 0:
                self.notes.append(conventions.none_of(self.scene))
            elif nowhere:
                self.notes.append(f"{nowhere} vertices lie on no surface of {self.scene.name}")
        ng, n = geometry.surfaces(self.scene, p, d, hits["primitive"])
        self._add("hit", "ng", ng)
        self._add("hit", "n", n)

    def _lights(self):
        """Which lamp a point lies on, and the way there."""
        lights, row = self.tables["light"], self.vertices[0]
        if lights["q"] is None or not lights.path.size or (row < 0).any() or self.scene.definition.emitters:
            return
        gap = self._column("light", "q") - self._column("hit", "p")[:, row]
        self._add("light", "distance", length(gap))
        with np.errstate(all="ignore"):
            self._add("light", "wi", normalize(gap))
        if lights["primitive"] is None:
            lights.columns["primitive"] = self._lamps(self._column("light", "q"), normalize(gap))
        self._add("light", "light", np.maximum(self.scene.light_of.take(lights["primitive"]), 0))
        if self.tables["hit"]["n"] is not None:
            n = self._column("hit", "n")[:, row]
            self._add("light", "cos", np.abs(dot(n, self._column("light", "wi"))))

    def _lamps(self, q, wi):
        """Primitives (E,) of lamps that points lie on; of points on none, some lamp's: the laws say so."""
        primitive = geometry.primitives_at(self.scene, q - wi, wi, q)
        some = np.flatnonzero(self.scene.light_of >= 0)[0]
        return np.where((primitive >= 0) & (self.scene.light_of.take(primitive) >= 0), primitive, some)

    def _bounces(self):
        bounces, hits, row = self.tables["bounce"], self.tables["hit"], self.vertices[1]
        if bounces["wi"] is None or (row < 0).any() or hits["primitive"] is None:
            return
        if hits["n"] is not None:
            n = self._column("hit", "n")[:, row]
            self._add("bounce", "cos", np.abs(dot(n, self._column("bounce", "wi"))))
        if not any(isinstance(m, Plastic) for m in self.scene.definition.bsdfs.values()):  # has lobes of both
            material = self.scene.bsdf_of.take(hits["primitive"].take(row))
            self._add("bounce", "delta", self.scene.bsdf.is_delta(material))


def asked_where_due(found):
    """Make `visible` false in Columns of light samples that do not say it since nothing arrived anyhow."""
    if "visible" not in found.values or "contribution" not in found.values:
        return
    silent = ~found.given["visible"]
    dark = found.given["contribution"] & (found.values["contribution"] == 0.0).all(axis=0)
    if (dark | ~silent).all():
        found.values["visible"][silent] = 0
        found.given["visible"][:] = True
