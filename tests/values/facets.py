"""Rough surfaces: values at a point, integrals of their normals, and how much light they send on."""

import numpy as np
from rough import direction, facets, numbers

from tracer.bsdf import RoughDielectric, fresnel
from tracer.bsdf.microfacet import Facets, mirrored, reflected, unit
from tracer.events import LOBES
from values.registry import DTYPES, estimator, kernel


@kernel("point.ggx.", "point.beckmann.")
def at_a_point(key, given, to):
    f = Facets(given["kind"], to([given["alpha_x"]]), to([given["alpha_y"]]))
    wi, wo = (to(np.array(given[w]) / np.linalg.norm(given[w]))[:, None] for w in ("wi", "wo"))
    at = mirrored(f, wi, wo)
    quantities = {
        "D": lambda: f.D(at.m),
        "Lambda_i": lambda: f.hidden(wi) / wi[2],
        "G2": lambda: f.G2(wi, wo),
        "f": lambda: at.f,
        "pdf_vndf": lambda: at.pdf,
    }
    return quantities[key.rpartition(".")[2]]()[0]


def hemisphere(n_phi=256, n_z=160):
    """Nodes (3, K) and weights (K,) of an integral over the upper hemisphere."""
    z, w = np.polynomial.legendre.leggauss(n_z)
    z, w = 0.5 * z + 0.5, 0.5 * w
    phi = (np.arange(n_phi) + 0.5) * (2 * np.pi / n_phi)
    phi, z = (grid.ravel() for grid in np.meshgrid(phi, z, indexing="ij"))
    r = np.sqrt(1 - z * z)
    return np.stack((r * np.cos(phi), r * np.sin(phi), z)), np.tile(w, n_phi) * (2 * np.pi / n_phi)


def unstretched(m, f):
    """Directions of a surface of roughness 1 as normals of f, and the solid angle before over after."""
    normals = unit(np.stack((f.alpha_u * m[0], f.alpha_v * m[1], m[2])))
    return normals, f.alpha_u * f.alpha_v * (normals[2] / m[2]) ** 3


def projected(f):
    """The integral of D cos, over the hemisphere stretched to roughness 1."""
    m, weight = hemisphere(64, 160)
    normals, change = unstretched(m, f)
    normals = normals.astype(f.alpha_u.dtype)
    return (f.D(normals) * normals[2] * change * weight).sum()


@kernel("norm.D.")
def area_of_the_normals(key, given, to):
    return projected(Facets("ggx", to([given["alpha"]]), to([given["alpha"]])))


@kernel("vndf.cdf.normal.")
def share_within_an_angle(key, given, to):
    """The density of visible normals, integrated up to theta."""
    f = Facets("ggx", to([given["alpha"]]), to([given["alpha"]]))
    x, weight = np.polynomial.legendre.leggauss(200)
    theta, weight = given["theta"] * (0.5 * x + 0.5), given["theta"] * 0.5 * weight
    m = to(np.stack((np.sin(theta), 0 * theta, np.cos(theta))))
    w = np.repeat(to([[0.0], [0.0], [1.0]]), 200, axis=1)
    return (f.visible_pdf(w, m) * 2 * np.pi * np.sin(theta) * weight).sum()


@estimator("vndf.moment.", n=400_000)
def moments(key, given, bits, seed, n):
    f = facets("ggx", given["alpha"], given["alpha"], DTYPES[bits])
    w = direction(given["mu"], n, DTYPES[bits], phi=0.0)
    m = f.visible(w, numbers(seed, n, DTYPES[bits])).astype(np.float64)
    return {"mx": m[0], "mz": m[2], "mx2": m[0] ** 2}[given["moment"]]


