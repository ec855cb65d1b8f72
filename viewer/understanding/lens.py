"""The hemisphere over a vertex: its vectors, what the surface sends where, where this pixel's paths went."""

from dataclasses import dataclass

import numpy as np

from lessons.zoo import planted
from viewer.understanding import draws
from viewer.understanding.lobes import Lobes, lobes
from viewer.understanding.places import places
from viewer.understanding.samples import outcome
from viewer.understanding.vertex import Vertex

NEAR = np.cos(np.radians(8.0))  # between normals, and between wo, of vertices that are looked at together
TERMS = ("F", "D", "G1", "G2")
SHOWN = "hemisphere"  # what the shelf keeps of it: whether it is shown in 3D
STOPPED = ("light.blocked", "light.self", "light.phantom")


@dataclass(frozen=True)
class Tried:
    """A direction (3,) that a path of this pixel tried there. kind: bounce, lit, blocked, idle."""

    kind: str
    place: tuple  # (path, event)
    shown: np.ndarray

    def as_dict(self):
        """Plain values."""
        path, event = self.place
        return {"kind": self.kind, "path": path, "event": event, "direction": self.shown.tolist()}


@dataclass(frozen=True)
class Lens:
    """What is seen over a vertex, directions as `vertex` shows them.

    vectors: {name: (3,)} n, ng, wo, and wi, h where there are any. sheets: (sides, 2, SIDE, SIDE) f |cos| and
    p. plane: (angles, f |cos|, p) in the plane of n and wo, degrees from n, wo's is negative. drawn: (3, D)
    directions of bounces drawn anew, counts: the Counts of them. terms: {name: (here, head on)} behind f.
    lobes: the Lobes there.
    """

    vertex: Vertex
    vectors: dict
    sheets: np.ndarray
    plane: tuple
    tried: tuple
    drawn: np.ndarray
    counts: tuple
    terms: dict
    lobes: Lobes

    @property
    def sides(self):
        """+1 above the normal and -1 below it, those that can be seen or reached."""
        return self.vertex.sides

    @property
    def worst(self):
        """The Count that is furthest from what is expected, None where nothing is."""
        known = [count for count in self.counts if count.expected is not None]
        return max(known, key=lambda count: abs(count.off), default=None)

    def as_dict(self):
        """Plain values, as `castray inspect --event --json` prints them; what is drawn only is left out."""
        return {
            "vectors": {name: w.tolist() for name, w in self.vectors.items()},
            "tried": [one.as_dict() for one in self.tried],
            "draws": draws.DRAWS,
            "counts": [count.as_dict() for count in self.counts],
            "terms": {
                name: {"here": np.ravel(here).tolist(), "head_on": head_on.tolist()}
                for name, (here, head_on) in self.terms.items()
            },
        }


@dataclass
class Kept:
    """The Lens of the event that a session stands at: both the tab and the 3D view show it."""

    path: object  # the recorded path
    event: int
    lens: Lens | None

    def close(self):
        """Nothing goes on behind it."""


def here(session):
    """The Lens over the vertex that a session stands at, None before the first."""
    kept, event = session.desk.get("lens"), session.cursor.event
    if kept is None or kept.path is not session.path or kept.event != event:
        scene, steps = session.scene.at(session.settings), planted(session.settings)
        asked = None if session.given else steps
        found = over(scene, asked, session.record, session.cursor.path, event)
        kept = session.desk["lens"] = Kept(session.path, event, found)
    return kept.lens


def over(scene, steps, record, path, event):
    """The Lens over the vertex of an event, None before the first. scene: at the record's settings; steps:
    those of its tracer, None for one that cannot be asked."""
    there = [place for place in places(record) if place.hit]
    here = next((place for place in there if place.at == (path, event)), None)
    if here is None:
        return None
    with np.errstate(all="ignore"):
        vertex = Vertex(scene, here.hit)
        found = lobes(vertex)
        drawn, counts = np.zeros((3, 0)), ()
        if steps is not None:
            shown, sample = draws.drawn(vertex, steps)
            drawn = shown[:, sample.pdf > 0.0]
            counts = tuple(draws.counted(vertex, shown, sample, found.diracs))
        return Lens(
            vertex,
            _vectors(vertex, here.event),
            np.stack([vertex.sheet(side) for side in vertex.sides]),
            _plane(vertex),
            tuple(_tried(vertex, here, there)),
            drawn,
            counts,
            _terms(vertex, here.event),
            found,
        )


def _vectors(vertex, event):
    """What the event knows."""
    known = {name: vertex.hit[name] for name in ("n", "ng", "wo")}
    if event.kind.name in ("light", "bounce"):
        known["wi"] = event.values["wi"]
    shown = {name: _one(vertex, w) for name, w in known.items()}
    if "wi" in shown and np.isfinite(event.values["D"]):
        h = _half(vertex, shown["wo"], shown["wi"], known["wi"])
        shown |= {"h": h} if np.isfinite(h).all() else {}
    return shown


def _one(vertex, w):
    return vertex.shown(np.reshape(w, (3, 1)))[:, 0]


def _half(vertex, wo, wi, w):
    """The normal of the facets that send wi to wo (3,), by reflection or refraction (Walter et al. 2007)."""
    if wo[2] * wi[2] < 0.0:
        wi = wi * float(vertex.times(1).property("eta", np.reshape(w, (3, 1)))[0, 0])
    h = (wo + wi) / np.linalg.norm(wo + wi)
    return h if h[2] > 0.0 else -h


def _plane(vertex):
    """f |cos| and p in the plane of n and wo: half round it, or all round where light passes through."""
    if len(vertex.sides) == 1:
        angles = np.arange(-90.0, 91.0, 2.0)
    else:
        angles = np.arange(-180.0, 180.0, 3.0)
    x, z = np.sin(np.radians(angles)), np.cos(np.radians(angles)) * vertex.sides[0]
    return angles, *vertex.asked(np.stack((x, np.zeros_like(x), z)))


def _tried(vertex, here, there):
    """What the pixel's paths tried from vertices like this one, at the same depth."""
    alike = [
        place
        for place in there
        if place.event.kind.name in ("light", "bounce")
        and place.event.depth == here.event.depth
        and (place.path == here.path or _alike(place.hit, vertex.hit))
    ]
    if not alike:
        return
    shown = vertex.shown(np.stack([place.event.values["wi"] for place in alike], axis=-1))
    for place, direction in zip(alike, shown.T, strict=True):
        yield Tried(_kind(place), place.at, direction)


def _alike(hit, other):
    """Whether two vertices lie on the same shape and are seen under the same angle, about."""
    near = all(np.dot(hit[name], other[name]) > NEAR for name in ("n", "wo"))
    return near and hit["shape"] == other["shape"]


def _kind(place):
    if place.event.kind.name == "bounce":
        return "bounce"
    became = outcome(place)
    return "blocked" if became in STOPPED else "idle" if became else "lit"


def _terms(vertex, event):
    """What stands behind f, as recorded, and as it would be with wo and wi along n."""
    terms, surface = {}, vertex.times(1)
    for name in TERMS:
        here = np.asarray(event.values.get(name, np.nan), float)
        if np.isfinite(here).all():
            terms[name] = here, surface.head_on(name)[: here.size].astype(float)
    return terms
