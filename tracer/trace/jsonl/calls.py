"""Calls of a recursive function, one after the other along each path.

What the function did between two calls is not seen, so where a path ends is worked out: at a black surface,
outside, by roulette, or at a lamp that was looked for before calling again.
"""

from dataclasses import dataclass

import numpy as np

from tracer.frame import normalize
from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.lines import Columns


@dataclass
class Chain:
    """Calls in the order of path and nesting. path: (N,) row of its path; level: (N,) how deep it is nested;
    last: (N,) whether its path has no further call; notes: what was left out, in words."""

    columns: Columns
    path: np.ndarray
    level: np.ndarray
    last: np.ndarray
    notes: list

    def __call__(self, name):
        """A column (..., N) in float64, NaN where not given."""
        column = self.columns.values.get(name)
        return None if column is None else column.astype(np.float64)

    def given(self, name):
        """Whether each call has a field, (N,)."""
        none = np.zeros(self.path.size, bool)
        return self.columns.given.get(name, none)

    def any(self, name):
        """Whether each call has any field that begins so, (N,)."""
        found = np.zeros(self.path.size, bool)
        for key, mask in self.columns.given.items():
            if key.startswith(name):
                found |= mask
        return found


def path_numbers(columns):
    """Row of its path (N,) of each line, and the line (P,) at which each path begins."""
    values, given = columns.values, columns.given
    if "path" in given and given["path"].all():
        keys = values["path"]
    elif all(name in given and given[name].all() for name in ("x", "y")):
        sample = values["sample"] if "sample" in given else np.zeros(columns.size, np.int64)
        keys = (values["y"] * 65536 + values["x"]) * (int(sample.max()) + 1) + sample
    else:
        keys = np.zeros(columns.size, np.int64)
    _, first, rows = np.unique(keys, return_index=True, return_inverse=True)
    return rows, first


def chained(columns):
    """The Chain of calls in any order. Left out and told of: paths whose first call is not there, and all but
    the first of several calls from one."""
    rows, _ = path_numbers(columns)
    notes, size = [], columns.size
    call, parent = _numbered(columns, rows)
    order = np.lexsort((call, rows))
    columns, rows, call, parent = columns.take(order), rows[order], call[order], parent[order]
    most = int(call.max()) + 2
    keys = rows * most + call
    above = np.searchsorted(keys, rows * most + parent)
    above = np.where(parent < 0, -1, np.minimum(above, size - 1))
    lost = (parent >= 0) & ((keys[above] != rows * most + parent) | (parent >= call))
    again = np.zeros(size, bool)
    again[1:] = (keys[1:] == keys[:-1]) | ((parent[1:] < 0) & (rows[1:] == rows[:-1]))
    above[lost | again] = -2
    level = _levels(above)
    keep = level >= 0
    first_child = np.zeros(size, bool)
    inner = np.flatnonzero(keep & (above >= 0))
    _, where = np.unique(above[inner], return_index=True)
    first_child[inner[where]] = True
    beside = int(inner.size - where.size)
    while True:  # what hangs on a call that is left out is left out
        fine = keep & ((above < 0) | first_child)
        fine &= np.where(above >= 0, fine[np.maximum(above, 0)], fine)
        if np.array_equal(fine, keep):
            break
        keep = fine
    if beside:
        notes.append(
            f"{beside} calls are the second one from the same call: castRay calls itself more than once; "
            "only the first is followed"
        )
    cut = np.unique(rows[level < 0]).size
    if cut:
        notes.append(f"{cut} paths lack a call, or have one twice: these calls are left out")
    columns, rows, level = columns.take(keep), rows[keep], level[keep]
    order = np.lexsort((level, rows))
    columns, rows, level = columns.take(order), rows[order], level[order]
    _, rows = np.unique(rows, return_inverse=True)
    last = np.ones(rows.size, bool)
    last[:-1] = rows[1:] != rows[:-1]
    return Chain(columns, rows, level, last, notes)


def _numbered(columns, rows):
    """(call, parent) of each line, (N,); where they are not given, by depth."""
    values, given = columns.values, columns.given
    if "call" in given and given["call"].all() and "parent" in given and given["parent"].all():
        return values["call"], values["parent"]
    depth = values.get("depth", np.zeros(columns.size, np.int64))
    order = np.lexsort((depth, rows))
    begins = np.flatnonzero(np.r_[True, rows[order][1:] != rows[order][:-1]]) if rows.size else rows
    place = np.arange(rows.size) - np.repeat(begins, np.diff(np.r_[begins, rows.size]))
    call = np.empty(rows.size, np.int64)
    call[order] = place
    return call, call - 1


def _levels(above):
    """How deep each call is nested, (N,); -1 for those that hang on nothing. above: (N,) row of the call
    that called it, -1 for none, -2 unknown."""
    level = np.where(above == -1, 0, -1)
    active = np.flatnonzero(above >= 0)
    while active.size:
        of = level[above[active]]
        known = of >= 0
        if not known.any():
            break
        level[active[known]] = of[known] + 1
        active = active[~known]
    return level


@dataclass
class Places:
    """Where each call's ray went. o, d: (3, N) its ray; hit: (N,) whether it met a surface, there: p, wo, n,
    ng (3, N), primitive (N,); through: (N,) whether it passed the back of a surface of the scene."""

    o: np.ndarray
    d: np.ndarray
    hit: np.ndarray
    p: np.ndarray
    wo: np.ndarray
    n: np.ndarray
    ng: np.ndarray
    primitive: np.ndarray
    through: np.ndarray

    def vertex(self, rows):
        """What materials are asked with, of some calls."""
        return {name: getattr(self, name)[..., rows] for name in ("p", "n", "wo", "primitive")}


def placed(chain, scene):
    """The Places of calls in a scene (of 64 bits): as logged, or where the scene says."""
    p, logged = chain("hit.p"), chain.given("hit.p")
    o, d = _rays(chain, scene, p, logged)
    t, primitive = geometry.onward(scene, o, d)
    first, met_first = t.copy(), primitive.copy()
    if not logged.any():
        p = o + np.where(np.isfinite(t), t, 0.0) * d
        hit = np.isfinite(t)
        p, asked = _where_next_begins(chain, scene, o, d, p, primitive)
        hit[asked] = True
    else:
        hit = logged
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
    ng, n = geometry.surfaces(scene, p, d, primitive)
    wo = -d
    for name, mine in (("hit.wo", wo), ("hit.n", n), ("hit.ng", ng)):
        if chain.given(name).any():
            np.copyto(mine, chain(name), where=chain.given(name))
    if chain.given("hit.n").any():  # of a mesh's face that the scene does not know, the logged one
        np.copyto(ng, n, where=np.isnan(ng))
    return Places(
        o, d, hit, p, wo, n, ng, primitive, _through(scene, o, d, np.where(hit, p, np.inf), first, met_first)
    )


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
    """Chain and Places without the paths that go through the back of a surface: here they have two sides."""
    out = np.zeros(int(chain.path.max(initial=-1)) + 1, bool)
    out[chain.path[places.through]] = True
    if not out.any() or out.all():
        return chain, places
    keep = ~out[chain.path]
    path = (np.cumsum(~out) - 1)[chain.path[keep]]
    note = f"{np.count_nonzero(out)} paths go through the back of a surface, which the scene closes: left out"
    kept = Chain(chain.columns.take(keep), path, chain.level[keep], chain.last[keep], [*chain.notes, note])
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
