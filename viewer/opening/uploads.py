"""Files that come from the page: of which kinds, how large, and what each becomes.

They are written into a folder of their own that is gone afterwards; a scene among them may name no others.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tracer
from tracer.settings import TracerError
from viewer.comparing.rival import Rival
from viewer.opening.given import Given, of_log
from viewer.passing import passing

MEGABYTE = 1 << 20
LARGEST = {
    **dict.fromkeys((".toml", ".xml"), MEGABYTE),
    ".jsonl": 32 * MEGABYTE,
    **dict.fromkeys((".png", ".jpg", ".exr", ".hdr", ".npy", ".pfm", ".ppm"), 16 * MEGABYTE),
}  # bytes
MOST_PIXELS = 1 << 22  # of a picture
LONGEST_NAME = 64
MOST_BYTES = 200  # of a name: file systems have 255


@dataclass(frozen=True)
class Upload:
    """name: as it is shown; one of scene, given, rival is there."""

    name: str
    scene: Any = None
    given: Given | None = None
    rival: Rival | None = None


def named(name):
    """A file's name from outside: its last part, of letters, digits, _ and -. Raises TracerError for a kind
    that is not opened."""
    name = re.split(r"[\\/]", str(name))[-1]
    ending = Path(name).suffix.lower()
    if ending not in LARGEST:
        raise TracerError(f"open: {name[:40]!r} is none of the files that are opened: {', '.join(LARGEST)}")
    stem = re.sub(r"[^\w-]+", "_", name[: -len(ending)])[:LONGEST_NAME]
    short = stem.encode()[:MOST_BYTES].decode(errors="ignore")
    return (short.strip("_") or "file") + ending


def check_size(name, size):
    """TracerError for a file that is too large."""
    most = LARGEST[Path(name).suffix]
    if size > most:
        raise TracerError(f"open: {name} is larger than {most // MEGABYTE} MB")


def opened(name, data, scene):
    """The Upload in the bytes of a file of that (harmless) name; scene: the one that a log is of. Raises
    TracerError, which names no folder."""
    with passing(name, data) as file:
        return _READERS.get(file.suffix, _picture)(file, scene)


def _scene(file, scene):
    loaded = tracer.load(file, alone=True)
    if loaded.name in tracer.built_in_scenes():
        raise TracerError(f"open: {loaded.name} is the name of a scene that comes with castray; rename yours")
    return Upload(file.name, scene=loaded)


def _log(file, scene):
    return Upload(file.name, given=of_log(file, scene, file.name))


def _picture(file, scene):
    width, height = _size(file)
    if width * height > MOST_PIXELS:
        raise TracerError(f"open: {file.name} has {width} x {height} pixels, more than {MOST_PIXELS}")
    return Upload(file.name, rival=Rival(file.name, picture=tracer.read(file), data=file.read_bytes()))


def _size(file):
    """Width and height by the header alone, of what may be packed small; else (0, 0): the file is as
    large."""
    if file.suffix == ".exr":
        import OpenEXR

        try:
            with OpenEXR.File(str(file), header_only=True) as there:
                (left, top), (right, bottom) = (tuple(map(int, c)) for c in there.header()["dataWindow"])
        except (RuntimeError, ValueError, TypeError, KeyError):
            return 0, 0  # the reader says what is wrong
        return right - left + 1, bottom - top + 1
    if file.suffix in (".png", ".jpg", ".ppm"):
        from PIL import Image

        try:
            with Image.open(file) as image:
                return image.size
        except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
            return 0, 0
    return 0, 0


_READERS = {".toml": _scene, ".xml": _scene, ".jsonl": _log}
