"""The mean of samples f / p, how far it may be off, and what four times as many samples change."""

import numpy as np

from lessons.zoo.film import curved
from tracer.film import gather

MANY = 16384
QUARTERED = 4  # times as many samples


def experiment(run):
    """Means and standard errors of one pixel's samples, green channel."""
    hit = float(run.event("start")["contribution"][1])
    few = run.wave("start")
    count = few.settings.spp
    more = run.wave("start", spp=QUARTERED * count)
    by_light = run.wave("light", spp=4096).radiance[1].astype(float)
    true = by_light.mean()  # light samples: the same integral, with far less noise

    chance = true / hit
    sigma = hit * np.sqrt(chance * (1.0 - chance))
    many = run.wave("start", spp=MANY).radiance[1]
    assert set(np.round(many / hit, 5)) == {0.0, 1.0}  # all or nothing
    assert abs(many.mean() - true) < 5.0 * sigma / np.sqrt(MANY)
    assert abs(many.std() / sigma - 1.0) < 0.05

    relative = sigma / true
    bent = curved(np.array([hit]), None, None)[0]
    return {
        "count": count,
        "hits": int(np.count_nonzero(few.radiance[1])),
        "mean": mean(few),
        "error": error(few),
        "true": true,
        "chance": chance,
        "one_in": 1.0 / chance,
        "sigma": sigma,
        "relative": relative,
        "expected_error": sigma / np.sqrt(count),
        "more": QUARTERED * count,
        "more_mean": mean(more),
        "more_error": error(more),
        "needed": (relative / 0.01) ** 2,
        "not_squared": relative / 0.01,
        "divided_once": relative**2 / 0.01,
        "of_the_variance": sigma**2 / 0.01,
        "light_relative": by_light.std() / true,
        "light_needed": (by_light.std() / true / 0.01) ** 2,
        "clamped": chance,
        "clamped_share": chance / true,
        "bent_share": (chance * bent) ** 2.2 / true,
    }


def mean(wave):
    return float(gather(wave.radiance).mean()[1, 0])


def error(wave):
    return float(np.sqrt(gather(wave.radiance).variance()[1, 0]))


def reaches_the_lamp(run, path):
    """Whether a sample of the pixel brings light, other than the one that the text shows."""
    at = run.lesson.moments["start"]
    light = run.pixel(at.x, at.y).paths[path].events[-1].values["radiance"]
    return path != at.path and bool((light > 0.0).all())
