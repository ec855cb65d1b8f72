"""The `castray` command."""

import json
import os
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from cyclopts import App, CycloptsError, Parameter

import tracer
from tracer.engine.needs import needs
from tracer.picture import check_path
from tracer.settings import TracerError
from viewer.bench import bench
from viewer.bench_bsdf import bench_bsdf
from viewer.export import export
from viewer.options import Json, PathOptions, Whole, settings_and_steps, two_whole
from viewer.progress import watched

MOST_SPP = 4096  # samples of a pixel where only an error is asked for


def _version():
    from importlib.metadata import version

    return version("castray")


app = App(
    name="castray",
    help="A step-through debugger for path tracing: click a pixel, walk its paths, read every number.",
    version=_version,
)


@app.command
def render(
    scene: str,
    /,
    *,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    options: PathOptions | None = None,
    engine: str = "auto",
    workers: Annotated[int | None, Whole] = None,
    until_error: float | None = None,
    adaptive: str = "off",
    explain: Annotated[bool, Parameter(negative=())] = False,
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
    until_error
        Stop each tile of 16 x 16 pixels when its relative error (root mean of se^2 / (mean^2 + 0.01)) is that
        small; --spp is then the most (4096 unless said).
    adaptive
        mse or relmse: measure with 16 samples a pixel, then spend the rest of --spp, on average, where that
        error is.
    explain
        Say what the scene needs, what is skipped, and why.
    """
    if engine not in ("auto", "numpy"):
        raise TracerError(f"engine: {engine!r} is not known; choose one of auto, numpy")
    if workers is not None and not 1 <= workers <= 1024:
        raise TracerError(f"workers: {workers} is not between 1 and 1024")
    settings, steps = settings_and_steps(options)
    if until_error is not None and (options is None or options.spp == PathOptions().spp):
        settings = replace(settings, spp=MOST_SPP)
    loaded = tracer.load(scene)
    path = Path(f"{loaded.name}.png") if output is None else output
    check_path(path)
    with watched("rendering") as progress:
        workers = workers or os.cpu_count() or 1
        picture = tracer.render(loaded, settings, progress, workers, steps, until_error, adaptive)
    tracer.write(picture, path, scene=str(scene))
    _report(loaded, picture, path, json, list(needs(loaded, picture.settings)) if explain else ())
    return 0 if picture.complete else 130


def _report(scene, picture, path, as_json, features):
    """What was rendered, as one JSON document or one line; features: what it needed, if that was asked."""
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
                "samples": [int(picture.samples.min()), int(picture.samples.max())],
                "saved": picture.saved,
                "complete": picture.complete,
                "settings": settings.as_dict(),
                "out": str(path),
            }
            | ({"explain": [need._asdict() for need in features]} if features else {})
        )
        return
    if features:
        from viewer.report import print_needs

        print_needs(features)
    rate = picture.paths / max(picture.seconds, 1e-9)
    print(
        f"{path}: {width} x {height}, {picture.paths} paths in {picture.seconds:.2f} s ({rate:.3g} paths/s)"
    )
    if picture.samples.min() < picture.samples.max():
        every = sorted(picture.samples.ravel().tolist())
        spent = f"{every[0]} to {every[-1]}, median {every[len(every) // 2]}"
        print(f"samples per pixel: {spent}; {picture.saved:.1%} of {settings.spp} saved")
    if not picture.complete:
        print(f"stopped early: every pixel has at least {picture.samples.min()} of {settings.spp} samples")
    if picture.dropped:
        print(f"{picture.dropped} samples were not finite and count as 0")


@app.command
def inspect(
    scene: str,
    /,
    *,
    pixel: Annotated[tuple[int, int], Parameter(converter=two_whole, n_tokens=2)],
    sample: Annotated[int | None, Whole] = None,
    options: PathOptions | None = None,
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
    settings, steps = settings_and_steps(options)
    loaded = tracer.load(scene)
    record = tracer.inspect(loaded, settings, *pixel, sample, steps)
    prepared = loaded.at(record.settings)
    if json:
        _print_json(record.as_dict(prepared))
        return
    from viewer.report import print_pixel

    print_pixel(record, prepared)


@app.command
def diff(
    a: Path,
    b: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    alpha: float = 0.01,
    json: Json = False,
):
    """Compare two pictures: is their difference more than noise? Exit code 0 if they are the same, 1 if not.

    Two .exr of castray from different seeds are compared by a z-test; others by their error only.

    Parameters
    ----------
    a
        The picture to judge.
    b
        The reference.
    output
        Where a map goes, blue where a is darker, red where brighter: z of each pixel and Z around it, to +-5.
    alpha
        Chance that two right pictures are called different.
    """
    from tracer.testing import compare
    from viewer import diff as words

    if not 0.0 < alpha < 1.0:
        raise TracerError(f"alpha: {alpha} is not between 0 and 1")
    if output is not None:
        check_path(output)
    names = str(a), str(b)
    pictures = tracer.read(a), tracer.read(b)
    verdict = compare(*pictures, alpha, names)
    if output is not None:
        tracer.write(words.drawing(*pictures, verdict), output)
    if json:
        _print_json(words.as_dict(verdict, names))
    else:
        print(*words.lines(verdict, names), sep="\n")
    return 0 if verdict.same else 1


@app.command
def view(
    scene: str = "cornell_unit",
    /,
    *,
    port: Annotated[int | None, Whole] = None,
    browser: bool = True,
    options: PathOptions | None = None,
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
    settings, _ = settings_and_steps(options)
    viewer_app.serve(tracer.load(scene), settings, port, browser)


app.command(bench)
app.command(export)
app.command(bench_bsdf, name="bsdf")


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


def _say(message, *_):
    """A message as one line on standard error; what is not to be seen, as its code."""
    line = " ".join(str(message).split())
    shown = (c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line)
    print(f"castray: {''.join(shown)}", file=sys.stderr)


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
        _say(error)
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
