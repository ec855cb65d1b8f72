"""Pictures that scenes name: what lights them, and what is painted on them."""

import numpy as np

from tracer.picture import read as read_picture
from tracer.scene_file.words import shown
from tracer.settings import TracerError


def read(filename, place, folder, raw=False):
    """A linear picture (H, W, 3) in float64. raw: numbers of files in sRGB stay as they are.

    Raises TracerError naming the place.
    """
    if not isinstance(filename, str):
        raise TracerError(f"{place}: {shown(filename)} is not the name of a file")
    try:
        return read_picture(folder / filename, np.float64, raw).rgb
    except TracerError as error:
        raise TracerError(f"{place}: {error}") from None
