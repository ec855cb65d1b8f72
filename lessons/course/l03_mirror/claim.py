"""The law of reflection on the paths of the corridor, and images that lie on the straight ray."""

import numpy as np

from tracer.bsdf.microfacet import reflected

APART, LAMP = 2.0, np.array([-0.35, 0.3, -0.2])  # metres between the mirrors; the lamp's centre, of the scene
FRONT, RADIUS = -1.0, 0.14  # where the front mirror stands along z, and the lamp's radius
MANY = 6  # reflections in the question about colour


def experiment(run):
    """Lengths in metres, shares of light."""
    path = run.path("start")
    for hit, bounce in zip(path.events[1::2], path.events[2:-1:2], strict=False):
        lawful(hit.values, bounce.values)
    way = sum(float(event.values["t"]) for event in path.events[1::2])
    seen = path.events[0].values["o"] + way * path.events[0].values["d"]
    image = np.array([*LAMP[:2], FRONT - behind(3)])
    assert np.isclose(np.linalg.norm(seen - image), RADIUS, atol=1e-4)
    wo, wi = run.event("before_mistake")["wo"], run.event("mistake")["wi"]
    assert np.allclose(wo, wi, atol=1e-6)

    red, green, _ = (float(share) for share in run.event("start")["f"])
    assert np.allclose(run.event("lamp")["beta"], np.power(run.event("start")["f"], 3), rtol=1e-5)
    return {
        "apart": APART,
        "near": behind(1),
        "second": behind(2),
        "third": behind(3),
        "from_eye": float(path.events[0].values["o"][2]) - FRONT + behind(3),
        "way": way,
        "left_of_third": red**3,
        "many": MANY,
        "red": red,
        "left": red**MANY,
        "green_left": green**MANY,
        "subtracted": 1.0 - MANY * (1.0 - red),
        "one_less": red ** (MANY - 1),
    }


def lawful(hit, bounce):
    """The new direction is the old one mirrored, of length 1, at the same angle."""
    n, wo, wi = hit["n"], hit["wo"], bounce["wi"]
    assert np.allclose(wi, reflected(wo[:, None], n[:, None])[:, 0], atol=1e-6)
    assert np.isclose(n @ wi, n @ wo, atol=1e-6) and np.isclose(wi @ wi, 1.0, atol=1e-6)


def behind(reflections):
    """How far behind the front mirror the lamp's image lies for a path that begins there."""
    near = LAMP[2] - FRONT
    return (reflections - 1) * APART + (near if reflections % 2 else APART - near)
