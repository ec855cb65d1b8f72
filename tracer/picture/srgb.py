"""Between linear radiance and what screens and 8-bit files hold (IEC 61966-2-1)."""

import numpy as np


def to_srgb(rgb, exposure=0.0):
    """Linear (..., 3) to 8-bit sRGB (IEC 61966-2-1); exposure in stops; clipped, NaN black."""
    linear = np.clip(np.nan_to_num(rgb * 2.0**exposure, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return (255.0 * curve + 0.5).astype(np.uint8)


def from_srgb(values):
    """sRGB (...) from 0 to 1, any floating point, to linear (IEC 61966-2-1)."""
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0.0) + 0.055) / 1.055) ** 2.4)
