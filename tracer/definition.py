"""What a scene file says, before it is made ready for a precision."""

from typing import NamedTuple

import numpy as np


class Surface(NamedTuple):
    """One shape with what covers it."""

    shape: object
    bsdf: str  # name of its material
    radiance: np.ndarray | None = None  # (3,) if it shines
    interior: np.ndarray | None = None  # (3,) share of the light lost per metre in what fills it


class Definition(NamedTuple):
    """What a scene file says, in float64."""

    name: str
    surfaces: tuple
    bsdfs: dict  # name -> material
    camera: object
    width: int
    height: int
    source: tuple | None = None  # the description it was made from, and the folder of its files
    emitters: tuple = ()  # lights that are no shapes
    media: object = None  # medium.Media of the surfaces, None where nothing is filled
    textures: dict = {}  # name of a material -> {parameter: texture}
    unchanged: tuple | None = None  # the source before its words were changed, None where none was
    changes: dict = {}  # the words said differently since, {"OBJECT.WORD": value}
