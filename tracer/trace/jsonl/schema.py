"""What a line of a log may hold, made from the one schema of events, and the page that says so."""

from unicodedata import east_asian_width

from tracer.event import Field
from tracer.events import BOUNCE, CAMERA, END, ESCAPE, HIT, KINDS, LIGHT, ROULETTE
from tracer.settings import Settings

VERSION = 1

# Whose path a line belongs to, and where in it.
PLACE = (
    Field("path", "number of the path; not needed where x, y and sample tell paths apart", (), "whole"),
    Field("x", "column of the pixel, 0 at the left", (), "pixel", "px"),
    Field("y", "row of the pixel, 0 at the top", (), "pixel", "px"),
    Field("sample", "which sample of the pixel, from 0", (), "whole"),
    Field("depth", "bounces before it: 0 at the first surface", (), "whole"),
)
FLAT = (Field("step", "place in the path, from 0; by default the order of the lines", (), "whole"),)
# What one call of a recursive function says beside the fields of its events.
CALL = (
    Field(
        "call", "number of the call within its path, in the order in which they begin, from 0", (), "whole"
    ),
    Field("parent", "number of the call that called it, -1 for none", (), "index"),
    Field("ray.o", "origin of the ray that the call was given", (3,), "point", "m"),
    Field("ray.d", "its direction", (3,), "unit vector"),
)
TERMS = (
    Field("emission", "what the call adds for the surface's own light", (3,), "real", "W/m²/sr"),
    Field("direct", "what it adds for the light sample", (3,), "real", "W/m²/sr"),
    Field("indirect", "what it adds for the bounce: factor times what the inner call returned", (3,), "real",
          "W/m²/sr"),
    Field("returned", "what it returns", (3,), "real", "W/m²/sr"),
)  # fmt: skip
OF_CALLS = (HIT, LIGHT, BOUNCE, ROULETTE)  # the events of one call

_TOLD = {
    "castray": f"version of this format: {VERSION} (needed)",
    "tracer": "name of the program",
    "digits": "significant digits that are printed (default: 9)",
    "bits": "32 or 64: of the program's own numbers (default: 32)",
    "unit": "length of one unit of the log in units of the scene, as a number, or mm, cm or m (default: 1)",
    "wi": 'outward or inward: whether the log\'s wi leave the surface or point into it (default: "outward")',
    "wo": 'the same for wo (default: "outward")',
    "n": '"surface": n as the surface has it; "flipped": turned; "facing": turned towards each ray '
    '(default: "surface")',
    "x": '"right" or "left": where x grows (default: "right"; "left" is a mirrored picture)',
    "y": '"down" or "up": where y grows (default: "down")',
}
CHOICES = {
    "bits": (32, 64),
    "wi": ("outward", "inward"),
    "wo": ("outward", "inward"),
    "n": ("surface", "flipped", "facing"),
    "x": ("right", "left"),
    "y": ("down", "up"),
}
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
OPTIONS = tuple(
    name for name in Settings.__dataclass_fields__ if name not in ("precision", "bug", "replicates", "accel")
)
HEADER = (*_TOLD, *OPTIONS)


def call_fields():
    """Name -> Field of a line that stands for one call: fields of events as "kind.field"."""
    fields = {f.name: f for f in (*PLACE, *CALL, *TERMS)}
    for kind in OF_CALLS:
        fields |= {f"{kind.name}.{f.name}": f for f in kind.fields}
    return fields


def event_fields(kind):
    """Name -> Field of a line that stands for one event of a kind."""
    return {f.name: f for f in (*PLACE, *FLAT, *kind.fields)}


def _rows(fields, tell, before="", of="log"):
    """A line for each of some fields; of: what their meanings' keys begin with."""
    for f in fields:
        form = {(): "number", (2,): "[x, y]", (3,): "[x, y, z]"}[f.shape]
        if f.domain == "flag":
            form = "true or false"
        elif f.domain == "choice":
            form = "name"
        about = tell(f"field.{of}.{f.name}", f.meaning) + (f": {', '.join(f.choices)}" if f.choices else "")
        domain = "" if f.domain in ("flag", "choice") else tell(f"domain.{f.domain}", f.domain)
        unit = f" [{f.unit}]" if f.unit else ""
        columns = _padded(tell(f"form.{form}", form), 15) + _padded(domain, 14)
        yield f"  {before + f.name:<24}{columns}{about}{unit}"


