"""Colours that vary over a surface. One file per texture; each is a definition in float64 that offers:

    mean() -> (3,)          average colour, for drawings and for what a material says of itself as a whole
    astype(dtype)           the same in another precision
    at(uv) -> (3, N)        linear RGB at coordinates (2, N), from 0 to 1 per channel

Coordinates are those of the surface (see tracer.shape.chart), moved by `to_uv`, the upper two rows of an
affine map: u' = m_00 u + m_01 v + m_02. Adding a texture: its file, its name in ALL, and its words in
tracer/scene_file/textures.py.
"""

from tracer.texture.bitmap import Bitmap
from tracer.texture.checkerboard import Checkerboard

ALL = (Bitmap, Checkerboard)
