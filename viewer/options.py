"""The path options of the command line, made from the one place where settings are declared."""

from dataclasses import fields, make_dataclass, replace
from json import dumps
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Group, Parameter

import tracer
from lessons.zoo import planted
from tracer.settings import Settings, TracerError
from viewer.sendable import sendable
from viewer.spoken_help import PATH_OPTIONS

ENGINES = ("numpy", "gl", "auto")
SMALL_SIDE = 64  # pixels
# Endings of the languages that path tracers are written in.
SOURCES = (
    ".c", ".cc", ".cpp", ".cs", ".cu", ".cxx", ".f90", ".glsl", ".go", ".h", ".hpp", ".hs", ".java", ".jl",
    ".js", ".kt", ".lua", ".m", ".mjs", ".rs", ".swift", ".ts", ".zig",
)  # fmt: skip


def _whole(type_, tokens):
    """A whole number, and not a rounded one."""
    return _integer(tokens[0].value)


def two_whole(type_, tokens):
    return tuple(_integer(token.value, f"{token.keyword}: ") for token in tokens)


def several_whole(type_, tokens):
    return [_integer(token.value, f"{token.keyword}: ") for token in tokens]


def _integer(text, place=""):
    try:
        return int(text)
    except ValueError:
        raise TracerError(f"{place}{text!r} is not a whole number") from None


_SET = "say a word of the scene differently: OBJECT.WORD=VALUE, as in white.reflectance=0.5; may be repeated"


class Unsaid(int):
    """A number that nobody said: the default of an option, which for some files is another."""


def path_options(name, without=(), size="default: the scene's", defaults=None):
    """The options that decide a path's numbers as a class of that name, made from the one place where they
    are declared; those in `without` are left out, and defaults {name: value} take the place of theirs."""
    text = f"width and height in pixels ({size})"
    shape = Annotated[
        tuple[int, int] | None, Parameter(help=text, converter=two_whole, n_tokens=2, negative=())
    ]
    columns: list[Any] = [("size", shape, None)]
    for f in fields(Settings):
        if f.name in ("width", "height", *without):
            continue
        choices = f.metadata["choices"]
        text = f.metadata["help"] + (f": {', '.join(map(str, choices))}" if choices else "")
        converter = _whole if f.type is int else None
        default = (defaults or {}).get(f.name, f.default)
        default = Unsaid(default) if f.name == "spp" else default
        columns.append((f.name, Annotated[f.type, Parameter(help=text, converter=converter)], default))
    if "set" not in without:
        columns.append(
            ("set", Annotated[tuple[str, ...], Parameter(help=_SET, negative=(), show_default=False)], ())
        )
    return Parameter(name="*", group=Group(PATH_OPTIONS, sort_key=3))(
        make_dataclass(name, columns, frozen=True, namespace={"__module__": __name__})
    )


_SHRUNK = f"default: the scene's, made smaller until its longer side is {SMALL_SIDE}"
PathOptions = path_options("PathOptions")
DoctorOptions = path_options("DoctorOptions", size=_SHRUNK)
CheckOptions = path_options(  # without what the learner's own code decides
    "CheckOptions",
    ("set", "integrator", "strategy", "heuristic", "light_sampling", "sampler", "replicates", "precision",
     "jitter", "roulette", "max_depth", "bug"),
    "default: 24 24",
    {"spp": 8},
)  # fmt: skip
BenchOptions = path_options(  # without what `castray bench` measures
    "BenchOptions",
    ("integrator", "strategy", "sampler", "replicates", "precision", "spp"),
    _SHRUNK,
)
Whole = Parameter(converter=_whole)
Json = Annotated[bool, Parameter(help="Print one JSON document and nothing else.", negative=())]


def print_json(document):
    """One JSON document on standard output."""
    print(dumps(sendable(document), allow_nan=False, ensure_ascii=True))


def check_engine(engine):
    """TracerError unless it is one of ENGINES."""
    if engine not in ENGINES:
        raise TracerError(f"engine: {engine!r} is not known; choose one of {', '.join(ENGINES)}")


def shrunk(settings, scene):
    """The settings at the size asked for, or a small one of the scene's shape."""
    if settings.width is not None:
        return settings
    shrink = min(1.0, SMALL_SIDE / max(scene.width, scene.height))
    width, height = (max(1, round(side * shrink)) for side in (scene.width, scene.height))
    return replace(settings, width=width, height=height)


def check_no_tracer(text):
    """TracerError if a file is a tracer or a tracer's log: what it is for, where a scene is asked for."""
    path = Path(text)
    ending = path.suffix.lower()
    if not path.is_file():
        return
    if ending == ".py":
        raise TracerError(f"{text}: is a tracer in Python, no scene; castray check {text} judges it")
    if ending == ".jsonl":
        raise TracerError(f"{text}: is a log, no scene; castray doctor {text} --scene SCENE judges it")
    if ending in SOURCES:
        raise TracerError(
            f"{text}: is source code, which castray does not run; let your tracer write a log: "
            "castray log --schema, in C++ castray log --header castray.h"
        )


def scene_of(text, options):
    """The scene of that name or file, with the changes that the path options ask for."""
    check_no_tracer(text)
    loaded = tracer.load(text)
    if options is None or not options.set:
        return loaded
    from tracer.scene_file.change import changed, parse

    return changed(loaded, parse(options.set))


def settings_and_steps(options):
    """Settings and named steps that the path options ask for; what is not among them has its default."""
    options = options or PathOptions()
    width, height = options.size or (None, None)
    said = {f.name: getattr(options, f.name) for f in fields(options) if f.name not in ("size", "set")}
    said |= {"spp": int(said["spp"])} if "spp" in said else {}
    settings = Settings(width=width, height=height, **said)
    return settings, planted(settings)
