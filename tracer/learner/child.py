"""The process in which a learner's file runs: python -m tracer.learner.child REQUEST.json

It may do what it likes there, run away, fill the memory or end: the answer is a whole file or none.
"""

import json
import sys
import traceback
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import ModuleType

import numpy as np

from tracer.learner.build import Builder
from tracer.learner.calls import Looped, Runaway, Runner
from tracer.learner.value import Vector
from tracer.scene_file.load import load
from tracer.settings import Settings

MEMORY = 4 << 30  # bytes


def main():
    request = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    sys.stdout = sys.stderr  # what the learner prints is not ours
    _limit_memory()
    try:
        traces = run(request)
    except (Exception, SystemExit) as error:  # whatever the learner's file raises
        answer = {"error": said(error, request["file"])}
        Path(request["answer"]).write_text(json.dumps(answer), encoding="utf-8")
        return
    for number, trace in enumerate(traces):
        columns = {f"path.{name}": column for name, column in trace.paths.items()}
        for kind, table in trace.tables.items():
            columns |= {f"{kind}.{name}": column for name, column in table.columns.items()}
            columns |= {f"{kind}/{name}": getattr(table, name) for name in ("path", "step", "depth")}
        np.savez(request["traces"][number], **columns)
    Path(request["answer"]).write_text(json.dumps({"settings": trace.settings.as_dict()}), encoding="utf-8")


def run(request):
    """The two Traces of a request: its file, scene and settings."""
    settings = Settings(**request["settings"])
    scene = load(request["scene"]).at(settings)
    runner = Runner(scene, _module(request["file"]))
    builder = Builder(runner.world, settings)
    width, height = int(settings.width or 0), int(settings.height or 0)
    y, x = (grid.ravel() for grid in np.mgrid[:height, :width])
    film = np.stack((x, y)) + 0.5
    o, d = scene.camera.rays(film, width, height, np.float64)
    for pixel in range(x.size):
        for sample in range(settings.spp):
            start, ahead = Vector(*o[:, pixel]), Vector(*d[:, pixel])
            call = runner.path(start, ahead, pixel, sample, settings.seed)
            builder.add(int(x[pixel]), int(y[pixel]), sample, film[:, pixel], call)
    runner.check_recursion()
    return tuple(builder.traces())


def _module(path):
    """The learner's file under a name that hides no other module: it may well be called tracer.py."""
    loader = SourceFileLoader("_learners_own_tracer", path)
    module = ModuleType(loader.name)
    loader.exec_module(module)
    if not callable(getattr(module, "cast_ray", None)):
        raise AttributeError("there is no function cast_ray(scene, ray, depth) in it")
    return module


def said(error, path):
    """An exception in one line, with the last place in the learner's file that led to it."""
    if isinstance(error, (Looped, Runaway)):
        return f"{Path(path).name}: {error}"
    if isinstance(error, SyntaxError) and error.filename == path:
        return f"{Path(path).name}:{error.lineno}: {error.msg}: {(error.text or '').strip()}"
    words = " ".join(str(error).split())
    message = f"{type(error).__name__}: {words}" if words else type(error).__name__
    frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename == path]
    if not frames:
        return f"{Path(path).name}: {message}"
    last = frames[-1]
    return f"{Path(path).name}:{last.lineno}: in {last.name}: {message}: {last.line}"


def _limit_memory():
    try:
        import resource
    except ImportError:  # a system without limits of this kind
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


if __name__ == "__main__":
    main()