def weights(f, mu, seed, n, phi=0.0, F=None, separable=False, dtype=np.float64):
    """Weights f cos / pdf (n,) of reflection at the facets. F: their reflectance, 1 if None."""
    wo = direction(mu, n, dtype, phi)
    wi = reflected(wo, f.visible(wo, numbers(seed, n, dtype)))
    at = mirrored(f, wo, wi)
    weight = at.f * wi[2] / np.where(at.pdf > 0, at.pdf, 1)
    if separable:
        weight = weight * f.G1(wo) * f.G1(wi) / np.where(weight > 0, f.G2(wo, wi), 1)
    return weight if F is None else weight * F(at.cos)


def reflectance(name, dtype):
    """The facets' reflectance in keys like albedo.ggx.NAME.*: a function of the cosine."""
    if name.startswith("schlick"):
        return lambda cos: fresnel.schlick(cos, dtype(name.removeprefix("schlick")))
    if name.startswith("diel"):
        eta = np.array([name.removeprefix("diel")], dtype)
        return lambda cos: fresnel.dielectric_mean(cos, eta)[0]
    if name == "gold_like_650":
        eta, k = np.full((1, 1), 0.166, dtype), np.full((1, 1), 3.15, dtype)
        return lambda cos: fresnel.conductor_mean(cos, eta, k)[0]
    return None


@estimator("albedo.", n=100_000)
def albedo(key, given, bits, seed, n, **options):
    dtype, alpha = DTYPES[bits], given.get("alpha")
    alphas = (given["alpha_x"], given["alpha_y"]) if "alpha_x" in given else (alpha, alpha)
    options.setdefault("separable", ".separable." in key)
    return weights(
        facets(given.get("kind", "ggx"), *alphas, dtype),
        given["mu"],
        seed,
        n,
        phi=np.radians(given.get("phi_deg", 0.0)),
        F=reflectance(key.split(".alpha=")[0].split(".", 2)[2], dtype),
        dtype=dtype,
        **options,
    )


def glass(alpha, eta=1.5, kind="ggx", dtype=np.float64):
    """Clear rough glass."""
    ones = np.ones((3, 1))
    return RoughDielectric(np.array([alpha]), np.array([alpha]), np.array([eta]), ones, ones, kind).astype(
        dtype
    )


def three(seed, n, dtype=np.float64):
    """(3, n) numbers as the sampler gives them."""
    return np.stack((*numbers(seed, n, dtype), numbers(seed + 1, n, dtype)[0]))


def parts(material, wo, u):
    """Energy reflected and transmitted by each sample, two (N,)."""
    s = material.sample(wo, u)
    weight = (s.f[0] * np.abs(s.wi[2]) / np.where(s.pdf > 0, s.pdf, 1)).astype(np.float64)
    passed = s.lobe == LOBES.index("transmission")
    return np.where(passed, 0, weight), np.where(passed, weight, 0) * material.relative_eta(wo[2]) ** 2


@estimator("roughdiel.", but=("etendue",), n=100_000)
def through_rough_glass(key, given, bits, seed, n, eta=None):
    dtype = DTYPES[bits]
    wo = direction(given["mu"], n, dtype) * (-1 if "glass->air" in given["side"] else 1)
    material = glass(given["alpha"], eta or given["n"], dtype=dtype)
    reflected, passed = parts(material, wo.astype(dtype), three(seed, n, dtype))
    return {"R": reflected, "T": passed, "sum": reflected + passed}[key.split(".")[1]]


@estimator("roughdiel.etendue.", n=400_000)
def etendue(key, given, bits, seed, n):
    """T averaged over the hemisphere: from air as it is, and n^2 times from glass; half of n each."""
    dtype, rng, found = DTYPES[bits], np.random.default_rng(seed), []
    for side, scale in ((1, 1.0), (-1, given["n"] ** 2)):
        mu, phi = np.sqrt(rng.random(n // 2)), 2 * np.pi * rng.random(n // 2)
        r = np.sqrt(1 - mu * mu)
        wo = np.stack((r * np.cos(phi), r * np.sin(phi), side * mu)).astype(dtype)
        material = glass(given["alpha"], given["n"], dtype=dtype)
        found.append(scale * parts(material, wo, three(seed + side, n // 2, dtype))[1])
    return np.concatenate(found)
