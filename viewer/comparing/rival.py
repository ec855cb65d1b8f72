"""What the picture is compared with: another tracer of the same scene, a recording, or a picture's file."""

from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import tracer
from lessons.zoo import ZOO
from tracer.picture import StoredPicture
from tracer.settings import TracerError
from tracer.trace import folder
from tracer.trace.reading import picture as recorded_picture
from tracer.trace.stored_scene import restore
from viewer.link import RIGHT
from viewer.passing import passing
from viewer.recorded import is_recording


@dataclass(frozen=True)
class Rival:
    """name: a bug's id, RIGHT, or what was typed; scene, settings: None where no path can be traced again;
    picture: with .rgb, None where it is yet to be rendered; data: the bytes of a file that came from the page
    and lies nowhere."""

    name: str
    scene: Any = None
    settings: tracer.Settings | None = None
    picture: Any = None
    data: bytes | None = None

    def file(self):
        """Where a picture's file is, for as long as the block lasts."""
        return nullcontext(self.name) if self.data is None else passing(self.name, self.data)

    @property
    def traced(self):
        """Whether its paths can be traced again."""
        return self.settings is not None


def known(name):
    """Whether a name stands for a tracer of whatever scene is shown: right, or with some bugs."""
    return name == RIGHT or all(bug.strip() in ZOO for bug in name.split(","))


def of_scene(name, scene, settings):
    """The Rival that traces the same scene with a bug, or right."""
    return Rival(name, scene, replace(settings, bug=None if name == RIGHT else name))


def of_file(text):
    """The Rival in a recording's folder or a picture's file. Raises TracerError."""
    if is_recording(text):
        place = folder.whole(text)
        scene = restore(place.path, place.header["scene"]["name"])
        return Rival(text, scene, place.settings, StoredPicture(recorded_picture(place)))
    if text.lower().endswith(".jsonl"):
        raise TracerError(f"compare: {text} is a log, which has no picture; castray twin compares logs")
    if not Path(text).exists():
        raise TracerError(
            f"compare: {text!r} is neither a bug of the zoo, nor {RIGHT!r}, nor the file of a picture, nor a "
            "recording's folder"
        )
    return Rival(text, picture=tracer.read(text))


def fitted(settings, there):
    """The settings at the size of a Rival's picture. Raises TracerError where another size was asked for."""
    height, width = there.picture.rgb.shape[:2]
    if settings.width is None:
        return replace(settings, width=width, height=height)
    if (settings.width, settings.height) != (width, height):
        raise TracerError(
            f"compare: {there.name} has {width} x {height} pixels and the picture {settings.width} x "
            f"{settings.height}; give --size {width} {height}"
        )
    return settings
