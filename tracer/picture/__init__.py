"""Pictures on disk: OpenEXR keeps all, NumPy the linear numbers, PNG is for looking at.

An .exr of castray has the channels R, G, B, variance.R, variance.G, variance.B (variance of each pixel's
mean) and samples (how many a pixel has), and in its header castray.settings and other notes as JSON.
"""

from tracer.picture.reading import is_picture, read
from tracer.picture.srgb import from_srgb, to_srgb
from tracer.picture.stored import StoredPicture
from tracer.picture.writing import FORMATS, check_path, check_place, write, write_whole

__all__ = [
    "FORMATS",
    "StoredPicture",
    "check_path",
    "check_place",
    "from_srgb",
    "is_picture",
    "read",
    "to_srgb",
    "write",
    "write_whole",
]
