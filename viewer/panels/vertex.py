"""Vertex: the hemisphere over the surface that the reader stands at, and both ends of its ray to the ulp."""

import numpy as np

from viewer.caption import named
from viewer.numerals import short
from viewer.panels.panel import Panel
from viewer.traces import last_hit
from viewer.understanding import lens as lenses
from viewer.understanding import microscope
from viewer.understanding.draws import DRAWS, OFF, RINGS, SECTORS
from viewer.understanding.lens_words import NAMES, judged, lobes, tried, vector
from viewer.understanding.vertex import on_disc

SAME = 0.99999  # cosine between normals that are drawn as one
FAINT = 512  # of the bounces drawn anew, as dots

TEMPLATE = """
<div v-if="vertex" class="vertex" data-testid="vertex"><p v-if="!vertex.lens" class="dim">{{ vertex.none }}</p>
  <template v-else><div class="between"><p data-testid="vertex-at">{{ vertex.at }}</p>
      <button data-testid="lobes" :aria-pressed="vertex.lobes" :class="{now: vertex.lobes}" :title="w.lobes_help" @click="trigger('lobes')">{{ w.lobes }}</button></div>
    <castray-lens :lens="vertex.lens" :label="w.vertex_lens" @go="trigger('at', $event)"></castray-lens>
    <div class="drawn-bounces"><castray-cells :lens="vertex.lens" :label="vertex.verdict"></castray-cells><div><p v-if="vertex.drawn" class="dim">{{ vertex.drawn }}</p>
      <p :class="vertex.judged" data-testid="lens-verdict">{{ vertex.verdict }}</p><p v-for="lobe in vertex.counted" :key="lobe">{{ lobe }}</p></div></div>
    <ul class="dots" :aria-label="vertex.tried"><li v-for="k in ['bounce', 'lit', 'blocked', 'idle']" :key="k"><i :class="k"></i>{{ w['dot_' + k] }}</li></ul>
    <p class="dim" data-testid="lens-tried" :data-exact="JSON.stringify(vertex.tried_exact)">{{ vertex.tried }}</p>
    <table class="data"><tbody><tr v-for="v in vertex.vectors" :key="v.name" :data-testid="'vector-' + v.name" :data-exact="JSON.stringify(v.exact)">
      <th scope="row"><i class="swatch" :class="v.name"></i><castray-symbol :text="v.symbol"></castray-symbol></th><td class="number">{{ v.said }}</td></tr></tbody></table>
    <h2>{{ w.vertex_plane }}</h2><castray-plane :plane="vertex.plane" :label="w.vertex_plane_label"></castray-plane>
    <template v-if="vertex.terms.length"><h2>{{ w.vertex_facets }}</h2><table class="data"><thead><tr><th></th><th scope="col" class="side">{{ w.vertex_here }}</th><th scope="col" class="side">{{ w.vertex_head_on }}</th></tr></thead>
      <tbody><tr v-for="t in vertex.terms" :key="t.name" :data-testid="'term-' + t.name" :data-exact="JSON.stringify(t.exact)"><th scope="row" :title="t.meaning">{{ t.name }} <small>{{ t.meaning }}</small></th>
        <td class="number">{{ t.here }}</td><td class="number">{{ t.head_on }}</td></tr></tbody></table></template>
    <template v-if="vertex.ends"><h2>{{ w.vertex_microscope }}</h2><castray-ruler :ruler="vertex.ends.ruler" :label="w.vertex_ruler"></castray-ruler>
      <p data-testid="microscope-verdict">{{ vertex.ends.verdict }}</p>
      <table class="data ends-of-ray" data-testid="microscope" :data-exact="JSON.stringify(vertex.ends.exact)"><tbody><tr v-for="l in vertex.ends.lines" :key="l.name"><th scope="row">{{ l.label }}</th><td class="number">{{ l.said }}</td></tr></tbody></table></template>
  </template></div>
"""


