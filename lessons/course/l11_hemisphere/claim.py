"""Two samplers of the hemisphere, each with its own density and with the other's, in a room of even light."""

import numpy as np

from tracer import warp

RHO = 0.5  # albedo of the furnace's walls, which shine with radiance 1
BRIGHTER = 0.6
DIRECTIONS = 4096
TILT = 60.0  # degrees from the normal


def experiment(run):
    """Radiances in the furnace, and shares of the directions."""
    cosine, uniform = values(run, "start"), values(run, "uniform", spp=4096)
    one = 1.0 + RHO
    assert np.allclose(cosine, one, rtol=1e-6)  # every sample alike
    assert off(uniform, one) < 5.0
    assert abs(uniform.var() / (RHO**2 / 3.0) - 1.0) < 0.1

    mixed = 4.0 / 3.0  # mean of (cos / pi) / (1 / 2 pi) over directions with density cos / pi
    wrong = 1.0 / (1.0 - RHO * mixed)
    assert off(values(run, "mistake", spp=4096), 1.0 + RHO * mixed) < 5.0
    assert off(values(run, "mistake", spp=4096, max_depth=-1), wrong) < 5.0
    assert off(values(run, "start", spp=4096, max_depth=-1), 1.0 / (1.0 - RHO)) < 5.0

    forgotten = RHO / np.pi / 2.0  # mean of f cos over uniform directions
    assert off(values(run, "forgotten", spp=4096), 1.0 + forgotten) < 5.0
    assert off(values(run, "inside", spp=4096), one) < 5.0
    assert np.allclose(values(run, "octant"), one, rtol=1e-6)  # even light does not show it

    u = np.random.default_rng(0).random((2, DIRECTIONS))
    return {
        "one": one,
        "furnace": 1.0 / (1.0 - RHO),
        "spread": float(uniform.std()),
        "factor": mixed,
        "wrong_one": 1.0 + RHO * mixed,
        "wrong": wrong,
        "brighter": BRIGHTER,
        "right_brighter": 1.0 / (1.0 - BRIGHTER),
        "wrong_brighter": 1.0 / (1.0 - BRIGHTER * mixed),
        "brighter_once": 1.0 + BRIGHTER * mixed,
        "brighter_times": mixed / (1.0 - BRIGHTER),
        "forgotten": 1.0 + forgotten,
        "inside_spread": float(values(run, "inside", spp=4096).std()),
        "tilt": TILT,
        "directions": DIRECTIONS,
        "cosine_share": within(warp.cosine_hemisphere(u)),
        "uniform_share": within(warp.uniform_hemisphere(u)),
        "cosine_chance": 1.0 - np.cos(np.radians(TILT)) ** 2,
        "uniform_chance": 1.0 - np.cos(np.radians(TILT)),
        "by_angle": TILT / 90.0,
        "outside": np.cos(np.radians(TILT)) ** 2,
    }


def values(run, moment, **differently):
    """Radiance of each sample, green channel."""
    return run.wave(moment, **differently).radiance[1].astype(float)


def off(samples, value):
    """By how many standard errors the mean of samples is away from a value."""
    return abs(samples.mean() - value) / (samples.std() / np.sqrt(samples.size))


def within(w):
    """Share of directions that lie within the tilt of the normal."""
    return float((w[2] > np.cos(np.radians(TILT))).mean())
