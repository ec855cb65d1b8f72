"""Runs a learner's file in a process of its own, with limits of time, memory and depth."""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import tracer.learner.child as child
from tracer.events import KINDS
from tracer.learner.build import counted, trace_of
from tracer.scene_file.load import load
from tracer.settings import Settings, TracerError
from tracer.trace.trace import Table

ASKED_EVERY = 0.2  # seconds


def run(path, scene, settings, seconds=300.0, quiet=False, stopped=lambda: None):
    """The Traces of a learner's cast_ray on a scene (a file or name): of all light samples, and of those only
    that bring something (see build). quiet: what the file prints goes nowhere. stopped(): asked now and then;
    raises to give up.

    Raises TracerError with the learner's file and line where it fails, or says what it exceeded.
    """
    path = Path(path).resolve()
    if not path.is_file():
        raise TracerError(
            f"{path.name}: there is no such file; castray check --new {path.name} writes a starter"
        )
    with tempfile.TemporaryDirectory() as folder:
        names = [str(Path(folder) / f"trace{k}.npz") for k in range(2)]
        answer = Path(folder) / "answer.json"
        request = {
            "file": str(path),
            "scene": scene,
            "settings": settings.as_dict(),
            "traces": names,
            "answer": str(answer),
        }
        asked = Path(folder) / "request.json"
        asked.write_text(json.dumps(request), encoding="utf-8")
        ended = _ended(asked, seconds, path, quiet, stopped)
        if not answer.is_file():
            raise TracerError(
                f"{path.name}: its process ended with code {ended}; "
                f"it may take {child.MEMORY >> 30} GiB of memory"
            )
        told = json.loads(answer.read_text(encoding="utf-8"))
        if "error" in told:
            raise TracerError(told["error"])
        found = Settings(**told["settings"])
        ready = load(scene).at(found)
        return counted([_read(name, ready, found) for name in names])


def _ended(asked, seconds, path, quiet, stopped):
    """The code with which the child ended."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    words = [sys.executable, "-m", child.__name__, str(asked)]
    until = time.monotonic() + seconds
    told = subprocess.DEVNULL if quiet else None
    with subprocess.Popen(words, env=environment, stdin=subprocess.DEVNULL, stderr=told) as process:
        try:
            while time.monotonic() < until:
                stopped()
                try:
                    return process.wait(min(ASKED_EVERY, max(until - time.monotonic(), 0.0)))
                except subprocess.TimeoutExpired:
                    continue
        finally:
            process.kill()
    raise TracerError(
        f"{path.name}: not done after {seconds:g} s; does a loop never end? "
        "Otherwise give it fewer paths (--size, --spp) or more time (--seconds)"
    )


def _read(name, scene, settings):
    with np.load(name, allow_pickle=False) as found:
        columns = dict(found)
    tables = {}
    for kind in (k.name for k in KINDS):
        own = {key.partition(".")[2]: c for key, c in columns.items() if key.startswith(f"{kind}.")}
        tables[kind] = Table(columns[f"{kind}/path"], columns[f"{kind}/step"], columns[f"{kind}/depth"], own)
    paths = {key.partition(".")[2]: c for key, c in columns.items() if key.startswith("path.")}
    return trace_of(scene, settings, paths, tables)
