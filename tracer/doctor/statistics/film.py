"""Where samples lie in their pixels."""

import numpy as np

from tracer.doctor.rule import NotRecordedError
from tracer.doctor.statistics.cells import FEWEST, Cell, balanced

_LINES = 8  # columns and rows of pixels, to see a stretch
_SOME = 8192  # samples among which those that lie alike are counted
_ALIKE = 0.1  # of them may


def placed(evidence):
    """Where on the film (2, N), in pixels, camera rays go through it, and how far that may be off in pixels:
    as recorded, else by the direction of the ray."""
    width, height = evidence.settings.width, evidence.settings.height
    if evidence.has("camera.film"):
        return evidence("camera.film"), 4.0 * evidence.eps * max(width, height)
    camera = evidence.scene.camera
    if camera.aperture_radius or "camera.d" in evidence.trace.rebuilt:
        raise NotRecordedError("camera.film")
    d, half = evidence("camera.d"), np.tan(np.radians(0.5 * camera.fov_x))
    ahead, right, up = (axis @ d for axis in (camera.forward, camera.right, camera.up))
    x, y = right / ahead / half, up / ahead / half
    room = 32.0 * evidence.eps * width * (half + 1.0 / half)
    return np.stack((0.5 * width * (1.0 + x), 0.5 * (height - width * y))), room


def within(evidence):
    """Whether samples lie evenly about the middle of their pixels, as often to one side as to the other, and
    in the last columns as in the first.

    Nothing more is asked, since any filter that is even will do, and any pattern that all pixels share.
    """
    if "size" in evidence.trace.free:
        raise NotRecordedError("the picture's size")
    if not evidence.settings.jitter:
        raise NotRecordedError("jitter, which is off")
    film, room = placed(evidence)
    path = evidence.trace.tables["camera"].path
    pixel = np.stack((evidence("path.x"), evidence("path.y")))[:, path].astype(float)
    rows = np.flatnonzero(np.isfinite(film).all(axis=0))
    if evidence.settings.sampler != "independent":
        rows = rows[evidence("path.sample")[path[rows]] == 0]
    if rows.size < FEWEST:
        return
    pixel, beside = pixel[:, rows], (film - pixel)[:, rows] - 0.5
    if (np.median(np.abs(beside), axis=1) > 1.0).any():
        raise NotRecordedError("rays through their pixels")
    beside = np.where(np.abs(beside) <= room, 0.0, beside)
    if (np.ptp(beside, axis=1) <= 2.0 * room).all():
        return  # one place in all pixels is no jitter, and another law's
    own = _each_its_own(beside, room)
    for axis, name in enumerate("xy"):
        off, line = beside[axis], pixel[axis] - pixel[axis].mean()
        if own:
            words = f"places on the film lie {off.mean():+.3g} pixels beside the middle of theirs in {name}"
            yield Cell(balanced(off), words, "camera", rows)
        if np.unique(pixel[axis]).size >= _LINES:
            slope = 1.0 + (line * off).sum() / (line * line).sum()
            words = f"the picture is stretched by {slope:.4g} in {name}"
            yield Cell(balanced(line * off), words, "camera", rows)


def _each_its_own(beside, room):
    """Whether samples (2, N) of different pixels lie differently: of a pattern the mean says nothing."""
    some = np.linspace(0, beside.shape[1] - 1, min(beside.shape[1], _SOME)).astype(int)
    places = np.round(beside[:, some] / (4.0 * room))
    return np.unique(places, axis=1).shape[1] >= (1.0 - _ALIKE) * some.size
