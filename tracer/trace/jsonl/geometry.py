"""Which surface of the scene a logged point lies on, and what the surface is there."""

from itertools import product

import numpy as np

LANES = 1 << 16  # rays that are asked for at once
NEAR = 1e-3  # share of the scene's size by which a logged point may be off its surface
SLACK = 1e-5  # the same of rounding alone
FEW = 0.02, 64  # share and number of points at edges at most: more that lie on nothing are elsewhere
WAYS = np.concatenate((np.eye(3), -np.eye(3)))  # (6, 3), along the axes and back


def scale(scene):
    """Largest extent of the scene."""
    low, high = scene.bounds()
    return float((high - low).max())


def met(scene, o, d):
    """(t (N,), primitive (N,)) of the nearest hits of rays; inf and -1 where there is none."""
    t, primitive = np.full(o.shape[1], np.inf), np.full(o.shape[1], -1)
    with np.errstate(all="ignore"):
        for begin in range(0, o.shape[1], LANES):
            some = slice(begin, begin + LANES)
            none = np.full(o[0, some].shape, -1, np.int32)
            t[some], primitive[some] = scene.intersect(o[:, some], d[:, some], none)
    return t, primitive


def onward(scene, o, d):
    """As met, for rays from logged points: what lies within rounding of the start is the surface that they
    leave, and is given as a third, -1 for none."""
    t, primitive = met(scene, o, d)
    left = np.full(t.shape, -1)
    again = np.flatnonzero(t < 1e-4 * scale(scene))
    if again.size:
        ahead = t[again] + 1e-6 * scale(scene)
        left[again] = primitive[again]
        far, other = met(scene, o[:, again] + ahead * d[:, again], d[:, again])
        t[again], primitive[again] = ahead + far, other
    return t, primitive, left


def primitives_at(scene, o, d, p):
    """Primitive (N,) that points p (3, N), come to along rays, lie on; -1 where there is none nearby.

    First whatever lies nearest to p along its own ray, looked for from both sides, since where two surfaces
    nearly touch each hides the other; where nothing does, along other ways to p, and just beside it.
    """
    reach = NEAR * scale(scene)
    found, off = np.full(p.shape[1], -1), np.full(p.shape[1], reach)
    for way in (d, -d):
        _nearer(scene, p, way, reach, found, off, np.arange(p.shape[1]))
    for way in WAYS:
        rest = np.flatnonzero(found < 0)
        if not rest.size:
            break
        _nearer(scene, p, np.broadcast_to(way[:, None], p.shape), reach, found, off, rest)
    rest = np.flatnonzero(found < 0)
    if 0 < rest.size <= max(FEW[0] * found.size, FEW[1]):
        found[rest] = _beside(scene, p[:, rest], reach)
    return found


def _beside(scene, p, reach):
    """Primitives (N,) that end at points p (3, N), which rounding has put beside them; -1 for none."""
    found = np.full(p.shape[1], -1)
    for aside, way in product(SLACK * scale(scene) * WAYS, WAYS):
        rest = np.flatnonzero(found < 0)
        there, off = found[rest], np.full(rest.size, reach)
        start = p[:, rest] + aside[:, None]
        _nearer(
            scene, start, np.broadcast_to(way[:, None], start.shape), reach, there, off, np.arange(rest.size)
        )
        found[rest] = there
    return found


def _nearer(scene, p, d, reach, found, off, lanes):
    """Look for surfaces within reach of p, before and behind it along d; keep the nearest."""
    start = p[:, lanes] - reach * d[:, lanes]
    t, primitive = met(scene, start, d[:, lanes])
    away = np.abs(t - reach)
    better = (primitive >= 0) & (away < off[lanes])
    found[lanes[better]], off[lanes[better]] = primitive[better], away[better]


def at_edges(scene, p, n, d, primitive, lanes):
    """Where the logged normal n (3, N) is not that of the primitive (N,) found at p, look for one that has it
    and is as near, and write its number: near an edge rounding decides which of two faces a ray meets first.

    What lies beyond the edge by its rounding is looked for from this side of the face that was found.
    """
    ng, _ = surfaces(scene, p[:, lanes], d[:, lanes], primitive[lanes])
    wrong = ~(np.abs((ng * n[:, lanes]).sum(axis=0)) > 0.9999)
    odd, ng = lanes[wrong], np.nan_to_num(ng[:, wrong])
    off = np.where(ng.any(axis=0), _height(scene, p[:, odd], ng) + SLACK * scale(scene), NEAR * scale(scene))
    for share, side, beside in product((1e-3, 1e-4, 1e-5, 1e-6), (1.0, -1.0), (0.0, 2.0 * SLACK)):
        if not odd.size:
            return
        reach, way = share * scale(scene), -side * n[:, odd]
        start = p[:, odd] + beside * scale(scene) * ng
        t, other = met(scene, start - reach * way, way)
        there, _ = surfaces(scene, p[:, odd], way, np.where(np.abs(t - reach) <= off, other, -1))
        fits = np.abs((there * n[:, odd]).sum(axis=0)) > 0.9999
        primitive[odd[fits]] = other[fits]
        odd, ng, off = odd[~fits], ng[:, ~fits], off[~fits]


def _height(scene, p, ng):
    """How far points (3, N) are above surfaces with normals ng just below or above them, (N,); 0 for none."""
    reach = NEAR * scale(scene)
    t, _ = met(scene, p + reach * ng, -ng)
    return np.where(t < 2.0 * reach, np.abs(t - reach), 0.0)


def surfaces(scene, p, d, primitive):
    """(ng, n) of points on primitives that rays along d come to, (3, N) each; NaN where primitive is -1."""
    ng, n = np.full(p.shape, np.nan), np.full(p.shape, np.nan)
    there = np.flatnonzero(primitive >= 0)
    for begin in range(0, there.size, LANES):
        some = there[begin : begin + LANES]
        with np.errstate(all="ignore"):
            hit = scene.hit(p[:, some], d[:, some], np.zeros(some.size), primitive[some].astype(np.int32))
        ng[:, some], n[:, some] = hit.ng, hit.n
    return ng, n


def ask(scene, what, vertex, wi):
    """What the materials' `eval` (3, N) or `pdf` (N,) say at vertices: a dict of p, n, wo, primitive."""
    size = wi.shape[1]
    answer = np.full((3, size) if what == "eval" else size, np.nan)
    there = np.flatnonzero(vertex["primitive"] >= 0)
    for begin in range(0, there.size, LANES):
        some = there[begin : begin + LANES]
        p, n, wo, primitive = (vertex[name][..., some] for name in ("p", "n", "wo", "primitive"))
        with np.errstate(all="ignore"):
            frame = scene.frame(n, p, primitive)
            answer[..., some] = getattr(scene.bsdf, what)(
                scene.bsdf_of.take(primitive),
                frame.to_local(wo),
                frame.to_local(wi[:, some]),
                scene.painted(p, primitive),
            )
    return answer


def dark(scene, vertex):
    """Whether nothing is reflected at vertices towards where the path came from, (N,)."""
    size = vertex["primitive"].size
    answer = np.ones(size, bool)
    there = np.flatnonzero(vertex["primitive"] >= 0)
    for begin in range(0, there.size, LANES):
        some = there[begin : begin + LANES]
        p, n, wo, primitive = (vertex[name][..., some] for name in ("p", "n", "wo", "primitive"))
        with np.errstate(all="ignore"):
            local = scene.frame(n, p, primitive).to_local(wo)
            answer[some] = ~scene.bsdf.reflects(scene.bsdf_of.take(primitive), local)
    return answer
