"""What changes when the two directions of a BSDF are exchanged, and when one is turned round."""

import numpy as np

import tracer
from lessons import zoo


def experiment(run):
    """f in red; densities per steradian; angles in degrees."""
    scene, hit, wo, wi = first_bounces(run)

    def ask(what, *directions):
        return what(hit.bsdf, *directions, hit.texture)

    f, f_exchanged = (ask(scene.bsdf.eval, *pair)[0] for pair in ((wo, wi), (wi, wo)))
    pdf, pdf_exchanged = (ask(scene.bsdf.pdf, *pair) for pair in ((wo, wi), (wi, wo)))
    assert np.allclose(f, f_exchanged, rtol=1e-4)
    assert not np.allclose(pdf, pdf_exchanged, rtol=0.1)
    turned = ask(scene.bsdf.eval, -wo, wi)[0]
    assert not turned.any()

    at, lane = run.event("start"), run.lesson.moments["start"].path
    cos_wo = wo[2, lane]
    assert np.isclose(at["pdf"], at["D"] * at["G1"] / (4.0 * cos_wo), rtol=1e-4)
    assert np.isclose(run.event("exchanged")["pdf"], pdf_exchanged[lane], rtol=1e-5)
    entering, leaving = (run.event(name)["cos"] for name in ("glass", "astray"))
    return {
        "f": f[lane],
        "f_exchanged": f_exchanged[lane],
        "f_turned": turned[lane],
        "pdf": pdf[lane],
        "pdf_exchanged": pdf_exchanged[lane],
        "ratio": pdf_exchanged[lane] / pdf[lane],
        "inverse": pdf[lane] / pdf_exchanged[lane],
        "cosines": cos_wo / at["cos"],
        "one": 1.0,
        "angle_wo": degrees(cos_wo),
        "angle_wi": degrees(at["cos"]),
        "angle_in": degrees(run.path("glass").events[1].values["cos_wo"]),
        "angle_right": degrees(entering),
        "angle_wrong": degrees(leaving),
    }


def first_bounces(run):
    """Scene, hits and the local directions wo and wi, both (3, N), of the first bounces in the pixel of the
    lesson."""
    found = []

    def note(scene, hit, wo, u):
        sample = zoo.RIGHT.bounce(scene, hit, wo, u)
        found.append((scene, hit, wo, sample.wi))
        return sample

    at, settings = run.lesson.moments["start"], run.settings()
    tracer.inspect(run.scene(), settings, at.x, at.y, steps=zoo.changed(bounce=note))
    return found[0]


def degrees(cos):
    return float(np.degrees(np.arccos(cos)))
