"""What a file holds of a picture."""

from dataclasses import dataclass, field

import numpy as np

PREFIX = "castray."  # of our entries in the header of an .exr
MARK = PREFIX + "variance"  # other programs' variance channels mean other things: only ours are believed


@dataclass(frozen=True)
class StoredPicture:
    """A picture that was read from a file."""

    rgb: np.ndarray  # (H, W, 3) float32, linear
    variance: np.ndarray | None = None  # (H, W, 3) float32, of each pixel's mean; None if the file has none
    samples: np.ndarray | None = None  # (H, W) samples that went into each pixel
    eight_bits: bool = False  # from 8-bit sRGB: rounded, and nothing above 1
    notes: dict = field(default_factory=dict)  # what its header says: settings, scene, ...
