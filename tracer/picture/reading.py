"""Pictures from disk: .exr, .hdr, .npy, .pfm, and what pillow reads, such as .png; mistakes explained."""

import contextlib
import io
import json
import os
from pathlib import Path

import numpy as np

from tracer.picture.rgbe import decoded
from tracer.picture.srgb import from_srgb
from tracer.picture.stored import MARK, PREFIX, StoredPicture
from tracer.picture.writing import FORMATS
from tracer.settings import TracerError

KINDS = (".png", ".ppm", ".pgm", ".exr", ".npy", ".hdr", ".pfm", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")


def is_picture(name):
    """Whether a file's name is that of a picture."""
    return Path(name).suffix.lower() in KINDS


def read(path, dtype=np.float32, raw=False):
    """The StoredPicture in a file, linear; its variance and samples where it is an .exr of castray.

    dtype: of the numbers. raw: leave the numbers of files in sRGB as they are, instead of making them linear.
    Raises TracerError naming the file where there is no picture in it.
    """
    path = Path(path)
    readers = {".exr": _read_exr, ".hdr": _read_hdr, ".npy": _read_npy, ".pfm": _read_pfm}
    try:
        if path.is_dir():
            raise TracerError(f"{path}: is a folder, not a picture")
        if not path.exists():
            raise TracerError(f"{path}: there is no such file")
        if path.suffix.lower() in readers:
            picture = readers[path.suffix.lower()](path, dtype)
        else:
            picture = _read_other(path, dtype, raw)
    except OSError as error:
        raise TracerError(f"{path}: cannot be read: {error.strerror or error}") from None
    if picture.rgb.size == 0:
        raise TracerError(f"{path}: the picture is empty")
    return picture


def _linear(values, path, dtype):
    """Values (H, W), (H, W, 1), (H, W, 3) or with alpha as a picture (H, W, 3)."""
    values = np.asarray(values)
    if values.ndim == 2:
        values = values[..., None]
    if values.ndim != 3 or values.shape[2] not in (1, 3, 4) or values.dtype.kind not in "fiu":
        raise TracerError(
            f"{path}: holds {values.dtype} of shape {values.shape}; a picture is (H, W, 3) numbers"
        )
    if values.shape[2] == 4:
        values = values[..., :3]
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(np.broadcast_to(values, (*values.shape[:2], 3)), dtype)


def _read_npy(path, dtype):
    try:
        values = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, EOFError, SyntaxError):
        raise TracerError(f"{path}: is not a NumPy array of numbers") from None
    if not isinstance(values, np.ndarray):
        raise TracerError(f"{path}: is not a single NumPy array")
    return StoredPicture(_linear(values, path, dtype))


def _read_hdr(path, dtype):
    try:
        values = decoded(path.read_bytes())
    except (ValueError, IndexError):
        raise TracerError(f"{path}: is not a Radiance picture, or holds less than its header says") from None
    return StoredPicture(_linear(values, path, dtype))


def _read_pfm(path, dtype):
    """Portable float map: `PF` or `Pf`, size, a scale whose sign is the byte order, rows from below."""
    words, data = [], path.read_bytes()
    place = 0
    while len(words) < 4:
        end = next((k for k in range(place, min(len(data), place + 100)) if data[k : k + 1].isspace()), None)
        if end is None:
            raise TracerError(f"{path}: is not a PFM picture")
        if end > place:
            words.append(data[place:end])
        place = end + 1
    try:
        channels = {b"PF": 3, b"Pf": 1}[words[0]]
        width, height, scale = int(words[1]), int(words[2]), float(words[3])
    except (KeyError, ValueError):
        raise TracerError(f"{path}: is not a PFM picture") from None
    size = width * height * channels
    if width < 1 or height < 1 or not np.isfinite(scale) or scale == 0.0 or len(data) - place < 4 * size:
        raise TracerError(f"{path}: holds less than its header says, or its header is wrong")
    values = np.frombuffer(data, "<f4" if scale < 0.0 else ">f4", size, place)
    return StoredPicture(_linear(values.reshape(height, width, channels)[::-1], path, dtype))


def _read_other(path, dtype, raw):
    """What pillow knows, 8 or 16 bits, as sRGB unless `raw`."""
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(path) as image:
            if image.mode.startswith("I;16") or image.mode in ("I", "F"):
                values = np.asarray(image, np.float64)
                values = np.clip(values / (65535.0 if image.mode != "F" else 1.0), 0.0, None)
            else:
                values = np.asarray(image.convert("RGB"), np.float64) / 255.0
    except (UnidentifiedImageError, Image.DecompressionBombError, SyntaxError, ValueError):
        known = ", ".join((*FORMATS, ".pfm", ".ppm"))
        raise TracerError(f"{path}: is not a picture that can be read; use {known}") from None
    return StoredPicture(_linear(values if raw else from_srgb(values), path, dtype), eight_bits=True)


def _read_exr(path, dtype):
    with path.open("rb") as file:
        mark = file.read(4)
    if mark != b"\x76\x2f\x31\x01":
        raise TracerError(f"{path}: is not an OpenEXR picture")
    import OpenEXR

    try:
        with _silence(), OpenEXR.File(str(path), separate_channels=True) as file:
            header = dict(file.header())  # the file empties it when it is closed
            channels = {name: np.array(channel.pixels) for name, channel in file.channels().items()}
    except (RuntimeError, ValueError, TypeError, KeyError):
        raise TracerError(f"{path}: is damaged, or a kind of OpenEXR that cannot be read") from None
    names = next((n for n in (("R", "G", "B"), ("Y", "Y", "Y")) if set(n) <= channels.keys()), None)
    if names is None:
        raise TracerError(f"{path}: has no channels R, G, B, only {', '.join(sorted(channels))}")
    notes = {}
    for name, value in header.items():
        if name.startswith(PREFIX) and name != MARK:
            with contextlib.suppress(ValueError, TypeError):
                notes[name.removeprefix(PREFIX)] = json.loads(value)
    variance = samples = None
    if MARK in header and {"samples", *(f"variance.{c}" for c in "RGB")} <= channels.keys():
        variance = _linear(np.stack([channels[f"variance.{c}"] for c in "RGB"], axis=2), path, np.float32)
        samples = channels["samples"].astype(np.int64)
    rgb = _linear(np.stack([channels[name] for name in names], axis=2), path, dtype)
    return StoredPicture(rgb, variance, samples, notes=notes)


@contextlib.contextmanager
def _silence():
    """OpenEXR prints what it finds wrong, from C and from Python; our one line says it."""
    import sys

    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        with contextlib.redirect_stdout(io.StringIO()):
            yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
