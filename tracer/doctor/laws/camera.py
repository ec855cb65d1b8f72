"""Where paths begin."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.rule import Outcome, Rule
from tracer.frame import normalize


def ray(evidence):
    """I13: each path starts at the lens, along the ray of its place on the film."""
    camera, settings = evidence.scene.camera, evidence.settings
    width, height = settings.width, settings.height
    origin = camera.origin[:, None]

    def direction(film, o):
        _, d = camera.rays(film, width, height, np.float64)
        if not camera.aperture_radius:
            return d
        forward = (d * camera.forward[:, None]).sum(axis=0)
        return normalize(origin + d / forward * camera.focus_distance - o)

    off = 4.0 * evidence.eps * max(width, height)
    inputs = {"film": (evidence("camera.film"), off), "o": (evidence("camera.o"), evidence.off_point)}
    rows = np.arange(evidence.count("camera"))
    return judged(
        evidence,
        "camera",
        rows,
        evidence("camera.d"),
        direction,
        inputs,
        "d",
        sound=evidence.is_unit("camera.d"),
        absolute=evidence.off_unit,
    )


def start(evidence):
    """Paths start on the lens."""
    camera = evidence.scene.camera
    out = evidence("camera.o") - camera.origin[:, None]
    far = np.sqrt((out * out).sum(axis=0))
    bad = ~(far <= camera.aperture_radius * (1.0 + evidence.off_unit) + 2.0 * evidence.off_point)
    return Outcome(
        "camera",
        np.arange(bad.size),
        bad,
        np.zeros_like(bad),
        far,
        np.full(bad.size, camera.aperture_radius),
        "|o - eye|",
    )


def within_pixel(evidence):
    """The place on the film lies in the path's pixel, in its middle without jitter."""
    x, y = evidence("path.x"), evidence("path.y")
    path = evidence.trace.tables["camera"].path
    inside = evidence("camera.film") - np.stack((x, y))[:, path]
    off = 4.0 * evidence.eps * max(evidence.settings.width, evidence.settings.height)
    if evidence.settings.jitter:
        bad = (inside < -off) | (inside > 1.0 + off)
        right = np.clip(inside, 0.0, 1.0)
    else:
        bad = np.abs(inside - 0.5) > off
        right = np.full_like(inside, 0.5)
    bad = bad.any(axis=0)
    return Outcome("camera", np.arange(bad.size), bad, np.zeros_like(bad), inside, right, "film - pixel")


RULES = (
    Rule(
        "camera-pixel",
        "Paths start in their pixel",
        "A path's place on the film lies within its pixel.",
        "x <= film_x < x + 1, y <= film_y < y + 1",
        ("camera.film", "path.x", "path.y"),
        within_pixel,
    ),
    Rule(
        "camera-ray",
        "Camera rays go through their place on the film",
        "The first direction is that from the lens to the place on the film.",
        "d = normalize(forward + x tan(fov/2) right + y tan(fov/2) up)",
        ("camera.d", "camera.film", "camera.o"),
        ray,
    ),
    Rule(
        "camera-start",
        "Camera rays start on the lens",
        "The first ray starts at the camera.",
        "|o - eye| <= aperture",
        ("camera.o",),
        start,
    ),
)
