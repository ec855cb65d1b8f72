"""Between the tables of a Trace and the flat columns of a Parquet file; both follow from events.py.

A vector `p` is three columns p_x, p_y, p_z, a colour `beta` beta_r, beta_g, beta_b. Every event says whose it
is: pixel x, y and sample, path (its number: pixel * spp + sample), step, depth and the kind of event before.
Events at a vertex carry what is known of that vertex, so that `dot(n, wi)` needs no second table.
"""

import numpy as np

from tracer.events import BOUNCE, END_REASONS, HIT, KINDS, LIGHT, LOBES, ROULETTE, TECHNIQUES
from tracer.trace.gather import type_of

OWN = ("path", "x", "y", "sample", "step", "depth", "previous")  # what every event has
OWN_TYPES = dict(zip(OWN, ("int64", "uint16", "uint16", "uint32", "int32", "int32", "int8"), strict=True))
# Fields that a recording has although they can be worked out: a query cannot ask the scene.
DERIVED = {HIT.name: ("shape", "bsdf"), LIGHT.name: ("blocker", "blocker_distance")}
AT_VERTEX = (LIGHT.name, BOUNCE.name, ROULETTE.name)  # kinds whose events carry their vertex
VERTEX = ("p", "ng", "n", "wo", "shape", "bsdf")  # ... namely this of it


def axes(name, shape, domain):
    """Names of a field's components: r, g, b of a colour, otherwise x, y, z; () of a number."""
    if not shape:
        return ()
    colour = shape == (3,) and domain in ("non-negative", "probability") and name != "u"
    return tuple("rgb" if colour else "xyz"[: shape[0]])


def axes_of(field):
    """The same for a Field."""
    return axes(field.name, field.shape, field.domain)


def stored(kind):
    """The fields of a kind that a recording has."""
    return tuple(f for f in kind.fields if f.carried or f.name in DERIVED.get(kind.name, ()))


def carried_along(kind):
    """The fields of a vertex that the events of this kind carry beside their own."""
    return tuple(f for f in HIT.fields if f.name in VERTEX) if kind.name in AT_VERTEX else ()


def names_of(scene):
    """{domain or field: names} of everything that a recording says by number."""
    return {
        "kind": [kind.name for kind in KINDS],
        "shape": [shape.name for shape in scene.shapes],
        "bsdf": list(scene.bsdf_names),
        "light": list(scene.light_names),
        "technique": list(TECHNIQUES),
        "lobe": list(LOBES),
        "reason": list(END_REASONS),
    }


def flat(name, column, names):
    """{name of a flat column: (E,)} of a column (..., E) with these component names."""
    if not names:
        return {name: column}
    return {f"{name}_{axis}": part for axis, part in zip(names, column, strict=True)}


def flat_names(field):
    """The names of a Field's flat columns."""
    return [f"{field.name}_{axis}" for axis in axes_of(field)] or [field.name]


def whole(name, columns, names):
    """The column (..., E) that was made flat."""
    if not names:
        return columns[name]
    return np.stack([columns[f"{name}_{axis}"] for axis in names])


def numbers(paths, settings):
    """The numbers (P,) of paths, of which x, y and sample are known."""
    pixel = paths["y"].astype(np.int64) * settings.width + paths["x"]
    return pixel * settings.spp + paths["sample"]


def of_paths(paths):
    """The flat columns of a Trace's `paths`."""
    return {
        "x": paths["x"].astype(np.uint16),
        "y": paths["y"].astype(np.uint16),
        "sample": paths["sample"].astype(np.uint32),
        **flat("film", paths["film"], "xy"),
        **flat("radiance", paths["radiance"], "rgb"),
        "vertices": paths["vertices"].astype(np.int32),
        "reason": paths["end"].astype(np.int8),
    }


def of_events(kind, trace, previous, own):
    """The flat columns of a Trace's events of a kind.

    previous: (E,) number of the kind before each; own: flat columns of the paths, and their numbers as path.
    """
    table = trace.tables[kind.name]
    columns = {name: own[name].take(table.path) for name in ("path", "x", "y", "sample")}
    columns |= {
        "step": table.step.astype(np.int32),
        "depth": table.depth.astype(np.int32),
        "previous": previous.astype(np.int8),
    }
    derived = blockers(trace) if kind is LIGHT else {}
    for field in stored(kind):
        column = derived[field.name] if field.name in derived else trace.column(kind.name, field.name)
        columns |= flat(field.name, _typed(column, field, trace), axes_of(field))
    if kind.name in AT_VERTEX:
        row = trace.hit_of(kind.name)
        for field in carried_along(kind):
            column = trace.column(HIT.name, field.name).take(row, axis=-1)
            columns |= flat(field.name, _typed(column, field, trace), axes_of(field))
    return columns


def _typed(column, field, trace):
    return column.astype(type_of(field, trace.scene.dtype), copy=False)


def blockers(trace):
    """What blocks each light sample, as the derived fields say, asked only where something may."""
    table, row = trace.tables[LIGHT.name], trace.hit_of(LIGHT.name)
    size = table.path.size
    found = {
        "blocker": np.full(size, -1, np.int32),
        "blocker_distance": np.full(size, np.inf, trace.scene.dtype),
    }
    asked = np.flatnonzero(
        ~table["visible"] & (table["f"].max(axis=0) > 0.0) & (table["Le"].max(axis=0) > 0.0)
    )
    if asked.size:
        names = ("p", "ng", "primitive")
        hits = {name: trace.tables[HIT.name][name].take(row[asked], axis=-1) for name in names}
        with np.errstate(all="ignore"):
            shape, distance = trace.scene.blocker(hits, table.take(asked).columns)
        found["blocker"][asked], found["blocker_distance"][asked] = shape, distance
    return found
