"""Which mistakes of a catalogue a picture fits, alone or together.

They are hypotheses: many mistakes can look alike, only recorded paths prove one.
"""

from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from tracer.doctor.picture.features import CELLS, features, resampled
from tracer.doctor.picture.fitting import Fit, deviation, fit, fits, misfit
from tracer.doctor.picture.mixing import guesses
from tracer.doctor.picture.reading import GAMMA, NONE, SRGB, Reading, linear, others, plain
from tracer.doctor.picture.walls import shown, walls

MIXED = 0.9  # worse than that, mixtures are tried
FITS = 1.2  # mean squared deviation; right pictures have about a half
LEAST = 30.0  # sum of squared deviations that a mistake has to explain
NEAR = 0.15  # mean squared deviation of two mistakes whose pictures are called the same
CLOSE = 1.5  # times the least deviation: still worth being named
_FAR_BETTER = 0.7  # times the deviation: another curve is then worth a word
WHOLE = "castray"  # an entry that is a mixture already
_MOST, _RENDERED = 5, 5  # hypotheses that are named; mixtures that are rendered, of each size
_FACTOR = 0.08  # relative: a picture brighter or darker throughout by less is not called so
_WHOLE = 0.03  # relative: so near a whole number a factor may be one of samples
_USUAL_SPP = 16
_ACROSS = 16  # pixels of a row that are asked what they show
_DIM = 0.6  # a cell that is so bright need not be clipped
_FEW_CELLS = 16  # fewer that are not clipped say nothing about a factor
_BRIGHT = 0.9  # means above it may be of pixels that are cut
_DARK = 4e-3  # and below it be lost in 8 bits
_FAR_MORE, _SOME = 2.0, 3  # times as many places, and this many more, speak for another curve
_CLIPPED = 0.02  # share of a cell's pixels at 1 from which on it says nothing about brightness


@dataclass(frozen=True)
class Hypothesis:
    """Mistakes that may have made a picture.

    bugs: ids of those that are there together; alike: ids whose pictures look the same; explains: share of
    what is off that they explain; deviation: mean squared, of what is left, 1 or less where it fits; spp:
    samples per pixel at which it fits best; factor: by which all is brighter, if that is all that is off.
    marks: what else speaks for it, names with values. looks: Features that it predicts, None where it
    predicts none.
    """

    bugs: tuple
    alike: tuple = ()
    explains: float | None = None
    deviation: float | None = None
    spp: float | None = None
    factor: float | None = None
    marks: tuple = ()
    looks: object = None


@dataclass(frozen=True)
class Opinion:
    """What a picture alone says. reading: how it was read; hypotheses: the likeliest first; nearest: the one
    that comes nearest where none fits; right: the Fit of the right tracer; walls: each object's brightness;
    invalid: share of pixels that are no numbers; likelier: the curve by which it would fit far better than
    by the one that was said, None where there is none; clues: what there is to say where nothing fits."""

    reading: Reading
    hypotheses: tuple
    nearest: Hypothesis | None
    right: Fit
    walls: tuple
    invalid: float
    likelier: object = None
    clues: object = None

    @property
    def is_right(self):
        """Whether it fits the right tracer, and no mistake much better."""
        return not self.hypotheses and self.nearest is None


def judged(values, eight_bits, curves, scene, album, mixed, spp=None):
    """The Opinion on a picture's numbers (H, W, 3) as its file holds them.

    album: .picture (H, W, 3), .rights (Looks, those of the tracer that the bugs are in first), .bugs {id:
    Looks}. mixed: from ids to the Looks of all those mistakes
    at once, None where they cannot be together. spp: samples per pixel, if known.
    """
    if not np.nan_to_num(values).any():
        return _black(values, eight_bits, curves, album, scene)
    reading, seen = _read(values, eight_bits, curves, album, spp)
    right = _nearest(seen, dict(enumerate(album.rights)), spp)
    ranked = _singles(seen, album, spp, right)
    ranked += _mixtures(seen, album, ranked, right, mixed, spp)
    ranked += _factors(reading, seen, album, spp)
    ranked.sort(key=lambda h: h.deviation)
    best, least = ranked[0].deviation, LEAST / right.count
    off = right.typical - best > least or right.typical > FITS
    limit = min(FITS, CLOSE * best + 0.1, right.typical - least)
    fitting = [h for h in ranked if h.deviation <= limit]
    invalid = float(1.0 - np.isfinite(reading.rgb).all(axis=2).mean())
    found = (*_marked(reading, invalid, album.picture, scene), *_alike(fitting)[:_MOST])
    nearest = ranked[0] if off and not fitting else None
    if nearest is not None and (curve := _other_curve(values, reading, curves, album)) is not None:
        return judged(values, eight_bits, (curve,), scene, album, mixed, spp)
    shown = tuple(walls(reading.rgb, album.picture, scene, eight_bits))
    return Opinion(reading, found, nearest, right, shown, invalid)


