"""Complex indices of refraction of metals: published measurements, read at three wavelengths.

Gold, silver and copper by Johnson and Christy 1972, aluminium by Rakic 1995: wavelength in nm, n, k, the part
around the three wavelengths. Those are the dominant wavelengths of the primaries of linear sRGB, where n and
k are interpolated along the wavelength. One wavelength per channel is an approximation: the colour of a
metal under white light would need an integral over the spectrum.
"""

import numpy as np

WAVELENGTHS = (611.4, 549.1, 464.2)  # nm: red, green, blue

_MEASURED = {
    "Au": (
        (450.9, 1.38, 1.914), (471.4, 1.31, 1.849), (495.9, 1.04, 1.833), (520.9, 0.62, 2.081),
        (548.6, 0.43, 2.455), (582.1, 0.29, 2.863), (616.8, 0.21, 3.272),
    ),
    "Ag": (
        (450.9, 0.04, 2.657), (471.4, 0.05, 2.869), (495.9, 0.05, 3.093), (520.9, 0.05, 3.324),
        (548.6, 0.06, 3.586), (582.1, 0.05, 3.858), (616.8, 0.06, 4.152),
    ),
    "Cu": (
        (450.9, 1.24, 2.397), (471.4, 1.25, 2.483), (495.9, 1.22, 2.564), (520.9, 1.18, 2.608),
        (548.6, 1.02, 2.577), (582.1, 0.70, 2.704), (616.8, 0.30, 3.205),
    ),
    "Al": (
        (442.80, 0.60790, 5.3676), (476.87, 0.72780, 5.7781), (516.60, 0.87340, 6.2418),
        (563.57, 1.0728, 6.7839), (619.93, 1.3660, 7.4052),
    ),
}  # fmt: skip
METALS = tuple(_MEASURED)


def index_of(name):
    """eta (3,) and k (3,) of a metal in METALS."""
    nm, n, k = np.array(_MEASURED[name]).T
    return np.interp(WAVELENGTHS, nm, n), np.interp(WAVELENGTHS, nm, k)
