"""A trace as its judge sees it: columns in float64, who comes before whom, and the plain answers."""

from dataclasses import replace
from functools import cached_property

import numpy as np

from tracer.doctor.brute import Brute
from tracer.doctor.lamps import Lamps
from tracer.doctor.rule import NotRecordedError
from tracer.events import HIT, KINDS
from tracer.frame import dot, length

# Machine epsilons by which a unit vector, or a coordinate as a share of the scene, may be off after the few
# operations that make it: a turn of a frame and its back (9 products and sums each), or o + t d.
OFF = 16.0
_BLANK = {f.name: f.blank for f in HIT.fields}
_WHOLE = ("index", "shape", "bsdf", "light", "choice")
_TYPE = {
    f"{kind.name}.{f.name}": bool if f.domain == "flag" else np.intp
    for kind in KINDS
    for f in kind.fields
    if f.domain in _WHOLE or f.domain == "flag"
} | {f"path.{name}": np.intp for name in ("x", "y", "sample", "end", "vertices")}


class Evidence:
    """What rules ask of a trace. The settings' `bug` is taken away first: nobody here may look at it."""

    def __init__(self, trace):
        self.trace = replace(trace, settings=replace(trace.settings, bug=None))
        self.settings = self.trace.settings
        self.scene = trace.scene.at(replace(self.settings, precision=64, accel="bvh"))
        self.eps = trace.eps
        self._columns = {}

    def has(self, place):
        """Whether a column, written "kind.field" or "path.field", was recorded."""
        kind, name = place.split(".")
        return name in (self.trace.paths if kind == "path" else self.trace.tables[kind].columns)

    def count(self, kind):
        """Number of events of a kind."""
        return self.trace.size if kind == "path" else self.trace.tables[kind].path.size

    def __call__(self, place):
        """A recorded column (..., E): numbers in float64, counts and flags as they are."""
        if place not in self._columns:
            kind, name = place.split(".")
            columns = self.trace.paths if kind == "path" else self.trace.tables[kind].columns
            if name not in columns:
                raise NotRecordedError(place)
            column = columns[name]
            self._columns[place] = column.astype(_TYPE.get(place, np.float64), copy=False)
        return self._columns[place]

    @cached_property
    def _most(self):
        return 1 + max(int(table.step.max(initial=0)) for table in self.trace.tables.values())

    def _key(self, kind):
        table = self.trace.tables[kind]
        return table.path.astype(np.int64) * self._most + table.step

    def before(self, kind, other):
        """For each event of `kind` the row (E,) of its path's last event of `other` before it, -1."""
        name = f"{other} before {kind}"
        if name not in self._columns:
            keys = self._key(other)
            row = np.searchsorted(keys, self._key(kind)) - 1
            there = row >= 0
            there[there] = self.trace.tables[other].path[row[there]] == self.trace.tables[kind].path[there]
            self._columns[name] = np.where(there, row, -1)
        return self._columns[name]

    def after(self, kind, other):
        """For each event of `kind` the row (E,) of its path's first event of `other` after it, -1."""
        name = f"{other} after {kind}"
        if name not in self._columns:
            keys = self._key(other)
            row = np.searchsorted(keys, self._key(kind), side="right")
            there = row < keys.size
            there[there] = self.trace.tables[other].path[row[there]] == self.trace.tables[kind].path[there]
            self._columns[name] = np.where(there, row, -1)
        return self._columns[name]

    def at_vertex(self, kind, name):
        """A column of the last HIT before each event of a kind; blank, as its Field says, where there is
        none."""
        row = self.before(kind, "hit")
        column = self(f"hit.{name}").take(row, axis=-1)
        return np.where(row < 0, _BLANK[name], column) if (row < 0).any() else column

    @cached_property
    def scale(self):
        """Largest coordinate in the scene in metres: what rounds in every point."""
        low, high = self.scene.bounds()
        eye = self.scene.camera
        return float(
            max(np.abs(low).max(), np.abs(high).max(), np.abs(eye.origin).max() + eye.aperture_radius)
        )

    @property
    def off_unit(self):
        """How far each component of a recorded unit vector may be off."""
        return OFF * self.eps

    @property
    def off_point(self):
        """How far each coordinate of a recorded point may be off, in metres."""
        return OFF * self.eps * self.scale

    @property
    def off_vertex(self):
        """The same of vertices and light points: where they were printed and not worked out from others,
        printing counts once, beside the loop's own rounding."""
        own = float(np.finfo(np.float32 if self.settings.precision == 32 else np.float64).eps)
        if self.eps <= own or {"hit.p", "light.q"} & self.trace.rebuilt:
            return self.off_point
        return (OFF * own + self.eps) * self.scale

    @cached_property
    def brute(self):
        """Every primitive of the scene, to be asked one by one."""
        return Brute(self.scene)

    @cached_property
    def lamps(self):
        """What light sampling has to be."""
        found = Lamps(self.scene, self.settings, self.brute)
        if self.has("light.pick") and self.has("light.light"):
            found.listen(self("light.light"), self("light.pick"), self.eps)
        return found

    def is_unit(self, place):
        """Whether each vector of a column is finite and of length 1, (E,)."""
        name = f"{place} is unit"
        if name not in self._columns:
            with np.errstate(over="ignore", invalid="ignore"):
                self._columns[name] = np.abs(length(self(place)) - 1.0) <= 4.0 * OFF * self.eps
        return self._columns[name]

    def sound(self, kind, *vectors):
        """Whether the unit vectors that rules on events of a kind are made from are unit, (E,): what is made
        from others says nothing. vectors: names of the event's own; n and wo of the vertex always count."""
        vertex = self.before(kind, "hit")
        good = (self.is_unit("hit.n") & self.is_unit("hit.wo") & np.isfinite(self("hit.p")).all(axis=0))[
            vertex
        ]
        for name in vectors:
            good = good & self.is_unit(f"{kind}.{name}")
        return good & (vertex >= 0)

    @cached_property
    def arrivals(self):
        """How each HIT was come to: (origin (3, E), direction (3, E), primitive it started on (E,)).

        The origin is the vertex before or the camera's; nothing is known of an offset there.
        """
        return self._arrivals("hit")

    def _arrivals(self, kind):
        vertex, bounce, camera = (self.before(kind, other) for other in ("hit", "bounce", "camera"))
        first = vertex < 0
        o, d, source = self("camera.o")[:, camera], self("camera.d")[:, camera], np.full(vertex.shape, -1)
        if not first.all():
            o = np.where(first, o, self("hit.p").take(vertex, axis=1))
            source = np.where(first, -1, self("hit.primitive").take(vertex))
        if self.count("bounce"):
            d = np.where(bounce < 0, d, self("bounce.wi").take(bounce, axis=1))
            o = np.where(first & (bounce >= 0), np.nan, o)
        return o, d, source

    @cached_property
    def departures(self):
        """The same of each ESCAPE."""
        return self._arrivals("escape")

    @cached_property
    def lies_on_surface(self):
        """Whether each HIT lies on its primitive, (E,)."""
        return self.brute.off_surface(self("hit.p"), self("hit.primitive")) <= 64.0 * self.off_point

    def starts_on_surface(self, kind):
        """Whether the rays that lead to events of a kind start on the surface that they are said to, (E,)."""
        vertex = self.before(kind, "hit")
        found = vertex < 0
        found[~found] = self.lies_on_surface[vertex[~found]]
        return found

    def materials(self, kind):
        """Number of the material at each event's vertex, (E,), -1 where there is no vertex."""
        primitive = self.at_vertex(kind, "primitive")
        return np.where(primitive < 0, -1, self.scene.bsdf_of.take(primitive))

    def asked(self, p, n, wo, wi, primitive, what):
        """What the materials' own `eval` or `pdf` (what) say in float64; the plain answer, (3, N) or (N,)."""
        scene = self.scene
        frame = scene.frame(n, p, primitive)
        material, texture = scene.bsdf_of.take(primitive), scene.painted(p, primitive)
        ask = getattr(scene.bsdf, what)
        found = ask(material, frame.to_local(wo), frame.to_local(wi), texture)
        if what == "eval" and scene.has_smooth_normals:
            ng = self.brute.normals(p, primitive)
            found = found * (dot(n, wi) * dot(ng, wi) > 0.0)
        return found