def _black(values, eight_bits, curves, album, scene):
    """The Opinion on a picture without any light: it fits mistakes that leave a dark room by chance."""
    reading = plain(values, eight_bits, curves[0], album.picture.shape[1] / album.picture.shape[0])
    right = _nearest(features(reading.rgb, eight_bits), dict(enumerate(album.rights)), None)
    shown = tuple(walls(reading.rgb, album.picture, scene, eight_bits))
    invalid = float(1.0 - np.isfinite(values).all(axis=2).mean())
    return Opinion(reading, (Hypothesis((), marks=(("black", 1.0),)),), None, right, shown, invalid)


def likelier_curve(values, opinion, album, spp=None):
    """The usual curve of 8 bits by which a picture's numbers (H, W, 3) fit the right tracer, or one mistake,
    far better than by the one that was said; None where there is none."""
    known = {**dict(enumerate(album.rights)), **album.bugs}

    aspect = album.picture.shape[1] / album.picture.shape[0]

    def off(curve):
        return _nearest(features(plain(values, True, curve, aspect).rgb, True), known, spp).typical

    said = opinion.reading.curve
    found = {curve: off(curve) for curve in (SRGB, GAMMA, NONE) if curve != said}
    best, before = min(found, key=lambda curve: found[curve]), off(said)
    return best if found[best] <= min(FITS, _FAR_BETTER * before) else None


def _read(values, eight_bits, curves, album, spp):
    """The Reading that fits anything best, and its Features; the plain one unless another fits far better."""
    aspect = album.picture.shape[1] / album.picture.shape[0]
    reading = plain(values, eight_bits, curves[0], aspect)
    seen = features(reading.rgb, eight_bits)
    least = _least(seen, album, spp)
    if least <= 0.7 and reading.shape is None:
        return reading, seen
    for other in others(values, eight_bits, curves, aspect):
        looks = features(other.rgb, eight_bits)
        found = _least(looks, album, spp, 2.0 * least)
        if found < 0.8 * least:
            reading, seen, least = other, looks, found
    return reading, seen


def _least(seen, album, spp, hopeless=np.inf):
    """How near the right tracer, a mistake, or what two may do together comes to a picture; two are tried
    where one is not hopelessly far off."""
    near = _nearest(seen, {**dict(enumerate(album.rights)), **album.bugs}, spp)
    if not MIXED < near.typical < hopeless:
        return near.typical
    alone = {bug: looks for bug, looks in album.bugs.items() if bug != WHOLE}
    pairs = guesses(seen, album.rights[0], {(bug,): looks for bug, looks in alone.items()}, alone, spp)
    return min(near.off, pairs[0][0]) / near.count


def _other_curve(values, reading, curves, album):
    """The curve by which far more places of a picture that nothing fits are right than as it was read: a
    wrong one spoils all dim places, few mistakes do. None where there is none."""
    if len(curves) < 2 or reading.turn is not None or reading.shape is not None:
        return None
    right = album.rights[0].near(max(album.rights[0].at))

    def count(curve):
        other = replace(reading, rgb=linear(values, curve), curve=curve)
        _, good = agreeing(other, features(other.rgb, True), right)
        return np.count_nonzero(good)

    found = {curve: count(curve) for curve in curves}
    best = max(found, key=lambda curve: found[curve])
    return best if found[best] > _FAR_MORE * (found[reading.curve] + _SOME) else None


def agreeing(reading, seen, right):
    """Cells (8, 8) of a picture with Features `seen` that are neither dark nor cut off, and which of them are
    right within noise."""
    top = np.maximum(seen.mean, right.mean).max(axis=2)
    used = unclipped(reading) & (top < _BRIGHT) & (right.mean.max(axis=2) > _DARK)
    apart = deviation(seen.mean, seen.error, right.mean, right.error)
    return used, used & ((apart**2).mean(axis=2) <= FITS)


def _nearest(seen, many, spp):
    return min(fits(seen, many, spp).values(), key=lambda f: f.off)


def _hypothesis(bugs, found, looks, right):
    explains = float(np.clip(1.0 - found.off / max(right.off, 1e-9), 0.0, 1.0))
    return Hypothesis(bugs, (), explains, found.typical, found.spp, looks=looks.near(found.spp))


