"""What a query sees of a recording: the views `events` and `paths` as SQL, macros for vectors and colours.

Both follow from events.py. `events` has all kinds in one, NULL where a field is absent.
"""

from tracer.events import HIT, KINDS, LIGHT
from tracer.trace import columns, parquet

MACROS = {
    "dot(a, b)": "a.x * b.x + a.y * b.y + a.z * b.z",
    "length(a)": "sqrt(a.x * a.x + a.y * a.y + a.z * a.z)",
    "luminance(c)": "0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b",
    "largest(c)": "greatest(c.r, c.g, c.b)",
    "smallest(c)": "least(c.r, c.g, c.b)",
    "no_number(c)": "isnan(c.r) OR isnan(c.g) OR isnan(c.b)",
}
OWN = {
    "kind": "kind of event",
    "pixel": "the pixel, as pixel.x and pixel.y",
    "x": "column of the pixel, 0 at the left",
    "y": "row of the pixel, 0 at the top",
    "sample": "number of the sample in its pixel",
    "path": "number of the path: pixel * spp + sample",
    "step": "place in the path, counting from 0",
    "depth": "bounces before it",
    "previous": "kind of the event before it",
}
PATHS = {
    "pixel": OWN["pixel"],
    "x": OWN["x"],
    "y": OWN["y"],
    "sample": OWN["sample"],
    "path": OWN["path"],
    "film": "where on the film, in pixels from the top left",
    "radiance": "what the path brings to its pixel",
    "vertices": "surfaces it met",
    "reason": "why it ended",
}
# Derived fields that SQL can work out itself.
FORMULAS = {
    (HIT.name, "cos_wo"): "n_x * wo_x + n_y * wo_y + n_z * wo_z",
    (LIGHT.name, "cos_light"): "-(nq_x * wi_x + nq_y * wi_y + nq_z * wi_z)",
    (LIGHT.name, "pdf_area"): "CASE WHEN primitive < 0 THEN 0 ELSE pdf / pick / (distance * distance)"
    " * greatest(-(nq_x * wi_x + nq_y * wi_y + nq_z * wi_z), 0) END",
}
_NAMED = ("shape", "bsdf", "light")


def fields():
    """{column of `events`: (component names, {kind: Field})}, in the order of events.py."""
    found = {}
    for kind in KINDS:
        there = (*columns.stored(kind), *(f for f in kind.fields if (kind.name, f.name) in FORMULAS))
        for field in (f for f in kind.fields if f in there):
            names, kinds = found.setdefault(field.name, ((), {}))
            kinds[kind.name] = field
            found[field.name] = (max(names, columns.axes_of(field), key=len), kinds)
    for kind in KINDS:
        for field in columns.carried_along(kind):
            found[field.name][1].setdefault(kind.name, field)
    return found


def names(level):
    """The columns that a bare condition may use at a level, in order."""
    return [*OWN, *fields()] if level == "events" else list(PATHS)


def statements(place):
    """The SQL that makes macros and views of a Folder."""
    for head, body in MACROS.items():
        yield f"CREATE MACRO {head} AS ({body})"
    yield f"CREATE VIEW paths AS {_paths(place)}"
    if place.kinds:
        number = "FLOAT" if place.settings.precision == 32 else "DOUBLE"
        branches = [_branch(kind, place, number) for kind in KINDS]
        yield f"CREATE VIEW events AS {' UNION ALL '.join(branches)}"


def _paths(place):
    reason = _name_of("reason", place.header["names"]["reason"])
    number = f"(y::BIGINT * {place.settings.width} + x) * {place.settings.spp} + sample"
    selected = (
        f"{_struct('pixel', ('x', 'y'), ('x', 'y'))}, x, y, sample, {number} AS path, "
        f"{_vector('film', ('x', 'y'))}, {_vector('radiance', ('r', 'g', 'b'))}, vertices, {reason} AS reason"
    )
    return f"SELECT {selected} FROM {parquet.source(place.files('paths'))}"


def _branch(kind, place, number):
    """The events of a kind, with every column of the view."""
    known = place.header["names"]
    selected = [
        f"{parquet.literal(kind.name)} AS kind",
        _struct("pixel", ("x", "y"), ("x", "y")),
        *("x", "y", "sample", "path", "step", "depth"),
        f"{_name_of('previous', known['kind'])} AS previous",
    ]
    for name, (axes, kinds) in fields().items():
        selected.append(_column(name, axes, kinds.get(kind.name), kind, known, number))
    return f"SELECT {', '.join(selected)} FROM {parquet.source(place.files(kind.name))}"


