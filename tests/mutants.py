"""Traces with one mistake in them: the broken twins of the doctor's rules."""

from dataclasses import replace

import numpy as np

import tracer
from tracer.trace import gather

# Which scenes, with which settings, have what a rule needs.
TRACES = {
    "room": ("cornell_unit", {}),
    "rooms": ("cornell_unit", {"integrator": "direct", "hemisphere": "uniform", "roulette": "0.8"}),
    "glass": ("coloured_glass", {}),
    "sky": ("sky", {}),
    "smooth": ("smooth_ball", {}),
    "lamps": ("many_lights", {}),
    "glossy": ("materials", {}),
}


def traced(name, **options):
    """The Trace of one of TRACES, small."""
    scene, settings = TRACES[name]
    small = {"width": 16, "height": 16, "spp": 4}
    return gather(tracer.load(scene), tracer.Settings(**small | settings | options))


def changed(trace, place, change, which=None):
    """The trace with a column "kind.field" changed: change(values) at some of its events."""
    kind, name = place.split(".")
    whole = trace.paths[name] if kind == "path" else trace.tables[kind].columns[name]
    new = np.array(whole)
    lanes = np.arange(new.shape[-1]) if which is None else np.flatnonzero(which)
    new[..., lanes] = change(whole[..., lanes])
    return with_column(trace, place, new)


def with_column(trace, place, new):
    """The trace with another column in the place of "kind.field"; None takes it out."""
    kind, name = place.split(".")
    if kind == "path":
        return replace(trace, paths=_put(trace.paths, name, new))
    table = trace.tables[kind]
    table = replace(table, columns=_put(table.columns, name, new))
    return replace(trace, tables=trace.tables | {kind: table})


def _put(columns, name, new):
    rest = {key: column for key, column in columns.items() if key != name}
    return rest if new is None else rest | {name: new}


def without_events(trace, kind, which):
    """The trace without some events (E,) of a kind."""
    return replace(trace, tables=trace.tables | {kind: trace.tables[kind].take(np.flatnonzero(~which))})


def deeper(trace):
    """The trace with each HIT's depth one too large."""
    table = trace.tables["hit"]
    return replace(trace, tables=trace.tables | {"hit": replace(table, depth=table.depth + 1)})


def on(trace, place, test=lambda column: column > 0):
    """At which events a column is so in all its components."""
    kind, name = place.split(".")
    column = test(trace.tables[kind][name])
    return column if column.ndim == 1 else column.all(axis=0)


def turned(w):
    """Vectors with their components in another order."""
    return w[[1, 2, 0]]


def _scaled(place, factor, some=None):
    def change(trace):
        which = None if some is None else some(trace)
        return changed(trace, place, lambda column: column * column.dtype.type(factor), which)

    return change


def _turned(place):
    return lambda trace: changed(trace, place, turned)


def _dirac(trace):
    return on(trace, "bounce.delta")


def _lit(trace):
    return on(trace, "hit.Le")


def _survivors(trace):
    return on(trace, "roulette.survived")


def _flag(place):
    return lambda trace: changed(trace, place, lambda column: ~column.astype(bool))


