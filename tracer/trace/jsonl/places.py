"""Where calls met the surfaces of the scene."""

from dataclasses import dataclass

import numpy as np

from tracer.frame import normalize
from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.calls import Chain

_FEW = 0.05  # share of the paths that may be left out without hiding what the program does


@dataclass
class Places:
    """Where each call's ray went. o, d: (3, N) its ray; hit: (N,) whether it met a surface, there: p, wo, n,
    ng (3, N), primitive (N,); through: (N,) whether it passed the back of a surface of the
    scene; unclear: (N,) whether it is not known what it met."""

    o: np.ndarray
    d: np.ndarray
    hit: np.ndarray
    p: np.ndarray
    wo: np.ndarray
    n: np.ndarray
    ng: np.ndarray
    primitive: np.ndarray
    through: np.ndarray
    unclear: np.ndarray

    def vertex(self, rows):
        """What materials are asked with, of some calls."""
        return {name: getattr(self, name)[..., rows] for name in ("p", "n", "wo", "primitive")}


def placed(chain, scene):
    """The Places of calls in a scene (of 64 bits): as logged, or where the scene says."""
    p, logged = chain("hit.p"), chain.given("hit.p")
    o, d = _rays(chain, scene, p, logged)
    t, primitive, left = geometry.onward(scene, o, d)
    first, met_first = t.copy(), primitive.copy()
    unclear = np.zeros(t.shape, bool)
    if not logged.any():
        p = o + np.where(np.isfinite(t), t, 0.0) * d
        hit = np.isfinite(t)
        p, asked = _where_next_begins(chain, scene, o, d, p, primitive)
        hit[asked] = unclear[asked] = True
    else:
        lamps = _lamps_left_early(chain, scene, o, d, t, primitive)
        p[:, lamps] = o[:, lamps] + t[lamps] * d[:, lamps]
        hit = logged | np.isin(np.arange(t.size), lamps)
        near = geometry.NEAR * geometry.scale(scene)
        gap = np.sqrt(((o + np.where(np.isfinite(t), t, 0.0) * d - p) ** 2).sum(axis=0))
        asked = np.flatnonzero(hit & ~(gap <= 0.01 * near))
    if asked.size:
        primitive[asked] = geometry.primitives_at(scene, o[:, asked], d[:, asked], p[:, asked])
    if chain.given("hit.primitive").any():
        own = chain.given("hit.primitive")
        primitive = np.where(own, chain.columns.values["hit.primitive"], primitive)
    primitive = np.where(hit, primitive, -1)
    if chain.given("hit.n").any():
        geometry.at_edges(scene, p, chain("hit.n"), d, primitive, np.flatnonzero(chain.given("hit.n") & hit))
    if not logged.any():
        unclear |= ~hit & ~chain.last
        unclear[1:] |= hit[1:] & (primitive[1:] == primitive[:-1]) & (chain.level[1:] > 0)
        unclear[1:] |= (left[1:] >= 0) & (left[1:] != primitive[:-1]) & (chain.level[1:] > 0)
    ng, n = geometry.surfaces(scene, p, d, primitive)
    wo = -d
    for name, mine in (("hit.wo", wo), ("hit.n", n), ("hit.ng", ng)):
        if chain.given(name).any():
            np.copyto(mine, chain(name), where=chain.given(name))
    if chain.given("hit.n").any():  # of a mesh's face that the scene does not know, the logged one
        np.copyto(ng, n, where=np.isnan(ng))
    through = _through(scene, o, d, np.where(hit, p, np.inf), first, met_first)
    return Places(o, d, hit, p, wo, n, ng, primitive, through, unclear)


def _lamps_left_early(chain, scene, o, d, t, primitive):
    """Rows of calls that return before they say what they met, where the scene has the bright side of a lamp:
    many programs look at that first."""
    rows = np.flatnonzero(~chain.given("hit.p") & chain.last & np.isfinite(t))
    rows = rows[scene.light_of.take(primitive[rows]) >= 0]
    ng, _ = geometry.surfaces(scene, o[:, rows] + t[rows] * d[:, rows], d[:, rows], primitive[rows])
    rows = rows[(ng * d[:, rows]).sum(axis=0) < 0.0]
    if rows.size:
        chain.notes.append(
            f"{rows.size} calls do not say what they met, where there is a lamp: it is taken for met"
        )
    return rows


