"""A picture that was stopped, in a file beside it, to go on from: the sums of the pixels that are done.

For pictures made pixel by pixel, as clusters do: what is done begins at the first pixel and has no gaps.
"""

import json
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np

from tracer import film
from tracer.engine.picture import SoFar
from tracer.settings import TracerError
from tracer.trace.fingerprint import fingerprint
from tracer.trace.folder import PARTIAL, difference
from tracer.trace.stored_scene import described

ENDING = ".unfinished.npz"
COSTS = ("seconds", "rays", "dropped")


def beside(picture):
    """Where the unfinished state of a picture's file lies."""
    return Path(f"{picture}{ENDING}")


def keep(path, so_far, scene, settings):
    """Write a SoFar; how many pixels are done. Raises TracerError."""
    sheet = so_far.sheet
    done = int(np.count_nonzero(sheet.samples))
    sums = {"total": sheet.total[:, :done], "spread": sheet.spread[:, :done], "samples": sheet.samples[:done]}
    if sheet.parts is not None:
        sums["parts"] = sheet.parts[..., :done]
    costs = {name: getattr(so_far, name) for name in COSTS}
    partial = Path(f"{path}{PARTIAL}")
    try:
        with open(partial, "wb") as file:
            np.savez(file, header=json.dumps(_header(scene, settings) | {"costs": costs}), **sums)
        partial.replace(path)
        return done
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise TracerError(f"{path}: cannot be written: {error.strerror or error}") from None


def resumed(path, scene, settings):
    """The SoFar that the file has, or a new one where there is no file. Raises TracerError where it has
    something else."""
    so_far = SoFar.begin(settings)
    if not path.exists():
        return so_far
    try:
        with np.load(path, allow_pickle=False) as there:
            header, sums = json.loads(str(there["header"])), {name: there[name] for name in there.files}
        _check(path, header, _header(scene, settings))
        _fill(so_far.sheet, sums)
        for name in COSTS:
            setattr(so_far, name, header["costs"][name])
    except TracerError:
        raise
    except (OSError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile):
        raise TracerError(f"{path}: is not the beginning of a picture; remove it") from None
    return so_far


def forget(path):
    """Take the file away: the picture is finished."""
    with suppress(OSError):
        path.unlink(missing_ok=True)


def _header(scene, settings):
    """What a picture's numbers depend on, as plain values."""
    what = {"name": scene.name, "description": described(scene)[0]}
    said = {"settings": settings.as_dict(), "scene": what, "fingerprint": fingerprint()}
    return json.loads(json.dumps(said))


def _check(path, there, asked):
    for name, value in asked.items():
        if there[name] != value:
            said = difference(name, there[name], value, "the beginning of a picture")
            raise TracerError(f"{path}: {said}; remove it, or choose another -o")


def _fill(sheet, sums):
    """Put the sums of the first pixels into an empty Film."""
    done = sums["samples"].size
    part = film.Film(done, sheet.replicates)
    part.total[:], part.spread[:], part.samples[:] = sums["total"], sums["spread"], sums["samples"]
    if part.parts is not None:
        part.parts[:] = sums["parts"]
    sheet.put(slice(0, done), part)
