"""The lamp found by a light sample and by a bounce is the same light: either may count it, not both."""

import numpy as np

ALONE = {"integrator": "path", "roulette": "off", "max_depth": 2, "spp": 32768}


def experiment(run):
    """Radiance in red; shares as fractions."""
    found, beta = run.event("found"), run.event("roulette")["beta"]
    assert found["w"] == 0.0 and run.event("twice")["w"] == 1.0
    salt = beta[0] * found["Le"][0]
    assert np.isclose(salt, run.event("twice")["contribution"][0])

    by_light, error_light = red(run.wave(strategy="light", **ALONE))
    by_bounce, error_bounce = red(run.wave(strategy="bsdf", **ALONE))
    assert abs(by_light - by_bounce) < 4.0 * np.hypot(error_light, error_bounce)

    right, error = red(run.wave(spp=8192))
    wrong, error_wrong = red(run.wave("twice", spp=8192))
    lamp_once = right - red(run.wave(spp=8192, max_depth=1))[0]
    assert abs(wrong - right - lamp_once) < 4.0 * np.hypot(error, error_wrong)

    light, bounce = run.event("start"), run.event("bounce")
    spp = run.settings().spp
    return {
        "salt": salt,
        "salt_without_roulette": bounce["beta"][0] * found["Le"][0],
        "salt_without_beta": found["Le"][0],
        "salt_of_light": light["contribution"][0],
        "salt_in_pixel": salt / spp,
        "spp": spp,
        "by_light": by_light,
        "by_bounce": by_bounce,
        "error_light": error_light,
        "error_bounce": error_bounce,
        "right": right,
        "wrong": wrong,
        "error_wrong": error_wrong,
        "ratio": wrong / right,
        "noise": (error_wrong / error) ** 2,
        "bright": red_pixel(run, "twice"),
        "usual": red_pixel(run, "start"),
    }


def red(wave):
    """Mean of a wave's paths in red, and its standard error."""
    values = wave.radiance[0].astype(np.float64)
    return float(values.mean()), float(values.std(ddof=1) / np.sqrt(values.size))


def red_pixel(run, moment):
    """The pixel of a moment in red, with the few samples that the lesson shows."""
    at = run.lesson.moments[moment]
    return float(run.pixel(at.x, at.y, moment).value[0])