def put_somewhere(places, scene):
    """Vertices on no surface get the one that their ray meets: the laws say that they do not lie on it."""
    lost = np.flatnonzero(places.hit & (places.primitive < 0))
    o, d = places.o[:, lost], places.d[:, lost]
    _, primitive, _ = geometry.onward(scene, o, d)
    places.primitive[lost] = np.maximum(primitive, 0)
    ng, n = geometry.surfaces(scene, places.p[:, lost], d, places.primitive[lost])
    for mine, there in ((places.ng, ng), (places.n, n)):
        mine[:, lost] = np.where(np.isnan(mine[:, lost]), there, mine[:, lost])


def _where_next_begins(chain, scene, o, d, p, primitive):
    """(points (3, N), rows at which it is not known what they lie on): where rays alone were logged a vertex
    is where the next ray begins, put onto the surface that the scene has there."""
    ng, _ = geometry.surfaces(scene, p, d, primitive)
    shift = np.where(chain.last, 0.0, np.roll(o, -1, axis=1) - p)
    size = np.sqrt((shift * shift).sum(axis=0))
    shift = shift - np.where(np.isfinite(ng), (shift * ng).sum(axis=0) * ng, 0.0)
    elsewhere = ~chain.last & ~(size <= geometry.NEAR * geometry.scale(scene))
    aside = np.sqrt((shift * shift).sum(axis=0)) > 1e-5 * geometry.scale(scene)
    moved = np.where(elsewhere, np.roll(o, -1, axis=1), p + np.where(np.isfinite(shift), shift, 0.0))
    return moved, np.flatnonzero(elsewhere | (aside & ~chain.last))


def _through(scene, o, d, p, t, primitive):
    """Whether rays to p go through a surface that the scene has nearer by, from behind, (N,)."""
    gap = np.where(
        np.isfinite(p[0]), np.sqrt(((np.where(np.isfinite(p), p, 0.0) - o) ** 2).sum(axis=0)), np.inf
    )
    size = geometry.scale(scene)
    nearer = (primitive >= 0) & (t < gap - geometry.NEAR * size) & (t > 1e-5 * size)
    found = np.zeros(t.shape, bool)
    some = np.flatnonzero(nearer)
    ng, _ = geometry.surfaces(scene, o[:, some] + t[some] * d[:, some], d[:, some], primitive[some])
    found[some] = (ng * d[:, some]).sum(axis=0) > 0.0
    return found


def culled(chain, places):
    """Chain and Places without the paths that go through the back of a surface, which here have two sides,
    and without those that pass so near an edge that rays alone do not say what they met."""
    size = int(chain.path.max(initial=-1)) + 1
    out = np.zeros(size, bool)
    notes = list(chain.notes)
    for rows, most, why in (
        (places.through, 1.0, "go through the back of a surface, which the scene closes"),
        (places.unclear, _FEW, "pass so near an edge that rays alone do not say which face they met"),
    ):
        here = np.zeros(size, bool)
        here[chain.path[rows]] = True
        if here.any() and here.mean() < most:
            out |= here
            notes.append(f"{np.count_nonzero(here)} paths {why}: left out")
    if not out.any() or out.all():
        return chain, places
    keep = ~out[chain.path]
    path = (np.cumsum(~out) - 1)[chain.path[keep]]
    kept = Chain(
        chain.columns.take(keep), path, chain.level[keep], chain.last[keep], notes, int(np.count_nonzero(out))
    )
    return kept, Places(*(column[..., keep] for column in vars(places).values()))


def _rays(chain, scene, p, logged):
    """Origins and directions (3, N) of the calls' rays: as logged, else from vertex to vertex."""
    size = chain.path.size
    o, d = (np.full((3, size), np.nan) for _ in range(2))
    root = chain.level == 0
    if p is not None:
        o[:, 1:] = p[:, :-1]
    o[:, root] = scene.camera.origin[:, None]
    wi = chain("bounce.wi")
    if wi is not None:
        d[:, 1:] = wi[:, :-1]
        d[:, root] = np.nan
    if p is not None:
        with np.errstate(all="ignore"):
            straight = normalize(p - o)
        unknown = np.isnan(d).any(axis=0)
        d[:, unknown] = straight[:, unknown]
    for name, mine in (("ray.o", o), ("ray.d", d)):
        if chain.given(name).any():
            np.copyto(mine, chain(name), where=chain.given(name))
    return o, d