def _column(name, axes, field, kind, known, number):
    """One column of a branch; field: None where the kind has none of that name."""
    quoted = parquet.quoted(name)
    if field is None:
        return f"NULL::{_type(name, axes, number)} AS {quoted}"
    if (kind.name, name) in FORMULAS:
        return f"({FORMULAS[kind.name, name]})::{number} AS {quoted}"
    if field.domain in _NAMED or field.domain == "choice":
        table = known[field.domain if field.domain in _NAMED else name]
        return f"{_name_of(name, table)} AS {quoted}"
    if axes and not field.shape:  # a number where other kinds have several
        return _struct(name, axes, (f"{quoted}::{number}", *(f"NULL::{number}" for _ in axes[1:])))
    return _vector(name, axes) if axes else quoted


def _type(name, axes, number):
    if axes:
        return f"STRUCT({', '.join(f'{axis} {number}' for axis in axes)})"
    field = next(iter(fields()[name][1].values()))
    if field.domain in _NAMED or field.domain == "choice":
        return "VARCHAR"
    return {"flag": "BOOLEAN", "index": "INTEGER"}.get(field.domain, number)


def _vector(name, axes):
    return _struct(name, axes, [parquet.quoted(f"{name}_{axis}") for axis in axes])


def _struct(name, axes, parts):
    made = ", ".join(f"{axis} := {part}" for axis, part in zip(axes, parts, strict=True))
    return f"struct_pack({made}) AS {parquet.quoted(name)}"


def _name_of(column, names):
    """The name that stands for a number, NULL for -1."""
    listed = ", ".join(map(parquet.literal, names)) or "NULL"
    return f"([{listed}])[{parquet.quoted(column)}::INTEGER + 1]"


def schema(tell=lambda key, text: text):
    """The page that documents a recording, generated. tell(key, text): the text in another language."""
    kinds = [(kind, dict(_lines(kind, tell))) for kind in KINDS]
    paths, own = (
        {name: tell(f"view.{name}", text) for name, text in table.items()} for table in (PATHS, OWN)
    )
    width = 2 + max(
        len(name) for table in (paths, own, MACROS, *(lines for _, lines in kinds)) for name in table
    )

    def listed(head, lines):
        return "\n".join([head, *(f"  {name:<{width}}{meaning}" for name, meaning in lines.items())])

    heads = {
        "paths": "view paths: a row for each path",
        "events": "view events: a row for each event; every event has",
        "macros": "macros",
    }
    said = {name: tell(f"view.{name}_head", text) for name, text in heads.items()}
    meanings = {kind.name: tell(f"event.{kind.name}", kind.meaning) for kind in KINDS}
    of_kinds = [listed(f"kind {kind.name}: {meanings[kind.name]}", lines) for kind, lines in kinds]
    parts = [
        listed(said["paths"], paths),
        listed(said["events"], own),
        *of_kinds,
        listed(said["macros"], MACROS),
    ]
    return "\n\n".join([tell("view.format", _FORMAT), *parts])


def _lines(kind, tell):
    """(name, meaning) of each field that the view has of a kind."""
    for name, (_, kinds) in fields().items():
        field = kinds.get(kind.name)
        if field is None:
            continue
        axes = columns.axes_of(field)
        shown = f"{name}.{'.'.join(axes)}" if axes else name
        own = any(f.name == name for f in kind.fields)
        unit = f" [{field.unit}]" if field.unit else ""
        meaning = tell(f"field.{(kind if own else HIT).name}.{name}", field.meaning)
        if not own:
            meaning = f"{tell('view.of_vertex', 'of the vertex:')} {meaning}"
        yield shown, f"{meaning}{unit} ({tell(f'domain.{field.domain}', field.domain)})"


_FORMAT = """A recording is a folder:

  recording.json    level (paths or events), settings, fingerprint, parts, the names that numbers stand for
  scene.json        what the scene was made from, in castray's words; files/ has its meshes and pictures
  part-00000/       paths.parquet, and at level events a file for each kind of event: hit.parquet, ...
  *.partial         unfinished; the same castray render --record goes on

In the files a vector p is the columns p_x, p_y, p_z, a colour beta beta_r, beta_g, beta_b, and what has a
name is its number in recording.json, counting from 0, -1 for none. The views have p.x, beta.r and names."""
