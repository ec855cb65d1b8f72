"""Four properties of a BRDF, on the materials of the scene and on three that each lack one."""

from dataclasses import dataclass

import numpy as np

import tracer
from tracer.bsdf import fresnel
from tracer.bsdf.diffuse import Diffuse
from tracer.frame import Frame, dot
from tracer.material_bench import albedo, physical
from tracer.scene_file.change import changed
from tracer.warp import INV_2PI, reflect

ANGLES = (0.0, 60.0, 85.0)  # degrees from the normal
DIFFUSE, GLOSSY, EXPONENT = 0.8, 0.5, 20  # shares of a surface that sends on more than it gets
COAT, TILT = 1.5, 80.0  # index of a varnish, and the angle of the question


@dataclass(frozen=True)
class TwoShares(Diffuse):
    """A diffuse share and a glossy one of a whole lobe (Phong's), together above 1."""

    def eval(self, wo, wi):
        lobe = np.maximum(dot(reflect(wo), wi), 0.0) ** EXPONENT
        above = (wo[2] > 0.0) & (wi[2] > 0.0)
        return super().eval(wo, wi) + GLOSSY * (EXPONENT + 2) * INV_2PI * lobe * above


@dataclass(frozen=True)
class HalfCoated(Diffuse):
    """What the coat reflects is taken off on the way out only."""

    def eval(self, wo, wi):
        through = 1.0 - fresnel.dielectric_mean(np.abs(wo[2]), np.full(wo.shape[1], COAT))[0]
        return super().eval(wo, wi) * through


@dataclass(frozen=True)
class Unclamped(Diffuse):
    """A highlight as a plain cosine of the mirror direction, whatever its sign."""

    def eval(self, wo, wi):
        above = (wo[2] > 0.0) & (wi[2] > 0.0)
        return 0.3 * super().eval(wo, wi) + 0.1 * dot(reflect(wo), wi) * above


def experiment(run):
    """f there and back, light doubled, and shares of the light sent on."""
    e, h = run.event("start"), run.path("start").events[1].values
    frame = Frame.around(h["n"][:, None].astype(float))
    wo, wi = frame.to_local(h["wo"][:, None]), frame.to_local(np.array(e["wi"])[:, None])
    satin = run.scene().definition.bsdfs["satin"]
    there, back = satin.eval(wo, wi)[0, 0], satin.eval(wi, wo)[0, 0]
    assert np.isclose(there, back, rtol=1e-9) and np.isclose(there, e["f"][0], rtol=1e-4)

    at = run.lesson.moments["start"]
    brighter = changed(run.scene(), {"lamp.emitter.radiance": 18})
    twice = tracer.inspect(brighter, run.settings(), at.x, at.y, sample=at.path).paths[0].events[at.event]
    assert np.array_equal(twice.values["contribution"], 2.0 * np.float32(e["contribution"]))

    assert lacks(satin) == ()
    assert lacks(one(TwoShares, DIFFUSE)) == ("energy conserving",)
    assert lacks(one(HalfCoated, DIFFUSE)) == ("reciprocal",)
    assert lacks(one(Unclamped, DIFFUSE)) == ("non-negative",)

    coat = float(fresnel.dielectric_mean(np.cos(np.radians([TILT])), np.full(1, COAT))[0][0])
    right, wrong = (run.event(m)["f"][2] for m in ("edge", "mistake"))
    return {
        **shares("satin", satin),
        **shares("sum", one(TwoShares, DIFFUSE)),
        "there": there,
        "back": back,
        "doubled": float(twice.values["contribution"][0]),
        "kd": DIFFUSE,
        "ks": GLOSSY,
        "tilt": TILT,
        "coat": coat,
        "together": DIFFUSE + coat,
        "rest": DIFFUSE * (1.0 - coat) + coat,
        "times": wrong / right,
    }


def one(kind, reflectance):
    """A material of one column, grey."""
    return kind(np.full((3, 1), reflectance))


def lacks(material):
    """Which of the four properties do not hold."""
    return tuple(p.name for p in physical(material, n=4000) if not p.holds)


def shares(name, material):
    """Share of the light that is sent on, red, by the angle of wo."""
    reflected, transmitted, _ = albedo(material, ANGLES, n=4000)
    return {
        f"{name}_{angle:.0f}": share
        for angle, share in zip(ANGLES, (reflected + transmitted)[0], strict=True)
    }
