"""Reflectances of smooth boundaries, and what follows from them."""

import numpy as np

from tracer import material_bench
from tracer.bsdf import Conductor, Dielectric, ThinDielectric, fresnel
from tracer.bsdf.sample import Sample
from tracer.integrator.steps import throughput
from values.registry import kernel

LOADED = "made in float64 when a scene is loaded, whatever its precision"


def ones(to):
    return np.ones((3, 1), to.dtype)


def cosine(given, to):
    """Cosine of the angle of incidence, (1,)."""
    return to([given["cos_i"] if "cos_i" in given else np.cos(np.radians(given["theta_deg"]))])


def of_polarisation(key, rs, rp):
    return {"Rs": rs, "Rp": rp, "R": 0.5 * (rs + rp)}[key.rpartition(".")[2]].ravel()[0]


@kernel("fresnel.diel.")
def dielectric(key, given, to):
    rs, rp, _ = fresnel.dielectric(cosine(given, to), to([given["n2"] / given["n1"]]))
    return of_polarisation(key, rs, rp)


@kernel("fresnel.R0.")
def head_on(key, given, to):
    return fresnel.dielectric_mean(to([1.0]), to([given["n"]]))[0][0]


@kernel("fresnel.cond.")
def conductor(key, given, to):
    eta, k = (to([[given[name]]]) for name in ("eta", "k"))
    if not key.endswith(".avg"):
        return of_polarisation(key, *fresnel.conductor(cosine(given, to), eta, k))
    x, weight = np.polynomial.legendre.leggauss(400)  # over the hemisphere, 2 integral of R mu dmu
    mu, weight = 0.5 * x + 0.5, 0.5 * weight
    return (2.0 * weight * mu * fresnel.conductor_mean(to(mu), eta, k)[0]).sum()


@kernel("fresnel.diffuse_avg.", only=64, why=LOADED)
def diffuse_average(key, given, to):
    n = to([given["n"]])
    return fresnel.diffuse_average(1.0 / n if ".internal." in key else n)[0]


@kernel("brewster.deg.", only=64, why="an angle that is shown, not traced with")
def brewster(key, given, to):
    _, marks = material_bench.fresnel_curves(Dielectric(to([given["n"]]), ones(to), ones(to)))
    return marks["brewster"]


@kernel("brewster.Rs.")
def brewster_rs(key, given, to):
    n = given["n"]
    return fresnel.dielectric(to([1.0 / np.sqrt(1.0 + n * n)]), to([n]))[0][0]


@kernel("critical.")
def critical(key, given, to):
    n = given["n"]
    cos = np.sqrt((n - 1.0) * (n + 1.0)) / n + given["delta"]
    return 1.0 - fresnel.dielectric_mean(to([cos]), to([1.0 / n]))[0][0]


@kernel("schlick.n=")
def schlick(key, given, to):
    return fresnel.dielectric_mean(cosine(given, to), to([given["n"]]), "schlick")[0][0]


@kernel("schlick.avgerr.", only=64, why=LOADED)
def schlick_on_average(key, given, to):
    n = to([given["n"]])
    return (fresnel.diffuse_average(n, "schlick") - fresnel.diffuse_average(n))[0]


@kernel("schlick.maxerr.")
def schlick_at_most(key, given, to):
    cos, n = to([given["cos_at"]]), to([given["n"]])
    return (fresnel.dielectric_mean(cos, n, "schlick")[0] - fresnel.dielectric_mean(cos, n)[0])[0]


@kernel("slab.R.scalar.", "slab.T.scalar.", but=("terms",))
def pane(key, given, to):
    glass = ThinDielectric(to([given["n"]]), ones(to), ones(to))
    share = glass.reflectance_at(cosine(given, to))[0]
    return share if ".R." in key else 1.0 - share


@kernel("slab.T.polarised.")
def polarised(key, given, to):
    """From Rs and Rp, which castray shows apart; what it renders is slab.T.scalar."""
    rs, rp, _ = fresnel.dielectric(cosine(given, to), to([given["n"]]))
    return 0.5 * ((1.0 - rs) / (1.0 + rs) + (1.0 - rp) / (1.0 + rp))[0]


@kernel("mirror.conductor.")
def between_mirrors(key, given, to):
    """The throughput of a path that goes to and fro."""
    metal = Conductor(to([[given["eta"]]] * 3), to([[given["k"]]] * 3), ones(to))
    wo, beta = to([[0], [0], [1]]), ones(to)
    for _ in range(given["bounces"]):
        sample: Sample = metal.sample(wo, np.zeros((3, 1)))
        beta = throughput(beta, sample, np.abs(sample.wi[2]))
    return beta[0, 0]