def _padded(text, width):
    """A text with spaces up to a width in cells, of which a Chinese character takes two."""
    used = sum(2 if east_asian_width(character) in "WF" else 1 for character in text)
    return text + " " * (width - used)


def schema_text(tell=lambda key, text: text):
    """The page that documents the format, made from the declarations of events and settings. tell(key, text):
    the text in another language."""
    said = {name: tell(f"log_page.{name}", text) for name, text in _PROSE.items()}
    lines = [
        said["head"].format(version=VERSION),
        "",
        said["header"],
        '  {"castray": 1, "tracer": "mine", "width": 784, "height": 784, "spp": 16, "integrator": "direct",',
        '   "hemisphere": "uniform", "roulette": 0.8, "light_sampling": "area"}   ' + said["one_line"],
        "",
        *(f"  {name:<16}{tell(f'log_page.{name}_is', about)}" for name, about in _TOLD.items()),
        *(f"  {name:<16}{_about(name, tell)}" for name in OPTIONS),
        "",
        said["options"],
        "",
        said["lines"],
        "",
        said["conventions"],
        "",
        said["place"],
        *_rows(PLACE, tell),
        "",
        said["calls"],
        *_rows(CALL + TERMS, tell),
    ]
    for kind in OF_CALLS:
        head = f"  {kind.name}: {tell(f'event.{kind.name}', kind.meaning)}"
        lines += ["", head, *_rows(kind.fields, tell, f"{kind.name}.", kind.name)]
    lines += ["", said["events"], *_rows(FLAT, tell)]
    for kind in (CAMERA, ESCAPE, END):
        head = f'  "kind": "{kind.name}": {tell(f"event.{kind.name}", kind.meaning)}'
        lines += ["", head, *_rows(kind.fields, tell, of=kind.name)]
    names = ", ".join(k.name for k in KINDS if k not in (CAMERA, ESCAPE, END))
    lines += ["", "  " + said["others"].format(names=names)]
    return "\n".join(lines) + "\n"


_PROSE = {
    "head": "castray's log format, version {version}: JSON Lines, UTF-8, one object a line, "
    "at most 1 MB each.",
    "header": "The first line is the header, e.g.",
    "one_line": "(on one line)",
    "options": """\
Options that are not there are read off the numbers where that can be done (a "probability" of
roulette that is always the same, densities of 1/(2 pi)), else they are castray's own defaults.""",
    "lines": """\
Every other line is one call of a recursive function, or one event; the two are not mixed. What is
not known is left out: what cannot be judged without it is then reported as not testable. NaN is
null or NaN, infinity Infinity, "inf" or "-inf". Vectors are lists. Lengths are in the log's unit,
colours are linear RGB, densities per solid angle unless they are called pdf_area.""",
    "conventions": """\
Conventions: wo leads back to where the path came from, wi to where light may come from, both away
from the surface. f has no cosine. A log that has it otherwise says so in its header.""",
    "place": "A line for every line: whose path it is",
    "calls": """\
ONE CALL OF A RECURSIVE FUNCTION A LINE, in any order. Inner calls have lines of their own (call,
parent), or stand within as "child": {...}.""",
    "events": 'ONE EVENT A LINE, with "kind", in the order in which they happen in a path.',
    "others": "{names}: the fields above, without the name of the kind before them.",
}


def _about(name, tell):
    field = Settings.__dataclass_fields__[name]
    choices = field.metadata["choices"]
    if name == "sampler":
        choices = ("independent", "low-discrepancy")
    return tell(f"setting.{name}", field.metadata["help"]) + (f": {', '.join(choices)}" if choices else "")
