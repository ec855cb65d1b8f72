"""What facets hide from one another, and the light that is missing as it meets a second one."""

import numpy as np

from tracer.bsdf.microfacet import Facets, mirrored, reflected

ASKED, STEEP = 0.5, 80.0  # roughness and angle of the question
SAMPLES = 20_000


def experiment(run):
    """Shares of facets and of light; angles in degrees."""
    hit, bounce = run.event("surface"), run.event("start")
    alpha = float(run.scene().definition.bsdfs["rough"].alpha_u[0])
    seen = facets(alpha).G1(np.array([[np.sqrt(1.0 - hit["cos_wo"] ** 2)], [0.0], [hit["cos_wo"]]]))[0]
    assert np.isclose(seen, bounce["G1"], rtol=1e-4)
    assert np.isclose(bounce["beta"][0], bounce["G2"] / bounce["G1"], rtol=1e-4)
    wrong = run.event("mistake")
    assert np.isclose(wrong["pdf"] * bounce["G1"], bounce["pdf"], rtol=1e-4)
    assert [k for k, path in enumerate(run.pixel(125, 36).paths) if not path.radiance.any()] == [5]

    hidden, without_alpha = smith(ASKED, STEEP), smith(1.0, STEEP)
    return balls(run) | {
        "angle": float(np.degrees(np.arccos(hit["cos_wo"]))),
        "alpha": alpha,
        "ratio": bounce["G2"] / bounce["G1"],
        "limit": 1.0 - np.log(2.0),
        "asked": ASKED,
        "steep": STEEP,
        "hidden": hidden,
        "g1": 1.0 / (1.0 + hidden),
        "no_half": 1.0 / (1.0 + 2.0 * hidden),
        "no_alpha": 1.0 / (1.0 + without_alpha),
        "grazing": furnace(alpha, STEEP)[0],
        "too_much": furnace(alpha, STEEP, hiding=False)[0],
    }


def facets(alpha):
    return Facets("ggx", np.array([alpha]), np.array([alpha]))


def smith(alpha, degrees):
    """Lambda of GGX in the form of the text."""
    return (np.sqrt(1.0 + (alpha * np.tan(np.radians(degrees))) ** 2) - 1.0) / 2.0


def balls(run):
    """What each rough ball sends back head on, and the roughest one by its closed form."""
    names = ("satin", "rough", "roughest")
    of = {name: float(run.scene().definition.bsdfs[name].alpha_u[0]) for name in names}
    found = {name: furnace(alpha, 0.0) for name, alpha in of.items()}
    assert of["roughest"] == 1.0
    assert abs(found["roughest"][0] - (1.0 - np.log(2.0))) < 5.0 * found["roughest"][1]
    return {name: mean for name, (mean, _) in found.items()} | {f"alpha_{name}": a for name, a in of.items()}


def furnace(alpha, degrees, hiding=True):
    """Mean share of light that is sent back with F = 1, and its standard error; hiding: whether
    G is in f."""
    f, theta = facets(alpha), np.radians(degrees)
    wo = np.repeat([[np.sin(theta)], [0.0], [np.cos(theta)]], SAMPLES, axis=1)
    wi = reflected(wo, f.visible(wo, np.random.default_rng(7).random((2, SAMPLES))))
    at = mirrored(f, wo, wi)
    weight = np.where(at.pdf > 0.0, at.f * wi[2] / np.where(at.pdf > 0.0, at.pdf, 1.0), 0.0)
    if not hiding:
        weight = np.where(at.pdf > 0.0, weight / f.G2(wo, wi), 0.0)
    return float(weight.mean()), float(weight.std() / np.sqrt(SAMPLES))
