"""Facets: which of them send the light of a path, how many there are, and what f is made of."""

import numpy as np

from tracer.bsdf.microfacet import Facets, mirrored, unit

SMOOTH = 0.02  # the other roughness of the text
NEAR = 5.0  # degrees within which facets are counted
LEFT, RIGHT = 60.0, 20.0  # degrees from the normal, to either side, in the question
BRIGHT = 3.0  # mean of D over a pixel's paths that makes a highlight of it


def experiment(run):
    """Densities in 1/sr, angles in degrees, shares of the surface."""
    alpha = float(run.scene().definition.bsdfs["copper"].alpha_u[0])
    hit, light = run.event("surface"), run.event("start")
    h = unit(np.add(hit["wo"], light["wi"])[:, None])[:, 0]
    cos = float(h @ hit["n"])
    assert np.isclose(ggx(alpha, cos), light["D"], rtol=1e-3)
    made = light["F"][0] * light["D"] * light["G2"] / (4.0 * hit["cos_wo"] * light["cos"])
    assert np.isclose(made, light["f"][0], rtol=1e-4)
    wrong = run.event("mistake")
    assert wrong["f"][0] < 0.1 * made

    peak, smooth_peak = (float(facets(a).D(np.array([[0.0], [0.0], [1.0]]))[0]) for a in (alpha, SMOOTH))
    assert np.isclose(peak, 1.0 / (np.pi * alpha**2)) and np.isclose(smooth_peak, 1.0 / (np.pi * SMOOTH**2))
    return {
        "alpha": alpha,
        "smooth": SMOOTH,
        "tilt": degrees(cos),
        "made": made,
        "peak": peak,
        "smooth_peak": smooth_peak,
        "near": NEAR,
        "within": within(alpha, np.radians(NEAR)),
        "smooth_within": within(SMOOTH, np.radians(NEAR)),
        "median": np.degrees(np.arctan(alpha)),
        "times": float(facets(alpha / 2.0).D(np.array([[0.0], [0.0], [1.0]]))[0]) / peak,
        "linear": 2.0,
        "inverse": 0.25,
        "cubed": 8.0,
        "left": LEFT,
        "right": RIGHT,
        "half_way": between(),
        "same_side": (LEFT + RIGHT) / 2.0,
        "apart": LEFT + RIGHT,
        "difference": LEFT - RIGHT,
    }


def facets(alpha):
    return Facets("ggx", np.array([alpha]), np.array([alpha]))


def ggx(alpha, cos):
    """The density in the form of the text."""
    return alpha**2 / (np.pi * (cos**2 * (alpha**2 - 1.0) + 1.0) ** 2)


def degrees(cos):
    return float(np.degrees(np.arccos(cos)))


def within(alpha, most):
    """Share of the surface whose facets are tilted by less than `most`; half of it at atan alpha."""
    assert np.isclose(added(alpha, np.arctan(alpha)), 0.5, rtol=1e-4)
    return added(alpha, most)


def added(alpha, most):
    theta = (np.arange(20_000) + 0.5) * (most / 20_000)
    m = np.stack((np.sin(theta), np.zeros_like(theta), np.cos(theta)))
    ring = facets(alpha).D(m) * m[2] * 2.0 * np.pi * m[0]
    return float(ring.sum() * most / 20_000)


def between():
    """How far the facet of the question is tilted."""
    left, right = np.radians((LEFT, RIGHT))
    wo = np.array([[-np.sin(left)], [0.0], [np.cos(left)]])
    wi = np.array([[np.sin(right)], [0.0], [np.cos(right)]])
    return degrees(mirrored(facets(1.0), wo, wi).m[2, 0])


def is_highlight(run, x, y):
    """Whether the light samples of a pixel's paths on the copper ball meet many facets on the mean."""
    scene, found = run.scene().at(run.settings()), []
    for path in run.pixel(x, y).paths:
        hit, light = (event.as_dict(scene) for event in path.events[1:3])
        if hit.get("shape") != "copper_ball" or light["kind"] != "light":
            return False
        found.append(light["D"])
    return bool(np.mean(found) > BRIGHT)
