"""`castray diff` in words, as JSON and as a map."""

from dataclasses import asdict

import numpy as np
from rich.cells import cell_len

from tracer.picture import to_srgb
from tracer.testing.compare import CHANNELS
from viewer.words import Speaker

FULL = 5.0  # standard errors at which the map's colours are full
# From a darker than b through grey to a brighter than b; ColorBrewer's RdBu would be white in the middle,
# and white is what a screen shows where nothing was drawn.
BLUE, GREY, RED = np.array([[0.10, 0.35, 0.95], [0.04, 0.04, 0.04], [1.00, 0.35, 0.05]])
SIDE, GAP = 384, 6  # pixels: of a panel of the map at least, and between its parts
ODD = np.array([1.0, 1.0, 0.0])  # cannot be compared


def lines(verdict, names):
    """What `castray diff` prints of a Verdict on the pictures with these names."""
    say, distance = Speaker(), verdict.errors
    yield say("diff." + ("different" if not verdict.same else "noise" if verdict.z else "same"))
    yield from map(say.error, (*verdict.reasons, *verdict.notes))
    yield ""
    yield say("diff.of", a=names[0], b=names[1], unit=distance.unit)
    yield _row("RMSE", f"{distance.rmse:.6g}")
    yield _row("relMSE", f"{distance.rel_mse:.6g}   {say('diff.rel_mse')}")
    yield _row(say("diff.largest"), f"{distance.most:.6g}   {_at(distance.worst, say)}")
    yield _row(say("diff.mean"), _three(distance.mean, "+.6g"))
    if verdict.z is not None:
        yield from _test_lines(verdict.z, say)
    if not verdict.same:
        yield ""
        yield verdict.look


def _row(name, said):
    """A line of the table: what it is, and its number from the 32nd column on."""
    return name + " " * max(1, 31 - cell_len(name)) + said


def _at(worst, say):
    x, y, channel = worst
    return say("diff.at", x=x, y=y, channel=say(f"channel.{CHANNELS[channel]}"))


def _test_lines(z, say):
    x, y, channel = z.worst
    yield _row(say("diff.bias"), f"{_three(z.Z, '+.2f')}   p = {z.p_bias:.3g}")
    yield _row(say("diff.weighed"), f"{_three(z.bias, '+.3g')}   +- {_three(z.bound, '.2g')}")
    off = f"{abs(z.z[y, x, channel]):.2f}   {_at(z.worst, say)}; p = {z.p_pixel:.3g}"
    yield _row(say("diff.largest_z", n=z.tested), off)
    yield _row(say("diff.all"), f"{z.p_value:.3g}   {say('diff.alpha', alpha=f'{z.alpha:g}')}")


def _three(values, spec):
    return " ".join(format(v, spec) for v in values)


def as_dict(verdict, names):
    """The JSON of `castray diff`.

    a, b: the files. same: the verdict. p_value: null where none is possible; alpha: what it is held against.
    errors: rmse, rel_mse (mean of (a - b)^2 / (b^2 + 0.01)), mean (3, of a - b), most, worst [x, y, channel],
    equal (but for rounding), not_finite (pixels), turned (how b must be turned to fit, or null), unit.
    test (null without p-value): Z, bias, bound (3 each), p_bias, max_z, worst [x, y, channel], p_pixel,
    p_constant, tested, unknown, region [x0, y0, x1, y1], region_Z, shape: sum_z, chi2_p, ks_p (3 each).
    notes, reasons: sentences. look: the command that shows the pixel to look at.
    """
    z = verdict.z
    return _plain(
        {
            "a": names[0],
            "b": names[1],
            "same": verdict.same,
            "p_value": None if z is None else z.p_value,
            "alpha": None if z is None else z.alpha,
            "errors": asdict(verdict.errors),
            "test": None if z is None else _test_dict(z),
            "notes": verdict.notes,
            "reasons": verdict.reasons,
            "look": verdict.look,
        }
    )


def _test_dict(z):
    kept = ("Z", "bias", "bound", "p_bias", "worst", "p_pixel", "p_constant", "tested", "unknown", "region")
    x, y, channel = z.worst
    return {
        **{name: getattr(z, name) for name in kept},
        "max_z": abs(z.z[y, x, channel]),
        "region_Z": z.region_Z,
        "shape": z.shape,
    }


def _plain(value):
    """Only what JSON knows; null for what is not finite."""
    if isinstance(value, dict):
        return {name: _plain(part) for name, part in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(part) for part in value]
    if isinstance(value, (bool, np.bool_)) or value is None or isinstance(value, (str, int)):
        return bool(value) if isinstance(value, np.bool_) else value
    return float(value) if np.isfinite(value) else None


def drawing(a, b, verdict):
    """The map in linear RGB: blue where a is darker, red where it is brighter, yellow where not finite.

    Where p-values are possible: left the z of each pixel, right the Z of the 9 x 9 pixels around it, both
    full at 5; else the difference, full at its largest. The bar of colours at the bottom is the scale. Small
    pictures are drawn with larger pixels.
    """
    if verdict.z is not None:
        signed = [largest(verdict.z.z) / FULL, largest(verdict.z.local_Z) / FULL]
    else:
        one, two = (to_srgb(p.rgb) / 255.0 if verdict.errors.unit == "sRGB" else p.rgb for p in (a, b))
        with np.errstate(all="ignore"):
            signed = [largest(one.astype(np.float64) - two) / max(verdict.errors.most, 1e-300)]
    odd = ~np.isfinite(a.rgb).all(axis=2) | ~np.isfinite(b.rgb).all(axis=2)
    panels = [np.where(odd[..., None], ODD, colours(values)) for values in signed]
    height, width = odd.shape
    larger = max(1, SIDE // max(height, width))
    panels = [panel.repeat(larger, axis=0).repeat(larger, axis=1) for panel in panels]
    between = np.zeros((height * larger, GAP, 3))
    rgb = np.concatenate([part for panel in panels for part in (panel, between)][:-1], axis=1)
    bar = np.repeat(colours(np.linspace(-1.0, 1.0, rgb.shape[1]))[None], 2 * GAP, axis=0)
    return np.concatenate((rgb, np.zeros((GAP, rgb.shape[1], 3)), bar)).astype(np.float32)


def largest(values):
    """Of three channels (H, W, 3) the value furthest from 0, with its sign; 0 where none is a number."""
    values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
    place = np.argmax(np.abs(values), axis=2)[..., None]
    return np.take_along_axis(values, place, axis=2)[..., 0]


def colours(signed):
    """Colours (..., 3) of numbers (...) from -1 to 1."""
    share = np.clip(np.abs(signed), 0.0, 1.0)[..., None]
    end = np.where((signed < 0.0)[..., None], BLUE, RED)
    return (1.0 - share) * GREY + share * end
