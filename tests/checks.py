"""The suite's checks of a tracer's numbers, for right steps and for the zoo's wrong ones alike.

Each gives how far off the steps are, in units of what is allowed: up to 1 is right.
"""

from collections import deque

import numpy as np
from cases import INTEGRATORS, loaded
from glass import SIGMA_T, THICK, filled, lamp_behind, slab, slab_shares
from stats import chi_square, mean_and_error, sidak, uniform

import tracer
from tracer import Settings
from tracer.engine import waves
from tracer.events import BOUNCE, HIT, LIGHT
from tracer.frame import Frame, length
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
    alone = settings.integrator == "direct" or settings.strategy == "light"
    if cubic and alone and settings.light_sampling == "area":
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


def agreement(a, b, heavy=False):
    """Two lists of samples (3, P, S), region by region, against their joint standard errors.

    heavy: whether one of them may have no finite variance, see test_furnace.
    """
    worst = 0.0
    for one, other in zip(a, b, strict=True):
        (mean_a, error_a), (mean_b, error_b) = mean_and_error(one), mean_and_error(other)
        slack = ROUNDING[32] * np.abs(mean_a)
        if heavy:
            slack = slack + TAIL * max(s.max() / s[0].size for s in (one, other))
        worst = max(worst, off(mean_a, mean_b, np.hypot(error_a, error_b), slack))
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


def some_events(scene, settings, steps, *kinds):
    """The events of some kinds, and for each the columns of the last HIT of its paths."""
    settings = settings.at_size_of(loaded(scene))
    ready = loaded(scene).at(settings)
    pixel, sample = np.divmod(np.arange(settings.width * settings.height * settings.spp), settings.spp)
    wave = Wave(pixel % settings.width, pixel // settings.width, sample, settings, steps)
    vertex = {name: np.zeros((3, pixel.size), settings.dtype) for name in ("p", "n")}
    for event in waves.events(ready, settings, wave):
        if event.kind is HIT:
            for name, column in vertex.items():
                column[:, event.lane] = event.columns[name]
        if event.kind in kinds:
            yield event.columns, {name: column[:, event.lane] for name, column in vertex.items()}


def bounces(seed, steps=RIGHT):
    """Directions of diffuse bounces, carried back to the unit square by cos/pi, and the density they name."""
    settings = Settings(width=32, height=32, spp=8, integrator="walk", max_depth=4, seed=seed)
    squares, wrong = [np.zeros((2, 0))], 0.0
    for bounce, hit in some_events("cornell_unit", settings, steps, BOUNCE):
        x, y, z = Frame.around(hit["n"]).to_local(bounce["wi"]).astype(float)
        squares.append(np.stack((np.arctan2(y, x) / (2 * np.pi) % 1.0, 1.0 - z * z)))
        wrong = max(wrong, np.abs(bounce["pdf"] * np.pi - z).max(initial=0.0))
    squares = np.concatenate(squares, axis=1)
    if not squares.size:
        return np.inf
    p = uniform(np.clip(squares, 0, 1), 16)
    return max(sidak(1) / max(p, 1e-300), wrong / ROUNDING[32])


def lamp_points(seed, steps=RIGHT):
    """Points on the lamp of the unit box fill it evenly."""
    settings = Settings(
        width=32, height=32, spp=8, integrator="direct", max_depth=2, light_sampling="area", seed=seed
    )
    q = np.concatenate([e["q"] for e, _ in some_events("cornell_unit", settings, steps, LIGHT)], axis=1)
    place = np.stack(((q[0] + 0.23) / 0.46, (q[2] - 0.01 + 0.19) / 0.38)).astype(float)
    grid = np.histogram2d(*np.clip(place, 0, 1), bins=16, range=((0, 1), (0, 1)))[0]
    return sidak(1) / max(chi_square(grid, np.full(grid.shape, grid.sum() / grid.size)), 1e-300)


def shadows(seed, steps=RIGHT):
    """What light samples see against plain rays in float64 that stop well before either end.

    One answer in a thousand may differ: the ends that are cut off may have touched something.
    """
    settings = Settings(width=32, height=32, spp=8, integrator="direct", max_depth=2, seed=seed)
    scene, gap, differ, asked = loaded("cornell_unit").at(Settings(precision=64)), 1e-3, 0, 0
    for light, hit in some_events("cornell_unit", settings, steps, LIGHT):
        open_to = (light["f"] > 0).any(axis=0) & (light["Le"] > 0).any(axis=0)
        p, q = hit["p"][:, open_to].astype(float), light["q"][:, open_to].astype(float)
        r = length(q - p)
        wi = (q - p) / r
        with np.errstate(all="ignore"):
            t, _ = scene.intersect(p + gap * wi, wi, np.full(r.size, -1))
        differ += np.count_nonzero((t > r - 2 * gap) != light["visible"][open_to])
        asked += r.size
    return differ / (1e-3 * asked)


def spread(seed, steps=RIGHT):
    """Variance of single samples in the unit box against what direct has there, 0.0217 within its pixels.

    A quarter more is allowed: an estimator may be right on average and still useless.
    """
    settings = Settings(width=32, height=32, spp=32, integrator="direct", light_sampling="area", seed=seed)
    below = samples(loaded("cornell_unit"), settings, steps, np.arange(8 * 32, 32 * 32))
    return below[0].var(axis=1).mean() / (1.25 * 0.0217)


def energy(seed, steps=RIGHT):
    """The furnace with every loop at a few depths."""
    return max(
        furnace(Settings(width=16, height=16, spp=64, max_depth=k, integrator=name, seed=seed), steps)
        for name in INTEGRATORS
        for k in (1, 2, 8)
    )


def loops(seed, steps=RIGHT):
    """The three loops in the unit box, walk coarsely and the others block by block."""
    side, found = 32, {}
    for k, (name, spp) in enumerate((("walk", 256), ("direct", 24), ("path", 24))):
        settings = Settings(width=side, height=side, spp=spp, integrator=name, seed=seed + k)
        found[name] = samples(loaded("cornell_unit"), settings, steps)
    fine = agreement(blocks(found["direct"], settings, 4), blocks(found["path"], settings, 4))
    return max(fine, agreement([found["walk"]], [found["direct"]]))


def coloured(seed, steps=RIGHT):
    """What a slab of coloured glass lets through."""
    settings = Settings(width=1, height=1, spp=4000, seed=seed, max_depth=12, roulette="off")
    mean, error = mean_and_error(samples(lamp_behind(slab=slab(interior=filled())), settings, steps))
    truth = slab_shares(0.04, np.exp(-THICK * np.array(SIGMA_T)))[0]
    return off(mean, truth, error, 1e-5 * truth)


def regions(seed, steps=RIGHT):
    """The homework's regions."""
    settings = Settings(width=784, height=784, spp=4, seed=seed, integrator="direct", jitter=False)
    return max(homework(name, settings, steps, 600)[0] for name in HOMEWORK if name != "picture")


# From the cheapest to the dearest.
CHECKS = (lamp_points, bounces, coloured, shadows, spread, energy, regions, loops)
