"""What a picture says of a mistake that is in no catalogue: which places it leaves as they are, and how it
changes the others. It excludes only what would have changed those places as well; none of it is a proof.
"""

from dataclasses import dataclass

import numpy as np

from tracer.doctor.picture.features import CELLS, resampled
from tracer.doctor.picture.fitting import deviation
from tracer.doctor.picture.hypotheses import FITS, agreeing

AGREES, UNSURE, EVEN, VARIES, UNSEEN = "agrees", "unsure", "even", "varies", "unseen"
_DARK = 4e-3  # means below it are lost in 8 bits
_NEAR = 0.1  # relative: an object that is off by more is not called right, however noisy it is
_SPREAD = 1.25  # of the ratio over an object, from which on it is no one factor
_FEW = 4  # places that have to agree before anything is excluded
_STRAIGHT, _ROUND = 0.65, 0.25  # share of light straight from lights: mostly, hardly
_MOSTLY, _SOME = 0.6, 0.1  # of the places
_BELOW = 0.9  # times the light straight from lights: so dark that bounces cannot be at fault alone
_HALF = 0.5  # brightness: a curve changes darker places
_POWER, _LEFT, _EXPLAINED = (
    0.12,
    0.35,
    0.8,
)  # least change of an exponent, most that it leaves (log), least share
_ALIKE, _UNLIKE = 0.2, 0.5  # log ratios: of one material's objects, of different materials


@dataclass(frozen=True)
class Seen:
    """An object: its name; ratio (3,) of its mean to the right one; direct: share of its right light that
    comes straight from lights; state: AGREES, UNSURE (off, but within noise), EVEN (off by one factor all
    over it), VARIES, or UNSEEN (cut off or too small); low, high: (ratio, (x, y) in the picture) of its
    places, None where it is UNSEEN."""

    name: str
    ratio: np.ndarray
    direct: float
    state: str
    low: tuple | None = None
    high: tuple | None = None


@dataclass(frozen=True)
class Clues:
    """objects: a Seen each. agree, straight, around: (how many agree, of how many) of all places that say
    something, of those that light reaches mostly straight from lights, and hardly so; below: of the second
    kind of count, how many are darker than that light alone. dim: whether enough dim places agree. power: k
    where the picture is about right^k, else None. of_material: whether objects of one material are off alike.
    log: three columns of a log that say more.
    """

    objects: tuple
    agree: tuple
    straight: tuple
    around: tuple
    below: tuple
    dim: bool
    power: float | None
    of_material: bool
    log: tuple

    @property
    def direct_is_right(self):
        """Whether places that are lit straight from lights agree."""
        return self.straight[0] >= _FEW and self.straight[0] >= _MOSTLY * self.straight[1]

    @property
    def worst(self):
        """The object that is off by most different factors, None where each is off by one."""
        varied = [seen for seen in self.objects if seen.state == VARIES]
        return max(varied, key=lambda seen: seen.high[0] / max(seen.low[0], 1e-9), default=None)

    @property
    def direct_is_dark(self):
        """Whether places are darker than light straight from lights alone."""
        return self.below[0] >= _FEW and not self.direct_is_right


def clues(opinion, seen, right, scene, direct, total):
    """The Clues of a picture of a scene.

    seen, right: Features of the picture and of the right one; direct, total: right pictures (H, W, 3), of the
    light that comes straight from lights to what is seen, and of all.
    """
    straight, whole = (resampled(np.asarray(p, float), CELLS, CELLS).sum(axis=2) for p in (direct, total))
    share = straight / np.maximum(whole, 1e-9)
    used, good = agreeing(opinion.reading, seen, right)
    apart = (deviation(seen.mean, seen.error, right.mean, right.error) ** 2).mean(axis=2)
    light, should = seen.mean.sum(axis=2), right.mean.sum(axis=2)
    ratio = light / np.maximum(should, 1e-9)
    objects = tuple(
        _object(wall, used & wall.cells, apart, ratio, share, opinion.reading.rgb.shape)
        for wall in opinion.walls
    )
    lit, unlit = used & (share > _STRAIGHT), used & (share < _ROUND)
    noise = 3.0 * np.sqrt((seen.error**2).sum(axis=2))
    below = used & (share > _ROUND) & (light + noise < _BELOW * straight)
    dim = bool(np.count_nonzero(good & (right.mean.max(axis=2) < _HALF)) >= max(_FEW, _SOME * used.sum()))
    power = None if dim else _power(seen.mean[used], right.mean[used])
    alike = power is None and _of_material(objects, scene)
    found = Clues(
        objects, _of(good, used), _of(good, lit), _of(good, unlit), _of(below, used & (share > _ROUND)), dim,
        power, alike, (),
    )  # fmt: skip
    return Clues(**{**vars(found), "log": to_log(found, scene)})


