"""Pictures to disk, whole or not at all."""

import json
import os
from pathlib import Path

import numpy as np

from tracer.picture.srgb import to_srgb
from tracer.picture.stored import MARK, PREFIX, StoredPicture
from tracer.settings import TracerError

FORMATS = (".exr", ".png", ".npy")


def check_path(path):
    """TracerError if a picture cannot be written to `path`, before any time is spent on it."""
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise TracerError(f"{path}: unknown kind of picture {path.suffix!r}; use .exr, .png or .npy")
    check_place(path)


def check_place(path):
    """TracerError if no file can be written to `path`."""
    if path.is_dir():
        raise TracerError(f"{path}: is a folder; name a file in it")
    if not path.parent.is_dir():
        raise TracerError(f"{path}: there is no folder {path.parent}; make it first")
    if not os.access(path.parent, os.W_OK) or (path.exists() and not os.access(path, os.W_OK)):
        raise TracerError(f"{path}: cannot be written there; choose another folder or change its permissions")


def write(picture, path, **notes):
    """Write a linear picture: an array (H, W, 3) float32, or what has .rgb, .variance and .samples.

    An .exr keeps all three, and the settings and `notes` (words about it, such as scene="cornell") in its
    header. The file appears whole or not at all. Raises TracerError where that is impossible.
    """
    check_path(path)
    writer = {".exr": _write_exr, ".png": _write_png, ".npy": _write_npy}[Path(path).suffix.lower()]
    if not hasattr(picture, "rgb"):
        picture = StoredPicture(picture)
    write_whole(path, lambda beside: writer(picture, beside, notes))


def write_whole(path, write):
    """Let write(name) fill a file beside `path` and put it there: it appears whole or not at all."""
    import tempfile

    path = Path(path)
    check_place(path)
    try:
        handle, beside = tempfile.mkstemp(suffix=path.suffix.lower(), prefix=".castray-", dir=path.parent)
        os.close(handle)
        try:
            write(beside)
            os.chmod(beside, 0o666 & ~_umask())
            os.replace(beside, path)
        except BaseException:
            os.unlink(beside)
            raise
    except OSError as error:
        raise TracerError(f"{path}: cannot be written: {error.strerror or error}") from None


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _write_exr(picture, path, notes):
    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    channels = {"RGB": np.ascontiguousarray(picture.rgb)}
    if picture.variance is not None:
        channels["variance"] = np.ascontiguousarray(picture.variance)
        channels["samples"] = np.ascontiguousarray(picture.samples, np.uint32)
        header[MARK] = "variance: of each pixel's mean; samples: how many a pixel has"
    settings = getattr(picture, "settings", None)
    if settings is not None:
        notes = {**notes, "settings": settings if isinstance(settings, dict) else settings.as_dict()}
    header |= {PREFIX + name: json.dumps(value) for name, value in notes.items() if value is not None}
    with OpenEXR.File(header, channels) as file:
        file.write(path)


def _write_png(picture, path, notes):
    from PIL import Image

    Image.fromarray(to_srgb(picture.rgb)).save(path)


def _write_npy(picture, path, notes):
    np.save(path, picture.rgb)
