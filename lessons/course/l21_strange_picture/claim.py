"""The abandoned castRay taken apart: what each of its three mistakes does alone, and on top of the others."""

from collections import deque

import numpy as np

from lessons import zoo
from lessons.zoo.bug import CENTRES
from tracer.engine import waves
from tracer.integrator.wave import Wave
from tracer.light.sample import luminance
from tracer.settings import Settings

SIDE, PIXELS = 128, 200  # of the picture, and how many of its pixels are traced in each region
FEW, SOME, MANY = 2, 10, 64  # samples of a pixel
COARSE = 40  # side of the picture of the last run
# Parts of the picture (x0, y0, x1, y1).
REGIONS = {
    "left": (0.04, 0.3, 0.14, 0.7),
    "right": (0.86, 0.3, 0.96, 0.7),
    "ceiling": (0.55, 0.06, 0.75, 0.12),
    "floor": (0.12, 0.9, 0.35, 0.96),
    "back": (0.6, 0.3, 0.75, 0.45),
}
ROWS = {"r": "", "d": "D01", "m": "D06", "dm": "D01,D06"}  # without E01, by the names of their values


def experiment(run):
    """Luminance over the correct one: ROW_REGION, with an e before the rows that have E01 as well."""
    albedo = run.event("start")["albedo"]
    assert 9.0 < albedo[0] / albedo[1] < 10.0  # "nearly ten times"
    rows = {row: regions(run, SOME, bugs) for row, bugs in ROWS.items()}
    right = {name: luminance(light).mean() for name, light in rows["r"].items()}
    salt = regions(run, MANY, integrator="walk")
    added = {name: luminance(light).mean() / right[name] for name, light in salt.items()}
    errors = {name: error(light) / right[name] for name, light in salt.items()}
    assert all(abs(added[name] - 1.0) < 4.0 * errors[name] for name in REGIONS)
    for bugs in ("", "D01,D06"):
        adds_what_bounces_find(run, bugs)

    found = {}
    for row, parts in rows.items():
        for name, light in parts.items():
            ratio = luminance(light).mean() / right[name]
            found |= {f"{row}_{name}": ratio, f"e{row}_{name}": ratio + added[name]}
    assert 0.4 < found["d_left"] < 0.6 and found["m_left"] > 2.0 > 1.1 > found["m_back"]
    wide, usual, both = (luminance(part["back"]).std() for part in (salt, rows["r"], rows["dm"]))
    return found | {
        "error": max(errors.values()),
        "red": red_over_green(rows["r"]["left"]),
        "red_m": red_over_green(rows["m"]["left"]),
        "predicted": found["dm_left"] + 1.0,
        "doubled": found["dm_left"] * 2.0,
        "alone": found["dm_left"],
        "added_up": 2.0 + found["d_left"] + found["m_left"],
        "spread": np.hypot(wide, usual) / usual,
        "spread_others": both / usual,
        "grey": run.event("light")["f"][0] * np.pi,
        "black": 100.0 * last_run(run),
    }


def adds_what_bounces_find(run, bugs):
    """Sample by sample, E01 adds what a tracer without light samples finds, whatever else is wrong."""
    without, found = regions(run, FEW, bugs), regions(run, FEW, integrator="walk")
    for name, light in regions(run, FEW, f"E01,{bugs}".strip(",")).items():
        assert np.allclose(light, without[name] + found[name], rtol=1e-4, atol=1e-5)


def regions(run, spp, bugs="", **options):
    """Region -> radiance (3, N) of its samples."""
    pixels = np.concatenate([np.repeat(some_pixels(part), spp) for part in REGIONS.values()])
    light = radiance(run, bugs, SIDE, pixels, np.tile(np.arange(spp), PIXELS * len(REGIONS)), **options)
    return dict(zip(REGIONS, np.split(light, len(REGIONS), axis=1), strict=True))


def some_pixels(part):
    """Numbers of PIXELS pixels that lie inside a part of the picture, spread over it."""
    x0, y0, x1, y1 = (edge * SIDE for edge in part)
    y, x = np.divmod(np.arange(SIDE * SIDE), SIDE)
    inside = np.flatnonzero((x > x0) & (x < x1 - 1.0) & (y > y0) & (y < y1 - 1.0))
    return inside[np.linspace(0, inside.size - 1, PIXELS).astype(int)]


def last_run(run):
    """The share of black pixels where the roulette lets one path of five live, with two samples."""
    pixels = np.repeat(np.arange(COARSE * COARSE), 2)
    light = radiance(run, "castray", COARSE, pixels, np.arange(pixels.size) % 2, roulette="0.2")
    return np.mean(light.reshape(3, -1, 2).max(axis=(0, 2)) <= 0.0)


def radiance(run, bugs, side, pixels, sample, **options):
    """Radiance (3, N) of some paths of the homework's tracer with bugs."""
    options = {"integrator": "direct", **CENTRES, **options}
    settings = Settings(width=side, height=side, spp=int(sample.max()) + 1, **options)
    steps = zoo.steps(bugs) if bugs else zoo.RIGHT
    wave = Wave(pixels % side, pixels // side, sample, settings, steps)
    deque(waves.events(run.scene().at(settings), settings, wave), maxlen=0)
    return wave.radiance.astype(np.float64)


def error(light):
    """Standard error of the mean luminance of samples (3, N)."""
    return luminance(light).std(ddof=1) / np.sqrt(light.shape[1])


def red_over_green(light):
    """How much redder than green samples (3, N) are on average."""
    return light[0].mean() / light[1].mean()