def _of(good, all_of):
    return int(np.count_nonzero(good & all_of)), int(np.count_nonzero(all_of))


def _object(wall, cells, apart, ratio, share, shape):
    if not cells.any():
        direct = float(share[wall.cells].mean()) if wall.cells.any() else float("nan")
        return Seen(wall.name, wall.ratio, direct, UNSEEN)
    y, x = np.nonzero(cells)
    here = ratio[cells]
    order = np.argsort(here)
    k = round(0.1 * (here.size - 1))
    low, high = ((float(here[i]), _pixel(x[i], y[i], shape)) for i in (order[k], order[-1 - k]))
    near = (np.abs(wall.ratio - 1.0) < _NEAR).all()
    if apart[cells].mean() <= FITS:
        state = AGREES if near else UNSURE
    else:
        state = VARIES if high[0] > _SPREAD * low[0] else EVEN
    return Seen(wall.name, wall.ratio, float(share[cells].mean()), state, low, high)


def _pixel(x, y, shape):
    """The middle of a cell as (x, y) in the picture."""
    return int((x + 0.5) * shape[1] / CELLS), int((y + 0.5) * shape[0] / CELLS)


def _power(mine, right):
    """k where mine is about right^k times a constant, (N, 3) both; None where it is not, or k is about 1."""
    both = (mine > _DARK) & (right > _DARK)
    if np.count_nonzero(both) < 3 * _FEW:
        return None
    x, y = np.log(right[both]), np.log(mine[both])
    if x.std() < _UNLIKE:
        return None
    k, shift = np.polyfit(x, y, 1)
    left, before = y - k * x - shift, y - x
    fits = np.sqrt((left**2).mean()) <= _LEFT and (left**2).sum() <= (1.0 - _EXPLAINED) * (before**2).sum()
    return float(k) if fits and abs(k - 1.0) > _POWER else None


def _of_material(objects, scene):
    """Whether objects of one material are off by like factors, and those of others by others."""
    groups: dict = {}
    material = dict(zip((shape.name for shape in scene.shapes), _materials(scene), strict=True))
    for seen in objects:
        if seen.state in (EVEN, VARIES) and (seen.ratio > 0.0).all():
            groups.setdefault(material[seen.name], []).append(np.log(seen.ratio))
    if len(groups) < 2 or max(map(len, groups.values())) < 2:
        return False
    middle = {name: np.mean(logs, axis=0) for name, logs in groups.items()}
    within = np.concatenate([np.array(logs) - middle[name] for name, logs in groups.items() if len(logs) > 1])
    between = np.array(list(middle.values()))
    return bool(_rms(within) <= _ALIKE and _rms(between - between.mean(axis=0)) >= _UNLIKE)


def _materials(scene):
    """Number of each shape's material."""
    return [int(scene.bsdf_of[first]) for first in scene.first[: len(scene.shapes)]]


def _rms(values):
    return float(np.sqrt((values**2).mean()))


def to_log(found, scene):
    """Three columns of a log that tell more about what is off."""
    if scene.media is not None and found.direct_is_right:
        return "hit.transmittance", "bounce.f", "bounce.pdf"
    if found.direct_is_right:
        return "bounce.f", "bounce.cos", "bounce.pdf"
    if found.of_material:
        return "light.f", "bounce.f", "indirect"
    if found.power is not None:
        return "emission", "direct", "indirect"
    return "light.f", "light.cos", "light.pdf"
