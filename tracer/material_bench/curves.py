"""What a material looks like as curves: its lobes around one direction, and Fresnel's at its boundary."""

import numpy as np

from tracer.bsdf import fresnel
from tracer.events import LOBES
from tracer.material_bench.energy import towards


def lobes(material, degrees, n=721):
    """f |cos| (3, n) in the plane of incidence, and the angles (n,) in degrees from the normal, -180 to 180:
    positive on the far side, where a mirror would reflect to."""
    angles = np.linspace(-180.0, 180.0, n)
    wi = np.concatenate([towards(a, 1, 0.7 + np.pi) for a in angles], axis=1)
    wo = towards(degrees, n)
    return angles, material.eval(wo, wi) * np.abs(wi[2])


def dirac_lobes(material, degrees):
    """The Dirac lobes of wo: [(lobe, angle in degrees as in lobes, fraction (3,)), ...]."""
    wo, found = towards(degrees, 64), {}
    u = np.full((3, 64), 0.5)
    u[0] = (np.arange(64) + 0.5) / 64
    sample = material.sample(wo, u)
    for k in np.flatnonzero(sample.delta & (sample.pdf > 0.0)):
        across = -(sample.wi[0, k] * np.cos(0.7) + sample.wi[1, k] * np.sin(0.7))
        angle = np.degrees(np.arctan2(across, sample.wi[2, k]))
        found.setdefault(LOBES[sample.lobe[k]], (float(angle), sample.f[:, k].copy()))
    return [(lobe, *what) for lobe, what in found.items()]


def fresnel_curves(material, n=901):
    """{name: (n,)} of cos, Rs, Rp, exact mean and Schlick's, seen from outside, and the angles in degrees
    {brewster, critical}; None for a material without an index. Of a conductor: the green channel."""
    cos = np.cos(np.radians(np.linspace(0.0, 90.0, n)))
    inside = material.bsdf if hasattr(material, "bsdf") else material
    if not hasattr(inside, "eta"):
        return None
    marks = {}
    if hasattr(inside, "k"):
        eta, k = inside.eta[1:2], inside.k[1:2]
        if np.isinf(k).any():
            return None
        rs, rp = (r[0] for r in fresnel.conductor(cos, eta, k))
        schlick = fresnel.conductor_mean(cos, eta, k, "schlick")[0]
    else:
        eta = np.full(n, float(inside.eta[0]))
        rs, rp, _ = fresnel.dielectric(cos, eta)
        schlick, _ = fresnel.dielectric_mean(cos, eta, "schlick")
        marks["brewster"] = float(np.degrees(np.arctan(eta[0])))
        if eta[0] != 1.0:
            marks["critical"] = float(np.degrees(np.arcsin(min(eta[0], 1.0 / eta[0]))))
    return {"cos": cos, "Rs": rs, "Rp": rp, "exact": 0.5 * (rs + rp), "schlick": schlick}, marks
