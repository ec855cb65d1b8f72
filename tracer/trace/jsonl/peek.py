"""Programs that look at what they meet next before they call themselves again."""

from dataclasses import replace

import numpy as np

from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.content import Columns
from tracer.trace.jsonl.places import Places


def peeked(chain, places, scene):
    """Chain and Places with a call more where a path went on towards a lamp, or out of the scene, and the
    program looked there before it called itself again: that call would have returned nothing."""
    at = np.flatnonzero(chain.last & places.hit & chain.given("bounce.wi") & _survived(chain))
    if not at.size:
        return chain, places
    wi = chain("bounce.wi")[:, at]
    o = places.p[:, at]
    t, primitive, _ = geometry.onward(scene, o, wi)
    out = primitive < 0
    lamp = ~out & (scene.light_of.take(np.maximum(primitive, 0)) >= 0)
    fits = out | lamp
    if fits.mean() < 0.9:  # then they end for another reason
        return chain, places
    out |= ~lamp  # by the program's own account nothing was met there
    p = o + np.where(out, 0.0, t) * wi
    primitive = np.where(out, -1, primitive)
    ng, n = geometry.surfaces(scene, p, wi, primitive)
    no = np.zeros(at.size, bool)
    more = Places(places.p[:, at], wi, ~out, p, -wi, n, ng, primitive, no, no)
    path, level = np.r_[chain.path, chain.path[at]], np.r_[chain.level, chain.level[at] + 1]
    order = np.lexsort((level, path))
    columns = _longer(chain.columns, at).take(order)
    path, level = path[order], level[order]
    last = np.ones(path.size, bool)
    last[:-1] = path[1:] != path[:-1]
    joined = Places(*(np.concatenate(pair, axis=-1)[..., order] for pair in zip(
        vars(places).values(), vars(more).values(), strict=True)))  # fmt: skip
    note = f"{at.size} paths look at what they meet next without a call: taken as calls that return nothing"
    return replace(
        chain, columns=columns, path=path, level=level, last=last, notes=[*chain.notes, note]
    ), joined


def _survived(chain):
    said = chain.given("roulette.survived")
    return (
        ~said | (chain.columns.values["roulette.survived"] == 1) if said.any() else np.ones(said.size, bool)
    )


def _longer(columns, at):
    """Columns with lines at the end that return nothing, in the place of those after lines `at`."""
    values, given = {}, {}
    for name, column in columns.values.items():
        more = np.zeros((*column.shape[:-1], at.size), column.dtype)
        kept = name in ("path", "x", "y", "sample")
        if kept:
            more = column[..., at]
        values[name] = np.concatenate((column, more), axis=-1)
        given[name] = np.r_[columns.given[name], columns.given[name][at] & (kept or name == "returned")]
    return Columns(np.r_[columns.line, columns.line[at]], values, given)