# rule: (trace, what is done to it). One number is changed, and nothing that is made of it.
MUTANTS = {
    "camera-pixel": ("room", lambda t: changed(t, "camera.film", lambda film: film + film.dtype.type(1.0))),
    "camera-ray": ("room", _turned("camera.d")),
    "camera-start": ("room", _scaled("camera.o", 1.01)),
    "unit-normal": ("room", _scaled("hit.n", 0.9)),
    "normal": ("room", _scaled("hit.ng", -1.0)),
    "shading-normal": ("smooth", lambda t: with_column(t, "hit.n", t.tables["hit"]["ng"])),
    "unit-light": ("room", _scaled("light.wi", 1.5)),
    "unit-direction": ("room", _scaled("bounce.wi", 1.001)),
    "chain": ("room", _turned("bounce.wi")),
    "escape-direction": ("sky", _turned("escape.d")),
    "own-surface": ("room", lambda t: _stuck(t)),
    "first-surface": ("room", lambda t: _behind(t)),
    "escape-free": ("room", lambda t: _fled(t)),
    "on-surface": ("room", lambda t: changed(t, "hit.p", lambda p: p * p.dtype.type(0.98))),
    "distance": ("room", _scaled("hit.t", 1.01)),
    "wo": ("room", _scaled("hit.wo", -1.0)),
    "side": ("room", _flag("hit.front")),
    "depth": ("room", deeper),
    "transmittance": ("glass", lambda t: changed(t, "hit.transmittance", np.ones_like)),
    "light-transmittance": ("glass", _scaled("light.transmittance", 0.9)),
    "emission": ("room", _scaled("hit.Le", 1.1)),
    "environment": ("sky", _scaled("escape.Le", 1.1)),
    "light-due": (
        "room",
        lambda t: without_events(t, "light", np.arange(t.tables["light"].path.size) % 7 == 0),
    ),
    "light-point": ("room", lambda t: changed(t, "light.q", lambda q: q + q.dtype.type(0.01))),
    "light-normal": ("room", _scaled("light.nq", -1.0)),
    "light-direction": ("room", _scaled("light.wi", -1.0)),
    "light-distance": ("room", _scaled("light.distance", 1.001)),
    "light-pick": ("lamps", lambda t: changed(t, "light.pick", np.ones_like)),
    "light-radiance": ("room", _scaled("light.Le", 0.5)),
    "light-pdf": ("room", _scaled("light.pdf", 1.001)),
    "light-f": ("room", _scaled("light.f", np.pi)),
    "light-cos": ("room", _scaled("light.cos", 0.999)),
    "light-pdf-bsdf": (
        "room",
        lambda t: changed(t, "light.pdf_bsdf", lambda pdf: np.full_like(pdf, 0.159155)),
    ),
    "light-visible": ("room", _flag("light.visible")),
    "bounce-side": ("room", _scaled("bounce.wi", -1.0)),
    "bounce-mirror": ("glass", lambda t: changed(t, "bounce.wi", turned, _dirac(t))),
    "bounce-mirror-f": ("glass", _scaled("bounce.f", 1.01, _dirac)),
    "bounce-mirror-pdf": ("glass", _scaled("bounce.pdf", 1.01, _dirac)),
    "bounce-f": ("room", _scaled("bounce.f", 1.001)),
    "bounce-cos": ("room", _scaled("bounce.cos", 0.999)),
    "bounce-pdf": ("room", _scaled("bounce.pdf", 1.001)),
    "pdf-of-last-bounce": ("room", _scaled("hit.pdf_bsdf", 1.001)),
    "pdf-of-light": ("room", _scaled("hit.pdf_light", 1.01, _lit)),
    "pdf-of-environment": ("sky", _scaled("escape.pdf_light", 1.01)),
    "emission-weight": ("rooms", lambda t: changed(t, "hit.w", np.ones_like)),
    "environment-weight": ("sky", _scaled("escape.w", 0.9)),
    "light-weight": ("room", _scaled("light.w", 0.99)),
    "roulette-probability": ("room", _scaled("roulette.probability", 0.5)),
    "roulette-played": ("rooms", lambda t: without_events(t, "roulette", _survivors(t))),
    "roulette-survival": ("room", _flag("roulette.survived")),
    "roulette-weight": ("room", _scaled("roulette.beta", 0.8)),
    "dead": ("room", _flag("roulette.survived")),
    "throughput": ("room", _scaled("bounce.beta", 1.001)),
    "throughput-on-arrival": ("room", _scaled("hit.beta", 1.001)),
    "bounce-before": ("room", _scaled("bounce.beta_before", 1.001)),
    "light-throughput": ("room", _scaled("light.beta", 1.001)),
    "emission-term": ("room", _scaled("hit.contribution", 1.001, _lit)),
    "environment-term": ("sky", _scaled("escape.contribution", 1.001)),
    "light-term": ("room", _scaled("light.contribution", 1.001)),
    "light-nothing": ("room", lambda t: changed(t, "light.contribution", lambda L: L + L.dtype.type(0.1))),
    "absorbed": ("room", lambda t: changed(t, "end.reason", lambda reason: np.full_like(reason, 1))),
    "end": ("room", lambda t: changed(t, "end.reason", lambda reason: np.full_like(reason, 3))),
    "ledger": ("room", lambda t: changed(t, "path.radiance", lambda L: L * L.dtype.type(1.001))),
    "domain": ("room", _scaled("light.contribution", -1.0)),
    "finite": ("room", lambda t: changed(t, "bounce.f", lambda f: f * f.dtype.type(np.nan))),
}


def _stuck(trace):
    """Vertices that are the ones before again."""
    hits = trace.tables["hit"]
    later = np.flatnonzero(hits.path[1:] == hits.path[:-1]) + 1
    for name in ("p", "primitive"):
        column = hits[name].copy()
        column[..., later] = hits[name][..., later - 1]
        trace = with_column(trace, f"hit.{name}", column)
    return trace


def _behind(trace):
    """The second vertices moved on along their rays, through the surface that they met."""
    hits = trace.tables["hit"]
    d = -hits["wo"]
    return with_column(trace, "hit.p", hits["p"] + d * hits["p"].dtype.type(0.5))


def _fled(trace):
    """Paths that are said to escape where they go on in the room."""
    bounces = trace.tables["bounce"]
    escape = trace.tables["escape"]
    n = bounces.path.size
    none = {name: np.zeros((*column.shape[:-1], n), np.float32) for name, column in escape.columns.items()}
    table = replace(bounces, step=bounces.step + 1, columns=none | {"d": bounces["wi"]})
    return replace(trace, tables=trace.tables | {"escape": table})
