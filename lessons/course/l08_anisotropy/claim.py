"""Facets spread more across the scratches than along them: D with two roughnesses, and the frame it needs."""

import numpy as np

from tracer.bsdf.microfacet import Facets, unit
from tracer.bsdf.roughconductor import RoughConductor

TILT = 10.0  # degrees of the facet in the question
STREAK = 1.0  # mean of D over a pixel's paths that makes a streak of it
MIDDLE = 64  # row of the ring's centre in the picture


def experiment(run):
    """Densities of facets in 1/sr, and what becomes of f when both directions turn."""
    brushed = run.scene().definition.bsdfs["brushed"]
    u, v = float(brushed.alpha_u[0]), float(brushed.alpha_v[0])
    along, across = tilted(u, v, along=True), tilted(u, v, along=False)
    assert np.isclose(along, ggx(u, v, np.sin(np.radians(TILT)), 0.0), rtol=1e-6)
    isotropic = np.sqrt(u * v)
    assert np.isclose(peak(isotropic, isotropic), peak(u, v))
    turned, unturned = quarter_turn(brushed)
    alike = RoughConductor(
        *(np.array([isotropic]),) * 2, brushed.eta, brushed.k, brushed.specular_reflectance, "ggx"
    )
    same = quarter_turn(alike)
    assert np.isclose(*same) and not np.isclose(turned, unturned)
    wrong = run.event("mistake")
    assert wrong["f"][0] > 100.0 * run.event("dark")["f"][0]
    return {
        "u": u,
        "v": v,
        "tilt": TILT,
        "along": along,
        "across": across,
        "times": across / along,
        "no_square": np.sqrt(across / along),
        "ratio": v / u,
        "ratio_squared": (v / u) ** 2,
        "peak": peak(u, v),
        "geometric": isotropic,
        "middle": (u + v) / 2.0,
        "product": u * v,
        "quadratic": np.hypot(u, v) / np.sqrt(2.0),
        "turned": turned / unturned,
        "dark_f": run.event("dark")["f"][0],
    }


def tilted(u, v, along):
    """D of a facet tilted along the scratches, or across them."""
    sin, cos = np.sin(np.radians(TILT)), np.cos(np.radians(TILT))
    m = np.array([[sin if along else 0.0], [0.0 if along else sin], [cos]])
    return float(Facets("ggx", np.array([u]), np.array([v])).D(m)[0])


def ggx(u, v, x, y):
    """The density in the form of the text."""
    z2 = 1.0 - x * x - y * y
    return 1.0 / (np.pi * u * v * (x * x / u**2 + y * y / v**2 + z2) ** 2)


def peak(u, v):
    return ggx(u, v, 0.0, 0.0)


def quarter_turn(material):
    """f for two directions, and for the same two after a quarter turn about the normal."""
    wo, wi = (unit(np.array(w)[:, None]) for w in ([0.5, 0.1, 1.0], [-0.3, -0.1, 1.0]))
    turn = [material.eval(w, x)[0, 0] for w, x in ((wo, wi), (quarter(wo), quarter(wi)))]
    return float(turn[1]), float(turn[0])


def quarter(w):
    return np.stack((-w[1], w[0], w[2]))


def is_lower_streak(run, x, y):
    """Whether a pixel lies on the ring below its centre where the light samples meet many facets."""
    scene, found = run.scene().at(run.settings()), []
    for path in run.pixel(x, y).paths:
        hit, light = (event.as_dict(scene) for event in path.events[1:3])
        if y <= MIDDLE or hit.get("shape") != "ring" or light["kind"] != "light":
            return False
        found.append(light["D"])
    return bool(np.mean(found) > STREAK)
