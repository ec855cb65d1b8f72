"""Two pictures compared as far as what is known of them allows, and where to look if they differ."""

import os
from dataclasses import dataclass, fields

import numpy as np

from tracer.picture import read
from tracer.settings import Settings, TracerError, both_told
from tracer.testing.errorbars import settings_of, why_unknown
from tracer.testing.errors import Errors, errors
from tracer.testing.ztest import ALPHA, Comparison, z_test

CHANNELS = ("red", "green", "blue")


@dataclass(frozen=True)
class Verdict:
    """What can be said of two pictures."""

    same: bool  # but for noise; but for rounding where no p-value is possible
    errors: Errors
    z: Comparison | None  # None where no p-value is possible
    notes: tuple  # sentences to read with it
    reasons: tuple  # why they are not the same
    look: str  # the command that shows the worst pixel of the first picture

    @property
    def worst(self):
        """x, y, channel of the pixel to look at first."""
        if self.z is None or not self.z.p_value < self.z.alpha:
            return self.errors.worst
        if min(self.z.p_pixel, self.z.p_constant) < self.z.alpha:
            return self.z.worst
        return self.z.centre

    def __str__(self):
        return "\n".join((*self.reasons, *self.notes, self.look))


def compare(a, b, alpha=ALPHA, names=("the first", "the second"), scene=None):
    """The Verdict on two pictures with .rgb, and .variance and .samples where they are known.

    names: what to call them. scene: what `castray inspect` would take, where the pictures do not say it.
    Raises TracerError where their sizes differ.
    """
    distance = errors(a, b)
    without = {n: why for n, p in zip(names, (a, b), strict=True) if (why := why_unknown(p))}
    z = None if without else z_test(a, b, alpha)
    notes = tuple(_notes(a, b, names, distance, z, without))
    same = distance.equal or (z is not None and z.same)
    reasons = () if same else tuple(_reasons(distance, z))
    verdict = Verdict(same, distance, z, notes, reasons, "")
    x, y, _ = verdict.worst
    return Verdict(same, distance, z, notes, reasons, _command(a, x, y, scene))


def assert_same_picture(a, b, alpha=ALPHA, scene=None):
    """AssertionError unless two pictures are the same but for noise; it says how and where to look.

    a, b: pictures with .rgb, .variance and .samples, or files of such (.exr of tracer.write keeps all), from
    different seeds; where no variance is known they must be equal but for rounding. alpha: chance that two
    right pictures fail. Raises TracerError where sizes differ, and for what is no picture.
    """
    verdict = compare(_picture(a), _picture(b), alpha, scene=scene)
    if not verdict.same:
        raise AssertionError(f"the pictures differ\n{verdict}")


def _picture(given):
    """A picture, read if it is a file."""
    if isinstance(given, (str, os.PathLike)):
        return read(given)
    if not hasattr(given, "rgb"):
        raise TracerError(
            f"a {type(given).__name__} is no picture with .rgb: give what tracer.render returns, or a file"
        )
    return given


def _notes(a, b, names, distance, z, without):
    for name, why in without.items():
        yield f"No p-value is possible, because of {name}: {why}."
    if distance.unit == "sRGB":
        yield "Compared as 8-bit sRGB, which rounds, and cuts what is brighter than 1."
    if distance.turned:
        yield f"With the second picture {distance.turned}, they are much closer."
    first, second = settings_of(a), settings_of(b)
    if first and second:
        odd = [
            k
            for k in first
            if k in second and first[k] != second[k] and k not in ("seed", "spp", "replicates")
        ]
        if odd:
            yield f"Settings differ: {both_told(first, second, odd)}."
        if z is not None and first["seed"] == second["seed"] and not distance.rmse == 0.0:
            yield f"Both have the seed {first['seed']}: their noise is partly the same, and p-values are off."
    if z is not None and z.unknown:
        yield f"{z.unknown} pixels have no known variance (one sample, or not finite) and were not tested."


def _reasons(distance, z):
    x, y, channel = distance.worst
    if distance.not_finite:
        yield f"{distance.not_finite} pixels are not finite in one of them, or differently so."
    if z is None:
        yield (
            f"RMSE {distance.rmse:.4g} ({distance.unit}), most {distance.most:.4g} at pixel ({x}, {y}), "
            f"{CHANNELS[channel]}."
        )
        return
    if z.p_bias < z.alpha:
        worst = int(np.argmax(np.abs(z.Z)))
        yield (
            f"The first is {'brighter' if z.Z[worst] > 0 else 'darker'} on the whole: Z = {z.Z[worst]:.2f} "
            f"in {CHANNELS[worst]} (bias {z.bias[worst]:+.4g} +- {z.bound[worst]:.2g}), p = {z.p_bias:.2g}."
        )
    if z.p_pixel < z.alpha:
        x, y, channel = z.worst
        yield (
            f"Pixel ({x}, {y}) is off by {z.z[y, x, channel]:+.2f} standard errors in {CHANNELS[channel]}: "
            f"p = {z.p_pixel:.2g} after correction for {z.tested} tests."
        )
    if z.p_constant < z.alpha:
        yield f"Pixels that do not vary differ by more than rounding: p = {z.p_constant:.2g}."
    x0, y0, x1, y1 = z.region
    yield f"The region from ({x0}, {y0}) to ({x1 - 1}, {y1 - 1}) is furthest off: Z = {z.region_Z:.2f}."


def _command(picture, x, y, scene):
    """The `castray inspect` that shows a pixel as the picture was made."""
    notes, settings = getattr(picture, "notes", {}), settings_of(picture) or {}
    height, width = picture.rgb.shape[:2]
    words = ["castray inspect", str(scene or notes.get("scene") or "SCENE"), f"--size {width} {height}"]
    for f in fields(Settings):
        value = settings.get(f.name, f.default)
        if f.name not in ("width", "height") and value != f.default:
            name = f.name.replace("_", "-")
            words.append(f"--no-{name}" if value is False else f"--{name} {value}")
    return " ".join((*words, f"--pixel {x} {y}"))
