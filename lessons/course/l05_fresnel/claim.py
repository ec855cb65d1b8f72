"""Fresnel's reflectances: at Brewster's angle, of metals, by Schlick's formula, under varnish."""

import numpy as np

from tracer.bsdf import fresnel
from tracer.bsdf.metals import index_of

WATER, DIAMOND = 1.333, 2.417  # indices of the questions
STEEP = 85.0  # degrees at which the varnish is added up
TIMES = 3.0  # how much more than head on the edge has to reflect
COS = np.cos(np.radians(np.linspace(0.0, 90.0, 9001)))
BLUE = 2


def experiment(run):
    """Reflectances as shares, angles in degrees."""
    varnish = run.scene().definition.bsdfs["varnish"]
    coat = float(varnish.eta[0])
    head_on = float(fresnel.head_on(coat, 0.0))
    assert np.isclose(run.event("start")["F"][0], head_on, rtol=2e-2)
    angle = np.degrees(np.arctan(WATER))
    s, p, _ = fresnel.dielectric(np.cos(np.radians(angle)), WATER)
    assert p < 1e-12 < s
    diamond = float(fresnel.head_on(DIAMOND, 0.0))
    assert round(head_on, 2) == 0.04 and diamond > 4.0 * fresnel.head_on(
        1.5, 0.0
    )  # as the text has it in words
    return (
        {"coat": coat, "head_on": head_on, "rim_angle": degrees(run.event("rim_hit")["cos_wo"])}
        | {"water": WATER, "brewster": angle, "from_surface": 90.0 - angle, "s_there": float(s)}
        | {"critical": np.degrees(np.arcsin(1.0 / WATER)), "diagonal": 45.0}
        | {"diamond_index": DIAMOND, "diamond": diamond, "not_squared": np.sqrt(diamond)}
        | {"passed": 1.0 - diamond, "times": TIMES}
        | schlick(coat)
        | aluminium()
        | added_up(varnish)
    )


def degrees(cos):
    return float(np.degrees(np.arccos(cos)))


def schlick(eta):
    """How far Schlick's formula is off for a coat of index eta, and where."""
    exact, near = (
        fresnel.dielectric_mean(COS, np.full(COS.size, eta), how)[0] for how in ("exact", "schlick")
    )
    worst = int(np.abs(near - exact).argmax())
    assert near[worst] > exact[worst]
    return {"off": near[worst] - exact[worst], "off_at": degrees(COS[worst]), "exact_there": exact[worst]}


def aluminium():
    """Red light on aluminium: head on, where it is least, and Schlick's largest error."""
    eta, k = (part[:1, None] for part in index_of("Al"))
    exact, near = (fresnel.conductor_mean(COS, eta, k, how)[0] for how in ("exact", "schlick"))
    least = int(exact.argmin())
    assert exact[least] < exact[0] < near[least]
    return {
        "aluminium": exact[0],
        "aluminium_k": float(k[0, 0]),
        "least": exact[least],
        "least_at": degrees(COS[least]),
        "aluminium_off": np.abs(near - exact).max(),
    }


def added_up(varnish):
    """What the varnish sends back in blue at a steep angle: as it should, and with both parts in full."""
    wo = np.array([[np.sin(np.radians(STEEP))], [0.0], [np.cos(np.radians(STEEP))]])
    up = np.array([[0.0], [0.0], [1.0]])
    mirror, through = float(varnish.reflectance_at(wo[2])[0]), 1.0 - varnish.reflectance_at(up[2])[0]
    base = np.pi * float(varnish.eval(wo, up)[BLUE, 0]) / ((1.0 - mirror) * through)
    right = mirror + (1.0 - mirror) * float(varnish.diffuse_reflectance[BLUE, 0])
    assert right < 1.0 < mirror + base
    return {"steep": STEEP, "mirror": mirror, "base": base, "together": mirror + base, "right_sum": right}


def at_the_edge(run, x, y):
    """Whether each path of a pixel meets the varnish where it reflects much more than head on."""
    scene, least = run.scene().at(run.settings()), TIMES * run.values["head_on"]
    for path in run.pixel(x, y).paths:
        hit, bounce = (first(path, kind).as_dict(scene) for kind in ("hit", "bounce"))
        if hit["shape"] != "varnish_ball" or bounce["F"][BLUE] < least:
            return False
    return True


def first(path, kind):
    """The first event of a kind."""
    return next(event for event in path.events if event.kind.name == kind)
