"""Snell's law and the critical angle, on the paths that the lesson shows."""

import numpy as np

from tracer.bsdf import fresnel

DEPTH, DEEPER = 2.0, 5.0  # metres of water above the eye: in the scene, and in the question
CLOSE = 4  # pixels between the rim and an answer


def experiment(run):
    """Angles in degrees, lengths in metres."""
    ray, bounce = run.path("start").events[1:3]
    cos_water, cos_air = abs(ray.values["cos_wo"]), bounce.values["cos"]
    eta = float(bounce.values["eta"])
    assert np.isclose(sine(cos_water), eta * sine(cos_air), rtol=1e-5)  # Snell

    critical = np.arcsin(eta)
    just_inside, just_outside = np.cos(critical - 1e-6), np.cos(critical + 1e-6)
    assert fresnel.dielectric(just_inside, eta)[0] < 1.0 == fresnel.dielectric(just_outside, eta)[0]

    radius = DEPTH * np.tan(critical)
    seen = edge(run)
    assert abs(seen - radius) < 0.1  # of the picture's window, measured pixel by pixel
    return {
        "angle_water": degrees(cos_water),
        "angle_air": degrees(cos_air),
        "critical": np.degrees(critical),
        "water": 1.0 / eta,
        "depth": DEPTH,
        "radius": radius,
        "edge": seen,
        "gain": 1.0 / eta**2,
        "deeper": DEEPER,
        "radius_deeper": DEEPER * np.tan(critical),
        "diameter_deeper": 2.0 * DEEPER * np.tan(critical),
        "with_sine": DEEPER * np.sin(critical),
        "with_inverse": DEEPER / np.tan(critical),
    }


def sine(cos):
    return np.sqrt(1.0 - cos * cos)


def degrees(cos):
    return float(np.degrees(np.arccos(cos)))


def edge(run):
    """How far from straight above the first ray meets the surface that it cannot leave through."""
    row = run.lesson.moments["start"].y
    for x in range(150, 170):
        events = run.pixel(x, row).paths[0].events
        if mirrored(events):
            return float(np.hypot(events[1].values["p"][0], events[1].values["p"][2]))
    raise AssertionError("the window has no rim")


def mirrored(events):
    """Whether the first surface reflects all."""
    return events[2].kind.name == "bounce" and bool((events[2].values["F"] == 1.0).all())


def at_the_rim(run, x, y):
    """Whether all light of a pixel is reflected, and not all of it a few pixels nearer to the centre."""
    settings = run.settings()
    middle = np.array([settings.width, settings.height]) / 2
    way = middle - (x, y)
    length = float(np.hypot(*way))
    if length < CLOSE or not all(mirrored(path.events) for path in run.pixel(x, y).paths):
        return False
    nearer = np.round((x, y) + way * (CLOSE / length)).astype(int)
    return not all(mirrored(path.events) for path in run.pixel(*map(int, nearer)).paths)
