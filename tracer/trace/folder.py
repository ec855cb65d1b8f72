"""The folder of a recording: what lies in it, how it grows part by part, and what is refused.

    recording.json   level, settings, names, parts, scene, fingerprint
    scene.json       what the scene was made from; files/ has its meshes and pictures
    part-00000/      paths.parquet, and at level "events" one file for each kind of event
    *.partial        what is being written, or was when its writer was killed; removed by the next one

A part is written as .partial, flushed to the disk and then renamed, so what has its name is whole.
"""

import json
import os
import shlex
import shutil
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from tracer.events import KINDS
from tracer.settings import Settings, TracerError

FORMAT = 1
HEADER = "recording.json"
PARTIAL = ".partial"
LEVELS = ("paths", "events")
MOST_PARTS = 99_999
MOST_HEADER = 1 << 26  # bytes
NEEDED = ("level", "parts", "lanes", "settings", "scene", "fingerprint", "names")


@dataclass(frozen=True)
class Folder:
    """A recording's folder and what its header says."""

    path: Path
    header: dict

    @property
    def level(self):
        """ "paths" or "events"."""
        return self.header["level"]

    @property
    def parts(self):
        """How many parts the whole recording has."""
        return self.header["parts"]

    @property
    def kinds(self):
        """The kinds of event of which it has files."""
        return KINDS if self.level == "events" else ()

    @cached_property
    def settings(self):
        """The Settings it was made with."""
        return Settings(**self.header["settings"])

    def part(self, number):
        """Where a part lies."""
        return self.path / f"part-{number:05d}"

    def file(self, number, table):
        """A part's file of paths or of a kind of event."""
        return self.part(number) / f"{table}.parquet"

    def files(self, table):
        """The files of all parts."""
        return [self.file(number, table) for number in range(self.parts)]

    def missing(self):
        """Numbers of the parts that are not there yet."""
        return [number for number in range(self.parts) if not self.part(number).is_dir()]

    def bytes(self):
        """Size of all its files."""
        return sum(file.stat().st_size for file in self.path.rglob("*") if file.is_file())


def opened(path):
    """The Folder of a recording. Raises TracerError where there is none, or one of another format."""
    path = Path(path)
    if not path.is_dir():
        what = "is a file" if path.exists() else "is not there"
        raise TracerError(
            f"{path}: {what}; a recording is a folder, made by castray render SCENE --record DIR"
        )
    file = path / HEADER
    try:
        if file.stat().st_size > MOST_HEADER:
            raise TracerError(f"{file}: is too large to be a recording's")
        header = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise TracerError(f"{path}: holds no recording (no {HEADER})") from None
    except OSError as error:
        raise TracerError(f"{file}: cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise TracerError(f"{file}: is not the JSON of a recording: {error}") from None
    _check(file, header)
    return Folder(path, header)


def _check(file, header):
    """TracerError unless a header is one of this format."""
    if not isinstance(header, dict) or "format" not in header:
        raise TracerError(f"{file}: is not the header of a recording (it names no format)")
    if header["format"] != FORMAT:
        raise TracerError(f"{file}: is of format {header['format']!r}; this castray reads format {FORMAT}")
    absent = [name for name in NEEDED if name not in header]
    if absent:
        raise TracerError(f"{file}: says nothing of {absent[0]}")
    if header["level"] not in LEVELS:
        raise TracerError(f"{file}: level {header['level']!r} is not known; there are {', '.join(LEVELS)}")
    if type(header["parts"]) is not int or not 1 <= header["parts"] <= MOST_PARTS:
        raise TracerError(f"{file}: parts {header['parts']!r} is not a number of parts")
    for name in ("settings", "scene", "fingerprint", "names"):
        if not isinstance(header[name], dict):
            raise TracerError(f"{file}: {name} is not a table")
    try:
        Settings(**header["settings"])
    except (TracerError, TypeError) as error:
        raise TracerError(f"{file}: settings: {error}") from None


def whole(path):
    """The Folder of a recording of which every part is there. Raises TracerError."""
    folder = opened(path)
    missing = folder.missing()
    if missing:
        raise TracerError(
            f"{path}: only {folder.parts - len(missing)} of {folder.parts} parts are there; "
            "the castray render --record that began it goes on where it was"
        )
    for table in ("paths", *(kind.name for kind in folder.kinds)):
        for file in folder.files(table):
            check_file(file)
    return folder


def check_file(file):
    """TracerError unless a file begins and ends as Parquet files do: one that was cut off does not."""
    try:
        with open(file, "rb") as stream:
            begins = stream.read(4)
            stream.seek(-4, os.SEEK_END)
            ends = stream.read(4)
    except FileNotFoundError:
        raise TracerError(f"{file}: is not there") from None
    except OSError:  # shorter than that
        begins = ends = b""
    if begins != b"PAR1" or ends != b"PAR1":
        raise TracerError(f"{file}: is no whole Parquet file (cut off?)")


def begin(path, header, put):
    """The Folder at `path` for a recording with this header, a new one or the same begun before.

    put(folder) puts in what belongs beside the header. Raises TracerError where something else is there.
    """
    path = Path(path)
    if (path / HEADER).exists():
        return _same(opened(path), header)
    try:
        path.mkdir(exist_ok=True)
        others = [entry.name for entry in path.iterdir() if not entry.name.endswith(PARTIAL)]
        if set(others) - {"scene.json", "files"}:
            raise TracerError(f"{path}: has other things in it ({others[0]}); choose a new folder")
        put(path)
        beside = path / f"{HEADER}{PARTIAL}"
        beside.write_text(json.dumps(header, indent=1), encoding="utf-8")
        flush(beside)
        beside.rename(path / HEADER)
        flush(path)
    except OSError as error:
        raise TracerError(f"{path}: cannot be made a recording's folder: {error.strerror or error}") from None
    return Folder(path, header)


def _same(folder, header):
    """The folder, if a recording with that header was begun in it; TracerError with the first difference."""
    there = folder.header
    for name in ("level", "settings", "scene", "fingerprint", "names"):
        if there[name] != (asked := json.loads(json.dumps(header[name]))):
            raise TracerError(f"{folder.path}: {difference(name, there[name], asked)}; choose another folder")
    remove_unfinished(folder.path)
    return folder


def difference(name, there, asked, what="a recording"):
    """What is different about something that is there, in words."""
    if not isinstance(there, dict):
        return f"holds {what} of {name} {there}, not {asked}"
    keys = [key for key in {**there, **asked} if there.get(key) != asked.get(key)]
    if name == "scene":
        return f"holds {what} of another scene or another state of it ({there.get('name')})"
    return f"holds {what} with {name} {keys[0]} {there.get(keys[0])!s:.60}, not {asked.get(keys[0])!s:.60}"


def remove_unfinished(path):
    """Take away what a killed writer left behind."""
    for entry in path.iterdir():
        if entry.name.endswith(PARTIAL):
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink()


def flush(path):
    """Have a file or folder written to the disk."""
    if path.is_dir() and os.name == "nt":  # there folders cannot be opened
        return
    handle = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def view_command(folder, place):
    """`castray view` of a recording at (x, y, sample, step); without a step at the start of the path."""
    return f"castray view {at(folder, place)}"


def at(what, place):
    """A recording's folder, or another tracer's file, and (x, y, path, event) in it, as a person types it."""
    x, y, path, event = place
    return shlex.quote(f"{what}#x={x}&y={y}&path={path}&event={event or 0}")
