"""The path options of the command line, made from the one place where settings are declared."""

from dataclasses import fields, make_dataclass
from typing import Annotated, Any

from cyclopts import Parameter

from lessons.zoo import planted
from tracer.settings import Settings, TracerError


def _whole(type_, tokens):
    """A whole number, and not a rounded one."""
    return _integer(tokens[0].value)


def two_whole(type_, tokens):
    return tuple(_integer(token.value, f"{token.keyword}: ") for token in tokens)


def _integer(text, place=""):
    try:
        return int(text)
    except ValueError:
        raise TracerError(f"{place}{text!r} is not a whole number") from None


def _path_options():
    """The options that decide a path's numbers, made from the one place where they are declared."""
    text = "width and height in pixels (default: the scene's)"
    size = Annotated[
        tuple[int, int] | None, Parameter(help=text, converter=two_whole, n_tokens=2, negative=())
    ]
    columns: list[Any] = [("size", size, None)]
    for f in fields(Settings):
        if f.name in ("width", "height"):
            continue
        choices = f.metadata["choices"]
        text = f.metadata["help"] + (f": {', '.join(map(str, choices))}" if choices else "")
        converter = _whole if f.type is int else None
        columns.append((f.name, Annotated[f.type, Parameter(help=text, converter=converter)], f.default))
    return Parameter(name="*", group="Path options")(
        make_dataclass("PathOptions", columns, frozen=True, namespace={"__module__": __name__})
    )


PathOptions = _path_options()
Whole = Parameter(converter=_whole)
Json = Annotated[bool, Parameter(help="print one JSON document and nothing else", negative=())]


def settings_and_steps(options):
    """Settings and named steps that the path options ask for."""
    options = options or PathOptions()
    width, height = options.size or (None, None)
    names = [f.name for f in fields(Settings) if f.name not in ("width", "height")]
    settings = Settings(width=width, height=height, **{name: getattr(options, name) for name in names})
    return settings, planted(settings)
