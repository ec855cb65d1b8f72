"""How far two pictures are apart, with no word on whether that is noise."""

from dataclasses import dataclass

import numpy as np

from tracer.picture import to_srgb
from tracer.picture.turns import TURNS
from tracer.settings import TracerError

SMALL = 0.01  # of relMSE, as most papers on path guiding have it: keeps black pixels from deciding
ROUNDING = 1e-5  # relative: what differs by less is rounding of float32 paths


@dataclass(frozen=True)
class Errors:
    """Distances of a from b, the reference, over pixels and channels that are finite in both."""

    rmse: float  # sqrt(mean((a - b)^2))
    rel_mse: float  # mean((a - b)^2 / (b^2 + 0.01))
    mean: tuple  # (3,) mean of a - b
    most: float  # largest |a - b|
    worst: tuple  # x, y, channel of that
    equal: bool  # but for rounding
    not_finite: int  # pixels that are not finite in one of them, or differently so
    turned: str | None  # how b must be turned to look like a, if that brings them much closer
    unit: str  # "radiance", or "sRGB" from 0 to 1 where one picture has 8 bits


def errors(a, b):
    """The Errors of two pictures with .rgb (H, W, 3). Where one has 8 bits, both are compared as such."""
    unit = "sRGB" if getattr(a, "eight_bits", False) or getattr(b, "eight_bits", False) else "radiance"
    a, b = a.rgb, b.rgb
    if a.shape != b.shape:
        (h, w, _), (k, v, _) = a.shape, b.shape
        lying = ", which is the same on its side" if (h, w) == (v, k) != (k, v) else ""
        raise TracerError(f"sizes differ: {w} x {h} and {v} x {k}{lying}")
    if unit == "sRGB":
        a, b = to_srgb(a) / 255.0, to_srgb(b) / 255.0
    a, b = a.astype(np.float64), b.astype(np.float64)
    finite = np.isfinite(a) & np.isfinite(b)
    alike = (a == b) | (np.isnan(a) & np.isnan(b))
    with np.errstate(all="ignore"):
        difference = np.where(finite, a - b, 0.0)
        count = max(int(finite.sum()), 1)
        squared = difference**2
        rel_mse = np.where(finite, squared / (b * b + SMALL), 0.0).sum() / count
    rmse = float(np.sqrt(squared.sum() / count))
    y, x, channel = np.unravel_index(np.argmax(np.abs(difference)), difference.shape)
    return Errors(
        rmse=rmse,
        rel_mse=float(rel_mse),
        mean=tuple(map(float, difference.sum(axis=(0, 1)) / np.maximum(finite.sum(axis=(0, 1)), 1))),
        most=float(np.abs(difference[y, x, channel])),
        worst=(int(x), int(y), int(channel)),
        equal=bool((alike | (np.abs(difference) <= ROUNDING * np.fmax(np.abs(a), np.abs(b))) & finite).all()),
        not_finite=int((~finite & ~alike).any(axis=2).sum()),
        turned=_turned(a, b),
        unit=unit,
    )


def _turned(a, b):
    """The turn of b that at least halves the distance, if one does.

    As seen on a screen, so that a few bright noisy pixels do not decide.
    """
    a, b = to_srgb(a).astype(np.float64), to_srgb(b).astype(np.float64)
    found = {name: float(np.mean((a - turn(b)) ** 2)) for name, turn in TURNS.items()}
    name = min(found, key=lambda turn: found[turn])
    return name if found[name] < 0.25 * float(np.mean((a - b) ** 2)) else None
