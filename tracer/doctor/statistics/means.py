"""What paths bring, against castray's own right tracer with other numbers, pixel by pixel."""

from dataclasses import replace

import numpy as np

from tracer.doctor.rule import NotRecordedError
from tracer.doctor.statistics.cells import FEWEST, Cell, balanced
from tracer.light.sample import luminance

_OTHER = 0x5EED  # exclusive-or of the seed: the reference draws other numbers
_GIVING = ("hit", "light", "escape")
_WAY = {"hit": "lamps that are met", "light": "light samples", "escape": "the environment"}
_DEEP = 5  # from this depth on all depths are one cell
_PARTS = 1 << 14


class Tally:
    """Sums per pixel of what paths bring by technique and depth, and their squares."""

    def __init__(self, pixels):
        self.of = {(kind, depth): np.zeros(pixels) for kind in _GIVING for depth in range(_DEEP + 1)}
        self.whole, self.square, self.vertices = np.zeros(pixels), np.zeros(pixels), np.zeros(pixels)

    def add(self, trace, pixel):
        """Paths of a trace, whose pixels are numbered (P,)."""
        size = self.whole.size
        for kind in _GIVING:
            table = trace.tables[kind]
            if not table.path.size:
                continue
            bright = _finite(luminance(table["contribution"].astype(np.float64)))
            deep = np.minimum(table.depth, _DEEP)
            for depth in range(_DEEP + 1):
                some = deep == depth
                self.of[kind, depth] += np.bincount(pixel[table.path[some]], bright[some], size)
        bright = _finite(luminance(trace.paths["radiance"].astype(np.float64)))
        self.whole += np.bincount(pixel, bright, size)
        self.square += np.bincount(pixel, bright * bright, size)
        self.vertices += np.bincount(pixel, trace.paths["vertices"], size)


def _finite(values):
    return np.where(np.isfinite(values), values, 0.0)


def tallies(evidence):
    """The Tally of the trace and that of the reference, pixel by pixel; and samples per pixel."""
    if "tallies" not in evidence.__dict__:
        evidence.__dict__["tallies"] = _tallies(evidence)
    return evidence.__dict__["tallies"]


def _tallies(evidence):
    from tracer.trace import parts

    trace, settings = evidence.trace, evidence.settings
    for name in ("hit", "light", "escape"):
        if evidence.count(name) and not evidence.has(f"{name}.contribution"):
            raise NotRecordedError(f"{name}.contribution")
    if settings.width is None:
        raise NotRecordedError("the size of the picture")
    number = evidence("path.y") * settings.width + evidence("path.x")
    pixels, pixel, many = np.unique(number, return_inverse=True, return_counts=True)
    spp = int(many.min())
    if many.max() != spp:
        raise NotRecordedError("the same number of samples in each pixel")
    ours, theirs = Tally(pixels.size), Tally(pixels.size)
    ours.add(trace, pixel)
    again = replace(
        settings,
        seed=settings.seed ^ _OTHER,
        spp=spp,
        replicates=settings.replicates if spp % settings.replicates == 0 else 1,
    )
    done = 0
    for part in parts(trace.scene, again, pixels=pixels, lanes=_PARTS):
        theirs.add(part, done + np.arange(part.size) // spp)
        done += part.size // spp
    return ours, theirs, spp


def means(evidence):
    """I18: the mean by depth and technique."""
    ours, theirs, spp = tallies(evidence)
    rows = np.arange(evidence.trace.size)
    for (kind, depth), sums in ours.of.items():
        other = theirs.of[kind, depth]
        if np.count_nonzero(sums != other) < FEWEST:
            continue
        at = f"depth {depth}" if depth < _DEEP else f"depth {_DEEP} and more"
        ratio = sums.sum() / max(other.sum(), 1e-300)
        words = f"{_WAY[kind]} at {at} bring {ratio:.4g} times what they should"
        yield Cell(balanced(sums - other), words, "path", rows, {"ratio": ratio, "way": kind, "depth": depth})
    if np.count_nonzero(ours.whole != theirs.whole) >= FEWEST:
        ratio = ours.whole.sum() / max(theirs.whole.sum(), 1e-300)
        words = f"the picture is {ratio:.4g} times as bright as it should be"
        yield Cell(balanced(ours.whole - theirs.whole), words, "path", rows, {"ratio": ratio, "way": "all"})
        if _own_roulette(evidence):
            return
        ratio = ours.vertices.sum() / max(theirs.vertices.sum(), 1e-300)
        words = f"paths have {ratio:.4g} times as many vertices as they should"
        yield Cell(
            balanced(ours.vertices - theirs.vertices), words, "path", rows, {"ratio": ratio, "way": "length"}
        )


def _own_roulette(evidence):
    """Whether roulette is not played as the reference plays it: with another chance, or from later on."""
    free, depth = evidence.trace.free, evidence.trace.tables["roulette"].depth
    return "roulette" in free or ("roulette-start" in free and depth.size > 0 and depth.min() > 0)


def variances(evidence):
    """I18: the spread of a pixel's samples."""
    if _own_roulette(evidence):
        raise NotRecordedError("one survival probability, declared")
    ours, theirs, spp = tallies(evidence)
    if spp < 2:
        return
    mine, other = (t.square / spp - (t.whole / spp) ** 2 for t in (ours, theirs))
    mine, other = np.maximum(mine, 0.0), np.maximum(other, 0.0)
    some = (mine > 0.0) & (other > 0.0)
    if np.count_nonzero(some) < FEWEST:
        return
    ratio = float(np.exp(np.mean(np.log(mine[some]) - np.log(other[some]))))
    p = balanced(np.log(mine[some]) - np.log(other[some]))
    yield Cell(
        p,
        f"the variance of samples is {ratio:.3g} times the right tracer's",
        "path",
        np.arange(evidence.trace.size),
        {"ratio": ratio},
    )