def _singles(seen, album, spp, right):
    found = fits(seen, album.bugs, spp)
    made = (_hypothesis((bug,), found[bug], looks, right) for bug, looks in album.bugs.items())
    return sorted(made, key=lambda h: h.deviation)


def _mixtures(seen, album, singles, right, mixed, spp):
    """Two mistakes at once, then three, where fewer do not fit: those whose effects put together come nearest
    are rendered, and kept where they fit far better than without one of them."""
    alone = {bug: looks for bug, looks in album.bugs.items() if bug != WHOLE}
    so_far = {h.bugs: h for h in singles}
    parts = {(bug,): looks for bug, looks in alone.items()}
    level = spp or max(h.spp for h in singles[:3])
    for size in (2, 3):
        if min(h.deviation for h in so_far.values()) <= (MIXED if size == 2 else FITS):
            break
        found = (ids for _, ids in guesses(seen, album.rights[0], parts, alone, spp))
        possible = ((ids, looks) for ids in found if (looks := mixed(ids, level)) is not None)
        rendered = dict(islice(possible, _RENDERED))
        for ids, looks in rendered.items():
            so_far[ids] = _hypothesis(ids, fit(seen, looks, spp), looks, right)
        parts = dict(sorted(rendered.items(), key=lambda part: so_far[part[0]].deviation)[:2])
    needed = LEAST / right.count
    return [
        h
        for ids, h in so_far.items()
        if len(ids) > 1
        and all(h.deviation < o.deviation - needed for less, o in so_far.items() if {*less} < {*ids})
    ]


def _factors(reading, seen, album, spp):
    """The right picture, brighter or darker throughout: exposure, or samples that were not divided by."""
    known = album.rights[0].near(spp or _USUAL_SPP)
    cells = unclipped(reading) & (known.mean.max(axis=2) < 0.9) & (known.mean.min(axis=2) > 0.0)
    if cells.sum() < _FEW_CELLS:
        return []
    mine, should = (f.mean if reading.eight_bits else f.bright for f in (seen, known))
    factor = float(np.median(mine[cells].sum(axis=1) / should[cells].sum(axis=1)))
    if not np.isfinite(factor) or factor <= 0.0 or abs(np.log(factor)) < _FACTOR:
        return []
    dim = (factor * known.mean.max(axis=2) < _DIM) & (known.mean.min(axis=2) > 0.0)
    if (
        dim.any() and cells[dim].mean() < 0.8
    ):  # what a brighter picture would not clip is clipped: single bright pixels
        return []
    scaled = features(reading.rgb / factor, reading.eight_bits)
    compared = cells if reading.eight_bits else None
    found, before = (fit(some, album.rights[0], spp, compared) for some in (scaled, seen))
    whole = factor > 1.5 and abs(factor / round(factor) - 1.0) < _WHOLE
    bugs = ("F04",) if whole else ()
    return [replace(_hypothesis(bugs, found, album.rights[0], before), factor=factor, looks=None)]


def unclipped(reading):
    """Cells (8, 8) of a picture in which hardly a pixel is cut off at 1."""
    if not reading.eight_bits:
        return np.ones((CELLS, CELLS), bool)
    full = (reading.rgb >= 1.0).any(axis=2).astype(np.float64)
    return resampled(full, CELLS, CELLS) < _CLIPPED


def _marked(reading, invalid, right, scene):
    """Hypotheses that single pixels suggest: no numbers, rows that nobody drew."""
    if invalid > 0.0:
        yield Hypothesis(("B15",), marks=(("invalid", invalid),))
    height, width = reading.rgb.shape[:2]
    rows = resampled(np.asarray(right).sum(axis=2), height, 1)[:, 0]
    filled = (shown(scene, height, width, max(1, width // _ACROSS)) >= 0).any(axis=1)
    lit = filled & (rows > 0.3 * np.median(rows))
    lost = (reading.rgb == 0.0).all(axis=(1, 2)) & lit
    if 0 < lost.sum() < height // 2 and (lost[lit][-1] or lost[lit][0]):
        yield Hypothesis(("P06",), marks=(("rows", int(lost.sum())),))


def _alike(ranked):
    """The ranked, with those put together whose pictures are the same."""
    kept = []
    for h in ranked:
        same = next((k for k, other in enumerate(kept) if _same(h, other)), None)
        if same is None:
            kept.append(h)
        else:
            kept[same] = replace(kept[same], alike=(*kept[same].alike, " + ".join(h.bugs)))
    return kept


def _same(one, other):
    if one.looks is None or other.looks is None or len(one.bugs) != len(other.bugs):
        return False
    off, count = misfit(one.looks, other.looks)
    return off / max(count, 1) < NEAR
