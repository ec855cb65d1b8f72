"""The command `castray render`."""

import os
import sys
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

import tracer
from tracer.picture import check_path
from tracer.settings import TracerError
from viewer.options import (
    Json,
    PathOptions,
    Whole,
    check_engine,
    print_json,
    scene_of,
    settings_and_steps,
)
from viewer.progress import watched
from viewer.words import Speaker

MOST_SPP = 4096  # samples of a pixel where only an error is asked for


def render(
    scene: str,
    /,
    *,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    options: PathOptions | None = None,
    engine: str = "numpy",
    workers: Annotated[int | None, Whole] = None,
    cluster: str | None = None,
    until_error: float | None = None,
    adaptive: str = "off",
    record: Path | None = None,
    record_level: str | None = None,
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
        numpy; gl, which traces on the graphics card (needs moderngl and OpenGL 4.1) and gives the same
        picture but for rounding; or auto: gl where there is a graphics card and it can do what is asked.
    workers
        Most processes to use (default: one for each core). The picture is the same for any number.
    cluster
        Address of a dask.distributed scheduler, such as tcp://127.0.0.1:8786, whose workers do the work
        (needs the package distributed, and castray there). The picture is the same where they are machines
        like this one. Stopped, it goes on with the same command.
    until_error
        Stop each tile of 16 x 16 pixels when its relative error (root mean of se^2 / (mean^2 + 0.01)) is that
        small; --spp is then the most (4096 unless said).
    adaptive
        mse or relmse: measure with 16 samples a pixel, then spend the rest of --spp, on average, where that
        error is.
    record
        Keep the paths in this folder, for castray query and castray view. Where the same was begun before, it
        goes on. The picture is the same.
    record_level
        paths: a row for each path (the default); events: everything that happened, about 200 bytes a vertex.
    explain
        Say what the scene needs, what is skipped, and why.
    """
    check_engine(engine)
    planned = until_error is not None or adaptive != "off"
    _check_together(engine, workers, cluster, record, record_level, planned)
    settings, steps = settings_and_steps(options)
    if until_error is not None and (options is None or options.spp == PathOptions().spp):
        settings = replace(settings, spp=MOST_SPP)
    loaded = scene_of(scene, options)
    path = Path(f"{loaded.name}.png") if output is None else output
    check_path(path)
    why = ""
    if engine == "auto":
        engine, why = _chosen(loaded, settings, steps, record)
    common = {"workers": workers or os.cpu_count() or 1, "steps": steps}
    plan = {"until_error": until_error, "adaptive": adaptive, "engine": engine}
    with watched(Speaker()("progress.rendering")) as progress, _machines(cluster) as machines:
        common |= {"progress": progress, "cluster": machines}
        if record is not None:
            picture = tracer.record(loaded, settings, record, record_level or "paths", **common)
        elif machines and not planned:
            picture = _going_on(path, loaded, settings, common)
        else:
            picture = tracer.render(loaded, settings, **common, **plan)
    tracer.write(picture, path, scene=str(scene))
    features = []
    if explain:
        from tracer.engine.needs import needs

        features = list(needs(loaded, picture.settings))
    _report(loaded, picture, path, json, features, _kept(record) if record is not None else {})
    if why and not json:
        say = Speaker()
        print(say("told.engine", engine=picture.engine, why=say.error(why)))
    if machines is not None and machines.lost:
        return 1
    return 0 if picture.complete else 130


def _check_together(engine, workers, cluster, record, record_level, planned):
    """TracerError for options that are no use together. planned: whether pixels get unlike many samples."""
    if engine == "gl" and record is not None:
        raise TracerError("engine: gl keeps no paths; leave out --record, or choose engine numpy")
    if cluster is not None and (engine != "numpy" or workers is not None):
        raise TracerError("cluster: its workers trace, with engine numpy; leave out --engine and --workers")
    if workers is not None and not 1 <= workers <= 1024:
        raise TracerError(f"workers: {workers} is not between 1 and 1024")
    if record is None and record_level is not None:
        raise TracerError("record_level: says how much is kept in the folder that --record names; name one")
    if record is not None and planned:
        raise TracerError(
            "record: keeps the same samples of every pixel; leave out --until-error and --adaptive"
        )


def _going_on(path, scene, settings, options):
    """The picture by a cluster, from where it was stopped if it was, and kept for the next time if it is."""
    from tracer.trace import unfinished

    settings, place = settings.at_size_of(scene), unfinished.beside(path)
    so_far = unfinished.resumed(place, scene, settings)
    picture = tracer.render(scene, settings, **options, so_far=so_far)
    if picture.complete:
        unfinished.forget(place)
    else:
        done = unfinished.keep(place, so_far, scene, settings)
        said = Speaker()("told.going_on", place=place, done=done, pixels=picture.samples.size)
        print(f"castray: {said}", file=sys.stderr)
    return picture


def _machines(address):
    """A context that gives the cluster at that address, or None where there is no address."""
    if address is None:
        return nullcontext()
    from tracer.cluster import connected

    return connected(address)


def _chosen(scene, settings, steps, record):
    """The engine that auto takes, and why."""
    from tracer.engine.gl.choice import faster

    if record is not None:
        return "numpy", "gl keeps no paths"
    return faster(scene, settings.at_size_of(scene), steps)


def _kept(record):
    """What a recording's folder has by now."""
    from tracer.trace.folder import opened

    folder = opened(record)
    done = folder.parts - len(folder.missing())
    size = folder.bytes()
    return {"folder": str(record), "level": folder.level, "parts": folder.parts, "done": done, "bytes": size}


def _report(scene, picture, path, as_json, features, kept):
    """What was rendered, as one JSON document or some lines; features: what it needed, if that was asked;
    kept: what was recorded."""
    if as_json:
        told = {"explain": [need._asdict() for need in features]} if features else {}
        print_json(_as_dict(scene, picture, path) | told | ({"record": kept} if kept else {}))
        return
    if features:
        from viewer.report import print_needs

        print_needs(features)
    _print_picture(picture, path)
    if kept:
        key = "told.kept" if picture.complete else "told.kept_so_far"
        print(Speaker()(key, size=f"{kept['bytes'] / 1e6:.1f}", **kept))


def _as_dict(scene, picture, path):
    """A picture and what it cost, as plain values."""
    height, width = picture.samples.shape
    settings = picture.settings
    return {
        "scene": scene.name,
        "width": width,
        "height": height,
        "spp": settings.spp,
        "seed": settings.seed,
        "engine": picture.engine,
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


def _print_picture(picture, path):
    """A picture and what it cost, in lines."""
    height, width = picture.samples.shape
    spp = picture.settings.spp
    say, rate = Speaker(), picture.paths / max(picture.seconds, 1e-9)
    cost = {"paths": picture.paths, "seconds": f"{picture.seconds:.2f}", "rate": f"{rate:.3g}"}
    print(say("render.done", path=path, width=width, height=height, **cost))
    if not picture.complete:
        done = picture.samples.mean() / spp
        print(say("render.stopped", done=f"{done:.0%}", least=picture.samples.min(), spp=spp))
    elif picture.samples.min() < picture.samples.max():
        every = sorted(picture.samples.ravel().tolist())
        spent = {"least": every[0], "most": every[-1], "median": every[len(every) // 2], "spp": spp}
        key = "render.spent_less" if picture.saved > 0.0 else "render.spent"
        print(say(key, saved=f"{picture.saved:.1%}", **spent))
    if picture.dropped:
        print(say("render.dropped", n=picture.dropped))
