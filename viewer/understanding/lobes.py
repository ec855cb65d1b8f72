"""f |cos| and p over a vertex as surfaces: how far each reaches in the directions of a grid.

The grid is a polar one on the disc of a side, moved by the Moebius map z -> (z + c) / (1 + conj(c) z) of the
disc onto itself. It is finest at c, where the lobe is highest: sharp and broad lobes take as few places.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from tracer.events import LOBES
from viewer.numerals import LUMINANCE
from viewer.understanding.vertex import off_disc, on_disc

RINGS, SECTORS = 36, 48  # of the grid
SPREAD = 5.0  # rings at sinh(SPREAD k / RINGS): evenly spaced at the peak, each so much further at the rim
WIRES = (3, 4)  # every so many rings and sectors are drawn as lines
TRIES = 256  # directions drawn to find the peaks and the Dirac lobes
NEARER = 3  # times that the peak is looked for on a grid about the last one


@dataclass(frozen=True)
class Sheet:
    """One side (+1 above n, -1 below): shown directions (3, N), there f |cos| (N,) and p (N,) in 1/sr.

    faces: (F, 3) triangles that look away from the vertex. wires: (E, 2) lines of the grid.
    """

    side: float
    directions: np.ndarray
    f: np.ndarray
    p: np.ndarray
    faces: np.ndarray
    wires: np.ndarray


@dataclass(frozen=True)
class Dirac:
    """A Dirac lobe: its name, a shown direction (3,), the fraction f that it scatters, its probability p."""

    name: str
    direction: np.ndarray
    f: float
    p: float


@dataclass(frozen=True)
class Lobes:
    """What a vertex sends where. most: the largest of all f |cos| and p, 0 where all lobes are Dirac ones."""

    sheets: tuple
    diracs: tuple
    most: float

    def peak(self, name, side=None):
        """The largest f |cos| ("f") or p ("p") on a side, on both if none is named."""
        values = [getattr(sheet, name) for sheet in self.sheets if side in (None, sheet.side)]
        return max((float(v.max()) for v in values), default=0.0)


def lobes(vertex):
    """The Lobes of a Vertex, as castray's own material has them."""
    with np.errstate(all="ignore"):
        shown, sample = _sampled(vertex)
        smooth = shown[:, (sample.pdf > 0.0) & ~sample.delta]
        sheets = tuple(_sheet(vertex, side, smooth[:, side * smooth[2] > 0.0]) for side in vertex.sides)
        most = max(float(max(sheet.f.max(), sheet.p.max())) for sheet in sheets)
        return Lobes(sheets if most else (), tuple(_diracs(shown, sample)), most)


def _sampled(vertex):
    """Shown directions (3, TRIES) that the material chooses, and its Sample."""
    surface = vertex.times(TRIES)
    u = np.random.default_rng(1).random((3, TRIES)).astype(vertex.scene.dtype)
    sample = surface.sample(np.minimum(u, np.nextafter(vertex.scene.dtype(1.0), vertex.scene.dtype(0.0))))
    return vertex.turned(sample.wi), sample


def _diracs(shown, sample):
    """Every Dirac lobe that was drawn: all that are not too rare for TRIES."""
    goes = sample.delta & (sample.pdf > 0.0)
    for lobe in np.unique(sample.lobe[goes]):
        k = int(np.flatnonzero(goes & (sample.lobe == lobe))[0])
        f = float(np.dot(LUMINANCE, sample.f[:, k].astype(float)))
        yield Dirac(LOBES[int(lobe)], shown[:, k], f, float(sample.pdf[k]))


def _sheet(vertex, side, drawn):
    """The Sheet of a side, about its peak. drawn: (3, N) directions to begin to look at."""
    peak = np.zeros(2)
    there = np.concatenate((drawn, off_disc(_moved(peak), side)), axis=1)
    for _ in range(NEARER):
        f, p = _asked(vertex, there)
        peak = on_disc(there[:, [int(np.argmax(f + p))]])[:, 0]
        there = off_disc(_moved(peak), side)
    return Sheet(side, there, *_asked(vertex, there), *_net(side))


def _asked(vertex, shown):
    """f |cos| and p, 0 where a number is none."""
    return tuple(np.nan_to_num(v, nan=0.0, posinf=0.0, neginf=0.0) for v in vertex.asked(shown))


def _moved(peak):
    """The grid's places (2, 1 + RINGS * SECTORS) on the disc, the first at the peak (2,)."""
    z, c = _polar(), complex(*peak)
    c *= min(1.0, 0.999 / (abs(c) or 1.0))  # on the rim itself the map would put all places into one
    moved = (z + c) / (1.0 + np.conj(c) * z)
    moved /= np.maximum(np.abs(moved), 1.0)  # by rounding
    return np.stack((moved.real, moved.imag))


@cache
def _polar():
    r = np.sinh(SPREAD * np.arange(1, RINGS + 1) / RINGS) / np.sinh(SPREAD)
    turn = np.exp(2j * np.pi * np.arange(SECTORS) / SECTORS)
    return np.concatenate(([0j], (r[:, None] * turn).ravel()))


@cache
def _net(side):
    """Triangles and wires between the grid's places."""
    place = 1 + np.arange(RINGS * SECTORS).reshape(RINGS, SECTORS)
    beside = np.roll(place, -1, axis=1)
    middle = np.stack((np.zeros(SECTORS, int), place[0], beside[0]), axis=1)
    inner = np.stack((place[:-1], place[1:], beside[1:]), axis=-1).reshape(-1, 3)
    outer = np.stack((place[:-1], beside[1:], beside[:-1]), axis=-1).reshape(-1, 3)
    faces = np.concatenate((middle, inner, outer))
    rings = slice(WIRES[0] - 1, None, WIRES[0])
    spokes = np.concatenate((np.zeros((1, SECTORS), int), place))[:, :: WIRES[1]]
    around = np.stack((place[rings], beside[rings]), axis=-1).reshape(-1, 2)
    along = np.stack((spokes[:-1], spokes[1:]), axis=-1).reshape(-1, 2)
    return faces if side > 0.0 else faces[:, ::-1], np.concatenate((around, along))
