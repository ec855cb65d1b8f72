"""Why f = albedo / pi: the cosine's integral over the hemisphere is pi, and a furnace shows the rest."""

import numpy as np

import tracer
from tracer import warp
from tracer.scene_file.change import changed

ALBEDO, BRIGHTER = 0.5, 0.8  # of the room, and of the room in the question
SKY, ROOF = 3.0, 0.8  # radiance of the sky, albedo of the roof
DIRECTIONS = 100_000


def experiment(run):
    """The integral of the cosine, radiances of the furnace, and of the roof."""
    wi = warp.uniform_hemisphere(np.random.default_rng(2).random((2, DIRECTIONS)))
    weight = wi[2] / warp.uniform_hemisphere_pdf(wi)
    measured, error = weight.mean(), weight.std() / np.sqrt(DIRECTIONS)
    assert abs(measured - np.pi) < 5.0 * error
    half = np.where(wi[0] > 0.0, weight, 0.0)
    assert abs(half.mean() - np.pi / 2.0) < 5.0 * half.std() / np.sqrt(DIRECTIONS)

    depth = run.settings().max_depth
    value = float(run.path("start").radiance[0])
    assert np.isclose(value, (1.0 - ALBEDO**depth) / (1.0 - ALBEDO), rtol=1e-5)
    factor = run.event("mistake")["beta"][0] / run.event("mistake")["beta_before"][0]
    assert np.isclose(factor, np.pi * ALBEDO, rtol=1e-5)
    return {
        "directions": DIRECTIONS,
        "pi_measured": measured,
        "pi": np.pi,
        "albedo": ALBEDO,
        "value": value,
        "furnace": 1.0 / (1.0 - ALBEDO),
        "burnt": float(run.path("mistake").radiance[0]),
        "factor": factor,
        "limit": 1.0 / np.pi,
        "brighter": BRIGHTER,
        "brighter_furnace": in_furnace(run),
        "one_bounce": 1.0 + BRIGHTER,
        "in_proportion": BRIGHTER / ALBEDO / (1.0 - ALBEDO),
        "inverse": 1.0 / BRIGHTER,
        "sky": SKY,
        "roof": ROOF,
        "roof_half": ROOF * SKY / 2.0,
        "roof_whole": ROOF * SKY,
        "roof_over_pi": ROOF * SKY / np.pi,
        "roof_half_over_pi": ROOF * SKY / np.pi / 2.0,
    }


def in_furnace(run):
    """The furnace's radiance with brighter walls, cut off where nothing is left."""
    at = run.lesson.moments["start"]
    settings = run.settings()
    brighter = changed(run.scene(), {"grey.reflectance": BRIGHTER})
    long = tracer.Settings(**(settings.as_dict() | {"max_depth": 80, "spp": 1}))
    value = float(tracer.inspect(brighter, long, at.x, at.y).value[0])
    assert np.isclose(value, 1.0 / (1.0 - BRIGHTER), rtol=1e-5)
    return value