def show(session, say):
    """The lens and the microscope at the event; no lens before the first surface."""
    lens = lenses.here(session)
    if lens is None:
        met = any(event.kind.name == "hit" for event in session.path.events)
        none = say("lens.not_yet" if met else "lens.never")
        return {"lens": None, "none": none, "lobes": bool(session.shelf.get(lenses.SHOWN))}
    scene = lens.vertex.scene
    hit = last_hit(session.path, session.cursor.event)
    names = {name: named(name, hit[name], scene) for name in ("shape", "bsdf")}
    return {
        "at": say("lens.at", **names),
        "lobes": bool(session.shelf.get(lenses.SHOWN)),
        "lens": _drawn(lens, say),
        "drawn": say("lens.counts", draws=DRAWS) if lens.counts else "",
        **judged(lens, say),
        "counted": lobes(lens, say),
        "tried": tried(lens, say),
        "tried_exact": [one.as_dict() for one in lens.tried],
        "vectors": [_vector(name, w, say) for name, w in lens.vectors.items()],
        "plane": _plane(lens),
        "terms": [_term(name, here, head_on, say) for name, (here, head_on) in lens.terms.items()],
        "ends": _ends(session, scene, say),
    }


def _drawn(lens, say):
    """What the discs show: sheets as bytes 0 to 255 by the root of their share of the largest value."""
    discs = []
    for side, sheets in zip(lens.sides, lens.sheets, strict=True):
        rows = {"sheets": []}
        where = say("lens.above" if side > 0 else "lens.below") if len(lens.sides) > 1 else ""
        for name, sheet in zip("fp", sheets, strict=True):
            most = float(np.nanmax(sheet, initial=0.0))
            bytes_ = np.round(255 * np.sqrt(np.nan_to_num(sheet) / (most or 1.0))).astype(int)
            peak = lens.lobes.peak(name, side)  # which the disc's cells may miss
            title = say(f"lens.{name}", most=short(peak)) if peak else say(f"lens.{name}.dirac")
            rows["sheets"].append({"title": title + where, "values": bytes_.ravel().tolist()})
        here = lens.drawn[:, side * lens.drawn[2] > 0][:, :FAINT]
        rows["drawn"] = np.round(on_disc(here), 3).T.tolist()
        rows["off"] = [
            round(c.off, 2) for c in lens.counts if isinstance(c.where, tuple) and c.where[0] == side
        ]
        rows["marks"] = [_mark(name, w) for name, w in _apart(lens.vectors) if side * w[2] >= 0]
        rows["dots"] = [
            {"kind": one.kind, "place": list(one.place), "at": np.round(on_disc(one.shown), 3).tolist()}
            for one in lens.tried
            if side * one.shown[2] >= 0
        ]
        discs.append(rows)
    return {"discs": discs, "cells": [RINGS, SECTORS], "strange": OFF}


def _apart(vectors):
    """The vectors, ng only where it is not n."""
    return [(name, w) for name, w in vectors.items() if name != "ng" or w[2] < SAME]


def _mark(name, w):
    return {"name": name, "symbol": NAMES[name], "at": np.round(on_disc(w), 4).tolist()}


def _vector(name, w, say):
    return {"name": name, "symbol": NAMES[name], "said": vector(w, say), "exact": w.tolist()}


def _plane(lens):
    """Both curves over their largest values, and the vectors' shadows in the plane."""
    angles, *curves = lens.plane
    scaled = [np.round(curve / (curve.max() or 1.0), 4).tolist() for curve in curves]
    vectors = [
        {"name": n, "symbol": NAMES[n], "at": [float(w[0]), float(w[2])]}
        for n, w in _apart(lens.vectors)
        if np.isfinite(w).all()
    ]
    return {"angles": angles.tolist(), "curves": scaled, "vectors": vectors, "up": lens.sides[0]}


def _term(name, here, head_on, say):
    exact = {"here": np.ravel(here).tolist(), "head_on": head_on.tolist()}
    return {
        "name": name,
        "meaning": say(f"term.{name}"),
        "here": _below(here),
        "head_on": _below(head_on),
        "exact": exact,
    }


def _below(values):
    """A number, or those of a colour one below another."""
    return "\n".join(short(v) for v in np.ravel(values))


def _ends(session, scene, say):
    there = microscope.ends(scene, session.record, session.cursor.path, session.cursor.event)
    if there is None:
        return None
    lines = [
        {"name": n, "label": say(f"microscope.{n}"), "said": said}
        for n, said in microscope.lines(there, scene, say)
    ]
    return {
        "lines": lines,
        "verdict": microscope.verdict(there, say),
        "ruler": microscope.ruler(there),
        "exact": there.as_dict(scene),
    }


def calls(window):
    """What the panel may ask for."""

    def shown(*_):
        """Show the hemisphere in 3D, or no longer."""
        shelf = window.session.shelf
        shelf[lenses.SHOWN] = not shelf.get(lenses.SHOWN)
        window.refresh("event")

    return {"lobes": shown}


PANEL = Panel("vertex", "tab", "event", 37, TEMPLATE, show, calls, lazy=True)
