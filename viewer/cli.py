"""The `castray` command."""

import json
import os
import sys
import warnings
from dataclasses import fields, make_dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, CycloptsError, Parameter

import tracer
from lessons.zoo import planted
from tracer.settings import Settings, TracerError
from viewer.export import export


def _version():
    from importlib.metadata import version

    return version("castray")


app = App(
    name="castray",
    help="A step-through debugger for path tracing: click a pixel, walk its paths, read every number.",
    version=_version,
)


def _whole(type_, tokens):
    """A whole number, and not a rounded one."""
    return _integer(tokens[0].value)


def _two_whole(type_, tokens):
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
        tuple[int, int] | None, Parameter(help=text, converter=_two_whole, n_tokens=2, negative=())
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


def _settings(options):
    """Settings and named steps that the path options ask for."""
    options = options or PathOptions()
    width, height = options.size or (None, None)
    names = [f.name for f in fields(Settings) if f.name not in ("width", "height")]
    settings = Settings(width=width, height=height, **{name: getattr(options, name) for name in names})
    return settings, planted(settings)


@app.command
def render(
    scene: str,
    /,
    *,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    options: PathOptions | None = None,  # type: ignore[valid-type]
    engine: str = "auto",
    workers: Annotated[int | None, Whole] = None,
    json: Json = False,
):
    """Render a scene to a picture (.exr and .npy keep the linear numbers, .png is for looking at).

    Parameters
    ----------
    scene
        A scene file, or the bare name of one that comes with castray.
    output
        Where the picture goes; SCENE.png in this folder unless said.
    engine
        numpy, or auto, which is the same until there are others.
    workers
        Most processes to use (default: one for each core). The picture is the same for any number.
    """
    if engine not in ("auto", "numpy"):
        raise TracerError(f"engine: {engine!r} is not known; choose one of auto, numpy")
    if workers is not None and not 1 <= workers <= 1024:
        raise TracerError(f"workers: {workers} is not between 1 and 1024")
    settings, steps = _settings(options)
    loaded = tracer.load(scene)
    path = Path(f"{loaded.name}.png") if output is None else output
    tracer.picture.check_path(path)
    with _progress("rendering") as progress:
        picture = tracer.render(loaded, settings, progress, workers or os.cpu_count() or 1, steps)
    tracer.write(picture.rgb, path)
    _report(loaded, picture, path, json)
    return 0 if picture.complete else 130


def _report(scene, picture, path, as_json):
    """What was rendered, as one JSON document or one line."""
    height, width = picture.samples.shape
    settings = picture.settings
    if as_json:
        _print_json(
            {
                "scene": scene.name,
                "width": width,
                "height": height,
                "spp": settings.spp,
                "seed": settings.seed,
                "engine": "numpy",
                "seconds": picture.seconds,
                "paths": picture.paths,
                "rays": picture.rays,
                "mean": [float(v) for v in picture.rgb.mean(axis=(0, 1), dtype="float64")],
                "dropped": picture.dropped,
                "complete": picture.complete,
                "settings": settings.as_dict(),
                "out": str(path),
            }
        )
        return
    rate = picture.paths / max(picture.seconds, 1e-9)
    print(
        f"{path}: {width} x {height}, {picture.paths} paths in {picture.seconds:.2f} s ({rate:.3g} paths/s)"
    )
    if not picture.complete:
        print(f"stopped early: every pixel has at least {picture.samples.min()} of {settings.spp} samples")
    if picture.dropped:
        print(f"{picture.dropped} samples were not finite and count as 0")


@app.command
def inspect(
    scene: str,
    /,
    *,
    pixel: Annotated[tuple[int, int], Parameter(converter=_two_whole, n_tokens=2)],
    sample: Annotated[int | None, Whole] = None,
    options: PathOptions | None = None,  # type: ignore[valid-type]
    json: Json = False,
):
    """Show the events of a pixel's paths, and how their light adds up to the pixel.

    Parameters
    ----------
    scene
        A scene file, or the bare name of one that comes with castray.
    pixel
        Column and row, from 0 0 at the top left.
    sample
        Only this sample of the pixel (default: all; the brightest one is then shown event by event).
    """
    settings, steps = _settings(options)
    loaded = tracer.load(scene)
    record = tracer.inspect(loaded, settings, *pixel, sample, steps)
    prepared = loaded.at(record.settings)
    if json:
        _print_json(record.as_dict(prepared))
        return
    from viewer.report import print_pixel

    print_pixel(record, prepared)


@app.command
def view(
    scene: str = "cornell_unit",
    /,
    *,
    port: Annotated[int | None, Whole] = None,
    browser: bool = True,
    options: PathOptions | None = None,  # type: ignore[valid-type]
):
    """Open the viewer: click a pixel, step through its paths. Prints its address.

    Parameters
    ----------
    scene
        A scene file, the bare name of one that comes with castray, or a link from the viewer's address bar.
    port
        Where to listen on 127.0.0.1 (default: any free port).
    browser
        Open a browser where there is one.
    """
    from viewer import app as viewer_app
    from viewer.link import is_link

    if port is not None and not 0 <= port <= 65535:
        raise TracerError(f"port: {port} is not between 0 and 65535")
    if is_link(scene):
        viewer_app.serve_link(scene, port, browser)
        return
    settings, _ = _settings(options)
    viewer_app.serve(tracer.load(scene), settings, port, browser)


app.command(export)


@app.command
def bugs(*, json: Json = False):
    """List the bug zoo: what each bug looks like, and which law it breaks."""
    from lessons.zoo import ZOO

    if json:
        _print_json(
            [
                {"id": bug.id, "title": bug.title, "symptom": bug.symptom, "law": bug.law}
                for bug in ZOO.values()
            ]
        )
        return
    from viewer.report import print_bugs

    print_bugs(ZOO.values())


def _print_json(document):
    print(json.dumps(document, allow_nan=False, ensure_ascii=True))


def _progress(what):
    """A context that gives a function progress(done, total), or None where nobody watches."""
    from contextlib import nullcontext

    if not sys.stderr.isatty():
        return nullcontext()
    from viewer.progress import bar

    return bar(what)


def _say(message, *_):
    print(f"castray: {' '.join(str(message).split())}", file=sys.stderr)


def main(words=None):
    """Run `castray WORDS`. Bad input is one line on standard error and exit code 2."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal that lacks a character shows "?"
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _say
            code = app(words, exit_on_error=False, print_error=False)
    except (TracerError, CycloptsError) as error:
        print(f"castray: {' '.join(str(error).split())}", file=sys.stderr)
        sys.exit(2)
    except MemoryError:
        print("castray: not enough memory for that; try a smaller --size or fewer --spp", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("castray: stopped", file=sys.stderr)
        sys.exit(130)
    except BrokenPipeError:
        # Who reads us has seen enough; keep Python from complaining about it at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(0)
    sys.exit(code if isinstance(code, int) else 0)


if __name__ == "__main__":
    main()
