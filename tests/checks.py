"""The suite's checks of a tracer's numbers, for right steps and for the zoo's wrong ones alike.

Each gives how far off the steps are, in units of what is allowed: up to 1 is right.
"""

from collections import deque

import numpy as np
from stats import mean_and_error

import tracer
from tracer.engine import waves
from tracer.integrator.steps import RIGHT
from tracer.integrator.wave import Wave

SIGMAS = 4.0  # standard errors: a right tracer is further off once in 16 000 comparisons
ROUNDING = {32: 1e-5, 64: 1e-12}  # relative, on top
TAIL = 5.0

# Region means of the homework's Cornell box, linear RGB, and the regions as fractions of the picture
# (x0, y0, x1, y1), from the homework's own framework at 784 x 784 with its mistakes mended.
HOMEWORK = {
    "left wall": ((0.04, 0.3, 0.14, 0.7), (0.4242, 0.0345, 0.0194)),
    "right wall": ((0.86, 0.3, 0.96, 0.7), (0.1052, 0.2550, 0.0386)),
    "ceiling": ((0.55, 0.06, 0.75, 0.12), (0.1992, 0.1614, 0.0826)),
    "floor": ((0.12, 0.90, 0.35, 0.96), (0.4479, 0.2966, 0.2188)),
    "back wall": ((0.60, 0.30, 0.75, 0.45), (0.5246, 0.4451, 0.2822)),
    "lamp": ((0.44, 0.14, 0.56, 0.16), (47.835, 38.566, 31.081)),
    "picture": ((0.0, 0.0, 1.0, 1.0), (0.5058, 0.3732, 0.2551)),
}
# The same regions of the same scene at 196 x 196 by Mitsuba 3.9.1 (scalar_rgb, path, unlimited depth, box
# filter, 64 samples a pixel).
MITSUBA = {
    "left wall": (0.4312955, 0.03511215, 0.01975103),
    "right wall": (0.10364848, 0.25026298, 0.03786691),
    "ceiling": (0.20575303, 0.1659295, 0.08612284),
    "floor": (0.4532573, 0.3005032, 0.22128801),
    "back wall": (0.5209087, 0.44352514, 0.28025737),
}


def traced(scene, settings, steps, x, y, sample):
    """Radiance (3, N) of the paths (x, y, sample), as it counts in the film."""
    scene, out = scene.at(settings), []
    for start in range(0, x.size, waves.LANES):
        part = slice(start, start + waves.LANES)
        wave = Wave(x[part], y[part], sample[part], settings, steps)
        deque(waves.events(scene, settings, wave), maxlen=0)
        out.append(wave.radiance)
    return np.concatenate(out, axis=1)


def samples(scene, settings, steps=RIGHT, pixels=None):
    """Radiance (3, P, spp) of every sample of the pixels, all of them or those numbered line by line."""
    settings = settings.at_size_of(scene)
    pixels = np.arange(settings.width * settings.height) if pixels is None else np.asarray(pixels)
    pixel, sample = np.repeat(pixels, settings.spp), np.tile(np.arange(settings.spp), pixels.size)
    radiance = traced(scene, settings, steps, pixel % settings.width, pixel // settings.width, sample)
    return radiance.astype(np.float64).reshape(3, pixels.size, settings.spp)


def furnace(settings, steps=RIGHT, scene="furnace", Le=1.0, rho=0.5):
    """A closed room of albedo rho that shines with Le: Le (1 - rho^k) / (1 - rho) for max_depth k."""
    truth = (
        Le * (1.0 - rho**settings.max_depth) / (1.0 - rho) if settings.max_depth >= 0 else Le / (1.0 - rho)
    )
    cubic = scene == "furnace"
    radiance = samples(tracer.load(scene) if cubic else scene, settings, steps)
    mean, error = mean_and_error(radiance)
    slack = ROUNDING[settings.precision] * truth
    if cubic and (settings.integrator == "direct" or settings.strategy == "light"):
        slack += TAIL * radiance.max() / radiance[0].size  # a variance without bound, see test_furnace
    return off(mean, truth, error, slack)


def off(a, b, error, slack=0.0):
    """|a - b| in units of SIGMAS standard errors + slack; infinite where either is not a number."""
    distance = np.abs(np.subtract(a, b)) / (SIGMAS * np.asarray(error) + slack + np.finfo(float).tiny)
    return float(np.where(np.isfinite(distance), distance, np.inf).max())


def blocks(radiance, settings, across):
    """Samples (3, P, S) of a whole picture, cut into across x across blocks: (3, P', S) each."""
    whole = radiance.reshape(3, settings.height, settings.width, -1)
    for row in np.array_split(np.arange(settings.height), across):
        for column in np.array_split(np.arange(settings.width), across):
            part = whole[:, row[0] : row[-1] + 1, column[0] : column[-1] + 1]
            yield part.reshape(3, -1, part.shape[-1])


def agreement(a, b):
    """Two lists of samples (3, P, S), region by region, against their joint standard errors."""
    worst = 0.0
    for one, other in zip(a, b, strict=True):
        (mean_a, error_a), (mean_b, error_b) = mean_and_error(one), mean_and_error(other)
        rounding = ROUNDING[32] * np.abs(mean_a)
        worst = max(worst, off(mean_a, mean_b, np.hypot(error_a, error_b), rounding))
    return worst


def region(name, width, height):
    """Numbers of the pixels whose centres lie in a region of the homework's picture."""
    x0, y0, x1, y1 = HOMEWORK[name][0]
    y, x = np.divmod(np.arange(width * height), width)
    x, y = (x + 0.5) / width, (y + 0.5) / height
    return np.flatnonzero((x >= x0) & (x < x1) & (y >= y0) & (y < y1))


def homework(name, settings, steps=RIGHT, pixels=None):
    """A region's mean against the homework's: 1 % and SIGMAS standard errors are allowed.

    pixels: how many of the region's to trace, spread evenly; all of them if None.
    """
    scene = tracer.load("cornell")
    numbers = region(name, settings.width, settings.height)
    if pixels:
        numbers = numbers[np.linspace(0, numbers.size - 1, min(pixels, numbers.size)).astype(int)]
    mean, error = mean_and_error(samples(scene, settings, steps, numbers))
    truth = np.array(HOMEWORK[name][1])
    return off(mean, truth, error, 0.01 * truth), mean, error
