"""How many samples each pixel gets, and in which order.

A plan yields rounds of tasks and looks at the film between them. The mean of a pixel must not depend on how
its own samples fell: were it sampled until it looks good, it would stop before its rare bright paths have
come, and be too dark. So the pixels are black and white like the squares of a chessboard, and what decides on
the white ones is measured on black ones only, and the other way round:

- `until_error`: a tile's white pixels get samples until the spread of its black ones, over the number of
  samples of the white ones, says that their error is small enough.
- `adaptive`: a first pass of one block measures; in a second a pixel gets samples in proportion to a power of
  the variance of its four neighbours.

Given its number of samples a pixel is the mean of its first samples like any other: unbiased, with a right
error bar; and `inspect` with that number of samples gives it again bit for bit.

With a low-discrepancy sampler `until_error` goes by the spread of the replicates, without which the error is
not known. `adaptive` goes by that of single samples even there: it only has to tell where more is to be won.
"""

import numpy as np

from tracer import film
from tracer.engine import waves
from tracer.settings import TracerError

TILE = 16  # pixels
DARK = 0.01  # added to mean^2: keeps black pixels from deciding
STILL = 1e-5  # relative deviation of samples that is rounding, not noise
MOST_BLOCKS = 64  # of a pixel between two looks
# Samples go with this power of the variance. 1/2 would be best if it were known and samples independent: but
# one block of neighbours tells it roughly, and in rare bright samples wrongly (BENCHMARKS.md, `sharing`).
POWER = 0.25
GOALS = ("off", "mse", "relmse")  # what `adaptive` makes small


def rounds(settings, sheet, until_error=None, adaptive="off"):
    """The plan that is asked for, a generator of rounds (iterables of tasks). sheet: the film that is filled.

    Raises TracerError where the plan makes no sense.
    """
    if until_error is not None and adaptive != "off":
        raise TracerError("adaptive: cannot be had with until_error; choose one")
    if adaptive not in GOALS:
        raise TracerError(f"adaptive: {adaptive!r} is not known; choose one of {', '.join(GOALS)}")
    least = film.BLOCK if until_error is not None else 2 * film.BLOCK
    if until_error is None and adaptive == "off":
        return iter([waves.tasks(settings)])
    if settings.spp < least or settings.spp % film.BLOCK:
        who = "adaptive" if until_error is None else "until_error"
        raise TracerError(f"spp: {settings.spp}; {who} works in blocks of {film.BLOCK}: {least} or more")
    if until_error is None:
        return _adaptive(settings, sheet, adaptive)
    if not 0.0 < until_error < np.inf:
        raise TracerError(f"until_error: {until_error} is not a number above 0")
    if settings.parts == 1:
        raise TracerError(
            f"until_error: samples of sampler {settings.sampler} are not independent, so that their spread "
            "is no error; give replicates, such as 4, for error bars"
        )
    return _until_error(settings, sheet, until_error)


def _until_error(settings, sheet, error):
    """Samples until each tile's root mean of se^2 / (mean^2 + 0.01) is at most `error`, settings.spp at most.

    A pixel whose four neighbours do not vary at all gets one block.
    """
    width, height = settings.width, settings.height
    half = _halves(width, height)
    other = half ^ 1
    size = 2 * (half.max() // 2 + 1)
    count = np.maximum(np.bincount(half, minlength=size), 1)
    going, sample = np.ones(half.size, bool), 0
    while sample < settings.spp and going.any():
        pixels = np.flatnonzero(going)
        blocks = min(max(sample // film.BLOCK, 1), MOST_BLOCKS, (settings.spp - sample) // film.BLOCK)
        yield _rows(pixels, np.full(pixels.size, blocks), sample)
        sample += blocks * film.BLOCK
        spread = relative_spread(sheet, sheet.variance().astype(np.float64) * sheet.samples)
        mean = np.bincount(half, spread, size) / count
        noisy = _beside(spread > STILL * STILL, width, height) > 0.0
        going &= (mean[other] > error * error * sample) & noisy


def _adaptive(settings, sheet, goal):
    """One block everywhere, then the rest of settings.spp where the goal has most of it."""
    width, height = settings.width, settings.height
    pixels = np.arange(width * height)
    yield _rows(pixels, np.ones(pixels.size, np.int64), 0)
    variance = sheet.sample_variance()
    square = variance.mean(axis=0) if goal == "mse" else relative_spread(sheet, variance)
    wanted = _beside(np.nan_to_num(square), width, height) ** POWER
    more = np.zeros(pixels.size, np.int64)
    for colour in (0, 1):
        mine = np.flatnonzero(_halves(width, height) % 2 == colour)
        more[mine] = _shared(wanted[mine], mine.size * (settings.spp // film.BLOCK)) - 1
    yield _rows(pixels, more, film.BLOCK)


def relative_spread(sheet, variance):
    """variance (3, P), times n if it is that of the mean, over mean^2 + 0.01, mean of the channels, (P,)."""
    mean = sheet.mean().astype(np.float64)
    return (np.nan_to_num(variance) / (mean * mean + DARK)).mean(axis=0)


def _halves(width, height):
    """Number (P,) of the half that each pixel belongs to: 2 tile + colour.

    Tiles of one pixel's width or height at the border still have both colours, but for a lone pixel.
    """
    y, x = np.divmod(np.arange(width * height), width)
    across = max(width // TILE, 1)
    tile = np.minimum(y // TILE, max(height // TILE, 1) - 1) * across + np.minimum(x // TILE, across - 1)
    return 2 * tile + (x + y) % 2


def _beside(values, width, height):
    """Mean (P,) of each pixel's neighbours to the left, right, above and below."""
    padded = np.pad(values.reshape(height, width).astype(np.float64), 1)
    there = np.pad(np.ones((height, width)), 1)

    def around(a):
        return a[1:-1, :-2] + a[1:-1, 2:] + a[:-2, 1:-1] + a[2:, 1:-1]

    return (around(padded) / np.maximum(around(there), 1.0)).ravel()


def _shared(wanted, blocks):
    """Whole numbers of blocks (P,), at least 1 each and about `blocks` in all, in proportion to `wanted`."""
    low, high = 0.0, blocks / max(wanted.max(initial=0.0), np.finfo(np.float64).tiny)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.maximum(middle * wanted, 1.0).sum() <= blocks else (low, middle)
    # Each pixel's fraction of a block is kept by rounding the running sum.
    ends = np.rint(np.cumsum(np.maximum(low * wanted, 1.0))).astype(np.int64)
    return np.maximum(np.diff(ends, prepend=0), 1)


def _rows(pixels, blocks, sample):
    """Tasks for `blocks` (P,) blocks of each of some pixels (P,), from number `sample` on, block by block."""
    pixel = np.repeat(pixels, blocks)
    number = np.arange(pixel.size) - np.repeat(np.cumsum(blocks) - blocks, blocks)
    order = np.argsort(number, kind="stable")
    return waves.rows(pixel[order], sample + film.BLOCK * number[order])
