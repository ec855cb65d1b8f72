"""The reference of the Python interface, made from docstrings, settings and the schema of events."""

import inspect
import re
from dataclasses import fields
from functools import cache
from html import escape
from importlib import import_module
from pathlib import Path

import tracer
from lessons.course import lessons
from tracer.events import KINDS
from tracer.settings import Settings
from viewer.site.frame import framed
from viewer.words import Speaker

ROOT = Path(tracer.__file__).parent.parent
MODULES = ("tracer", "tracer.testing", "tracer.trace", "tracer.trace.jsonl", "tracer.doctor", "tracer.twin")
LONGEST = 160  # of a signature; the settings have a table of their own
SHORT = 12  # of a default
BETWEEN = re.compile(r"(?<=[.:])\s+(?=[A-Z])")  # two sentences


def page():
    """The page, in English as the docstrings are."""
    say = Speaker("en")
    known, parts = set(), []
    for module in MODULES:
        names = {f"{module}.{name}": getattr(import_module(module), name) for name in public(module)}
        fresh = {name: thing for name, thing in names.items() if id(thing) not in known}
        known |= {id(thing) for thing in fresh.values()}
        parts.append(_section(module, said(import_module(module)), fresh))
    computing = {
        formula.function: formula.computed for it in lessons().values() for formula in it.formulas.values()
    }
    parts.append(
        _section("formulas", f"<p>{escape(say('site.functions_about'))}</p>", dict(sorted(computing.items())))
    )
    main = (
        f"<h1>{escape(say('site.reference'))}</h1><p>{escape(say('site.reference_about'))}</p>"
        f"{''.join(parts)}{_settings()}{_events()}"
    )
    return framed(say("site.reference"), main, "reference", "en", wide=True)


def public(module):
    """The names that a module shows to others."""
    return import_module(module).__all__


def anchor(name):
    """Where a name stands on the page."""
    return name


def source(thing):
    """File and line where something is defined; "" for what is no code."""
    try:
        file, (_, line) = inspect.getsourcefile(thing), inspect.getsourcelines(thing)
    except (TypeError, OSError):
        return ""
    return f"{Path(file).relative_to(ROOT).as_posix()}:{line}" if file else ""


def said(thing):
    """A docstring as HTML, without what it says of errors; "" without one of its own."""
    kept = [_without_errors(paragraph) for paragraph in _doc(thing).split("\n\n")]
    return _reader().render("\n\n".join(kept))


def raised(thing):
    """What a docstring says of errors, sentence by sentence."""
    sentences = (s for paragraph in _doc(thing).split("\n\n") for s in BETWEEN.split(paragraph))
    return [" ".join(sentence.split()) for sentence in sentences if "TracerError" in sentence]


def _without_errors(paragraph):
    if "TracerError" not in paragraph:
        return paragraph
    return " ".join(s for s in BETWEEN.split(paragraph) if "TracerError" not in s)


def _doc(thing):
    if inspect.ismodule(thing):
        return thing.__doc__.strip()  # not indented, but for what is code
    return inspect.cleandoc((inspect.getdoc(thing) if inspect.isroutine(thing) else thing.__doc__) or "")


@cache
def _reader():
    from markdown_it import MarkdownIt

    return MarkdownIt("commonmark", {"html": False})


def _section(head, about, things):
    entries = "".join(_entry(name, thing) for name, thing in things.items())
    return f'<section><h2 id="{head}"><code>{head}</code></h2>{about}{entries}</section>'


def _entry(name, thing):
    """One name: how it is called, what it does, what it raises, where it stands."""
    if not (inspect.isroutine(thing) or inspect.isclass(thing)):
        return f'<div class="entry" id="{anchor(name)}"><h3><code>{name}</code></h3></div>'
    inner = "".join(_entry(f"{name}.{k}", v) for k, v in _members(thing)) if inspect.isclass(thing) else ""
    errors = "".join(f"<p><b>errors</b> {escape(sentence)}</p>" for sentence in raised(thing))
    return (
        f'<div class="entry" id="{anchor(name)}"><h3><code>{escape(name)}{escape(_signature(thing))}</code></h3>'
        f'{said(thing)}{errors}<p class="dim">{escape(source(thing))}</p>{inner}</div>'
    )


def _members(thing):
    """What a class has for others to use: its own methods and properties."""
    for name, member in vars(thing).items():
        member = getattr(member, "__func__", member)
        usable = inspect.isfunction(member) or isinstance(member, property)
        if usable and not name.startswith("_") and member.__doc__:
            yield name, member if inspect.isfunction(member) else member.fget


def _signature(thing):
    """How it is called: names and short defaults; what types they have stands in the text."""
    try:
        parameters = inspect.signature(thing).parameters.values()
    except (TypeError, ValueError):
        return ""
    told = ", ".join(str(p.replace(annotation=p.empty, default=_default(p))) for p in parameters)
    return f"({told})" if len(told) < LONGEST else "(...)"


def _default(parameter):
    default = parameter.default
    if default is parameter.empty or len(repr(default)) <= SHORT:
        return default
    return _Named(getattr(default, "__name__", "..."))


class _Named(str):
    """A text that shows itself without quotation marks."""

    def __repr__(self):
        return str(self)


def _settings():
    head = "<th>name</th><th>default</th><th>what it means</th><th>choices</th>"
    rows = "".join(
        f"<tr><td><code>{f.name}</code></td><td><code>{escape(str(f.default))}</code></td>"
        f"<td>{escape(f.metadata['help'])}</td><td>{escape(', '.join(map(str, f.metadata['choices'] or ())))}</td></tr>"
        for f in fields(Settings)
    )
    return f'<section><h2 id="settings">settings</h2><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></section>'


def _events():
    head = "<th>field</th><th>shape</th><th>domain</th><th>unit</th><th>what it means</th>"
    tables = "".join(
        f'<h3 id="event-{kind.name}"><code>{kind.name}</code></h3><p>{escape(kind.meaning)}</p>'
        f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(map(_field, kind.fields))}</tbody></table>"
        for kind in KINDS
    )
    return f'<section><h2 id="events">events</h2>{tables}</section>'


def _field(field):
    cells = (f"<code>{field.name}</code>", str(field.shape), field.domain, field.unit, field.meaning)
    return (
        "<tr>"
        + "".join(f"<td>{cell if cell.startswith('<code') else escape(cell)}</td>" for cell in cells)
        + "</tr>"
    )
