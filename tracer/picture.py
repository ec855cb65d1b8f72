"""Pictures on disk: OpenEXR and NumPy keep the linear numbers, PNG is for looking at."""

import os
from pathlib import Path

import numpy as np

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


def write(rgb, path):
    """Write a linear picture (H, W, 3) float32; the file appears whole or not at all.

    Raises TracerError where that is impossible.
    """
    check_path(path)
    writer = {".exr": _write_exr, ".png": _write_png, ".npy": _write_npy}[Path(path).suffix.lower()]
    write_whole(path, lambda beside: writer(rgb, beside))


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


def _write_exr(rgb, path):
    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": np.ascontiguousarray(rgb)}) as file:
        file.write(path)


def _write_png(rgb, path):
    from PIL import Image

    Image.fromarray(to_srgb(rgb)).save(path)


def _write_npy(rgb, path):
    np.save(path, rgb)


def to_srgb(rgb, exposure=0.0):
    """Linear (..., 3) to 8-bit sRGB (IEC 61966-2-1); exposure in stops; clipped, NaN black."""
    linear = np.clip(np.nan_to_num(rgb * 2.0**exposure, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return (255.0 * curve + 0.5).astype(np.uint8)
