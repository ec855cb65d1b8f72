"""The vocabulary of textures, in Mitsuba's words."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from tracer.scene_file import picture_file
from tracer.scene_file.to_world import to_world
from tracer.scene_file.words import Words, colour, listed, one_of, shown, switch
from tracer.settings import TracerError
from tracer.shape.chart import LARGEST
from tracer.texture import Bitmap, Checkerboard
from tracer.texture.bitmap import FILTERS, WRAPS

TEXTURES = ("bitmap", "checkerboard")


class Sources(NamedTuple):
    """What descriptions of materials may refer to."""

    bsdfs: dict = {}  # descriptions by name
    textures: dict = {}  # textures by name
    folder: Path = Path()  # where pictures are looked for

    def is_texture(self, value):
        """Whether a value stands for a texture, as one or as a reference to one."""
        return isinstance(value, dict) and value.get("type") in (*TEXTURES, "ref")


def texture(description, place, sources):
    """A texture from its description, or from a reference to one."""
    table = Words(description, place)
    kind = table.take("type")
    if kind == "ref":
        name = table.take("id")
        table.finish()
        if not isinstance(name, str) or name not in sources.textures:
            known = listed(sources.textures) or "none"
            raise TracerError(f"{place}: no texture {shown(name)} in this scene; there are {known}")
        return sources.textures[name]
    made = _checkerboard(table) if kind == "checkerboard" else _bitmap(table, sources.folder)
    table.finish()
    return made


def _checkerboard(table):
    first, second = (
        colour(table.take(word, default), f"{table.place}.{word}", 1.0)
        for word, default in (("color0", 0.4), ("color1", 0.2))
    )
    return Checkerboard(first, second, _to_uv(table))


def _bitmap(table, folder):
    filename, place = table.take("filename"), f"{table.place}.filename"
    filter_type = one_of(table, "filter_type", FILTERS)
    wrap_mode = one_of(table, "wrap_mode", WRAPS)
    image = picture_file.read(filename, place, folder, switch(table, "raw", False))
    bad = np.argwhere(~((image >= 0.0) & (image <= 1.0)).all(axis=2))
    if bad.size:
        row, column = bad[0]
        values = ", ".join(f"{value:g}" for value in image[row, column])
        raise TracerError(
            f"{place}: {filename} has {values} in row {row}, column {column}; a surface reflects from 0 to 1"
        )
    return Bitmap(np.ascontiguousarray(image.transpose(2, 0, 1)), _to_uv(table), filter_type, wrap_mode)


def _to_uv(table):
    """The two rows (2, 3) that move u and v."""
    place = f"{table.place}.to_uv"
    rows = to_world(table.take("to_uv", []), place)[:2, [0, 1, 3]]
    if not (np.abs(rows) <= LARGEST).all():
        raise TracerError(
            f"{place}: moves coordinates by more than {LARGEST:g}, where no digit is left for them"
        )
    return rows
