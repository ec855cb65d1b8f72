"""The vocabulary of materials: what each may say, in Mitsuba's words, and what it means."""

import numpy as np

from tracer.bsdf import (
    Conductor,
    Dielectric,
    Diffuse,
    Plastic,
    RoughConductor,
    RoughDielectric,
    RoughPlastic,
    ThinDielectric,
    TwoSided,
)
from tracer.bsdf.metals import METALS, index_of
from tracer.bsdf.microfacet import DISTRIBUTIONS
from tracer.scene_file.textures import TEXTURES, Sources, texture
from tracer.scene_file.words import LARGEST, MISSING, Words, colour, listed, one_of, real, shown, switch
from tracer.settings import TracerError

# Indices of refraction at 589 nm, between 0 and 20 degrees Celsius, by the names and values Mitsuba uses.
INDICES = {
    "vacuum": 1.0,
    "helium": 1.000036,
    "hydrogen": 1.000132,
    "air": 1.000277,
    "carbon dioxide": 1.00045,
    "water": 1.333,
    "acetone": 1.36,
    "ethanol": 1.361,
    "carbon tetrachloride": 1.461,
    "glycerol": 1.4729,
    "benzene": 1.501,
    "silicone oil": 1.52045,
    "bromine": 1.661,
    "water ice": 1.31,
    "fused quartz": 1.458,
    "pyrex": 1.470,
    "acrylic glass": 1.49,
    "polypropylene": 1.49,
    "bk7": 1.5046,
    "sodium chloride": 1.544,
    "amber": 1.55,
    "pet": 1.575,
    "diamond": 2.419,
}

# Roughness that is neither 0 nor within these would look like a mirror in float32, or like nothing known.
SMOOTHEST, ROUGHEST = 1e-4, 4.0
DEFAULT_ALPHA = 0.1
FRESNEL = ("exact", "schlick")


class _Table(Words):
    """The table of a material; the textures that stand for its parameters are collected."""

    def __init__(self, description, place, sources):
        super().__init__(description, place)
        self.sources, self.textures = sources, {}


def bsdf(description, place):
    """A material with one parameter column; a texture that stands for a parameter counts with its mean."""
    return textured(description, place, Sources())[0]


def textured(description, place, sources):
    """The material, and the textures that stand for its parameters, {parameter: texture}.

    The parameter of a material inside another is "NAME.PARAMETER".
    """
    table = _Table(description, place, sources)
    kind = table.take("type")
    if kind not in BSDFS:
        raise TracerError(f"{place}.type: {shown(kind)} is not a material; known: {listed(BSDFS)}")
    material = _two_sided(table) if kind == "twosided" else _READERS[kind](table)
    table.finish()
    return material, table.textures


def _diffuse(table):
    return Diffuse(_factor(table, "reflectance", 0.5))


def _conductor(table):
    return Conductor(*_metal(table), one_of(table, "fresnel", FRESNEL))


def _rough_conductor(table):
    alphas, distribution = _roughness(table)
    metal, formula = _metal(table), one_of(table, "fresnel", FRESNEL)
    if alphas is None:
        return Conductor(*metal, formula)
    alpha_u, alpha_v = alphas
    return RoughConductor(alpha_u, alpha_v, *metal, distribution, formula)


def _metal(table) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """eta, k and specular_reflectance, (3, 1) each; a perfect mirror has k = inf."""
    material = table.take("material", None)
    factor = _factor(table, "specular_reflectance", 1.0)
    if material == "none" or (material is None and "eta" not in table.table and "k" not in table.table):
        return np.ones((3, 1)), np.full((3, 1), np.inf), factor
    if material is None:
        eta, k = _column(table, "eta", MISSING), _column(table, "k", MISSING)
        if (eta + k == 0.0).any():
            raise TracerError(f"{table.place}.eta: an index of 0 + 0i is that of no metal")
        return eta, k, factor
    if not isinstance(material, str) or material not in METALS:
        known = f'{listed(METALS)}, "none" (a mirror), or give eta and k'
        raise TracerError(f"{table.place}.material: {shown(material)} is not known; known: {known}")
    eta, k = index_of(material)
    return eta[:, None], k[:, None], factor


def _dielectric(table):
    return Dielectric(_eta(table, "bk7"), *_factors(table), one_of(table, "fresnel", FRESNEL))


def _thin_dielectric(table):
    return ThinDielectric(_eta(table, "bk7"), *_factors(table), one_of(table, "fresnel", FRESNEL))


def _rough_dielectric(table):
    alphas, distribution = _roughness(table)
    eta, factors, formula = _eta(table, "bk7"), _factors(table), one_of(table, "fresnel", FRESNEL)
    if alphas is None or eta[0] == 1.0:  # of equal indices every facet lets everything straight through
        return Dielectric(eta, *factors, formula)
    alpha_u, alpha_v = alphas
    return RoughDielectric(alpha_u, alpha_v, eta, *factors, distribution, formula)


def _plastic(table):
    return Plastic.coated(_eta(table, "polypropylene"), *_coat(table))


def _rough_plastic(table):
    alphas, distribution = _roughness(table, anisotropic=False)
    eta = _eta(table, "polypropylene")
    diffuse, specular, nonlinear, formula = _coat(table)
    if alphas is None:
        return Plastic.coated(eta, diffuse, specular, nonlinear, formula)
    return RoughPlastic.coated(alphas[0], eta, diffuse, specular, nonlinear, distribution, formula)


def _coat(table):
    """diffuse_reflectance, specular_reflectance, nonlinear, fresnel."""
    diffuse = _factor(table, "diffuse_reflectance", 0.5)
    specular = _factor(table, "specular_reflectance", 1.0)
    nonlinear = switch(table, "nonlinear", False)
    return diffuse, specular, nonlinear, one_of(table, "fresnel", FRESNEL)


def _two_sided(table):
    """The one material written inside, or referred to, under any name."""
    inside = [word for word, value in table.table.items() if isinstance(value, dict)]
    if len(inside) != 1:
        raise TracerError(f"{table.place}: twosided needs one material inside; here are {len(inside)}")
    description, place = table.take(inside[0]), f"{table.place}.{inside[0]}"
    if description.get("type") == "ref":
        reference = Words(description, place)
        name = reference.take("id")
        reference.take("type")
        reference.finish()
        known = table.sources.bsdfs
        if not isinstance(name, str) or name not in known:
            raise TracerError(f"{place}: no material {shown(name)} in this scene; there are {listed(known)}")
        description = known[name]
    if isinstance(description, dict) and description.get("type") == "twosided":
        raise TracerError(f"{place}.type: 'twosided' inside twosided is not supported")
    material, textures = textured(description, place, table.sources)
    table.textures |= {f"bsdf.{parameter}": texture for parameter, texture in textures.items()}
    if not material.one_sided:
        raise TracerError(f"{place}.type: {description['type']!r} lets light through, so it has two sides")
    return TwoSided(material)


def _roughness(table, anisotropic=True):
    """((alpha_u, alpha_v), distribution), (1,) each; None for the alphas of a perfectly smooth surface."""
    distribution = one_of(table, "distribution", DISTRIBUTIONS, "beckmann")
    if table.take("sample_visible", True) is not True:
        raise TracerError(f"{table.place}.sample_visible: only true is supported")
    words = ["alpha"]
    if anisotropic and ("alpha_u" in table.table or "alpha_v" in table.table):
        if "alpha" in table.table:
            raise TracerError(
                f"{table.place}.alpha: is given beside alpha_u or alpha_v; give one or the other"
            )
        words = ["alpha_u", "alpha_v"]
    alphas = [_alpha(table, word) for word in words]
    if not any(alphas):
        return None, distribution
    if not all(alphas):
        raise TracerError(
            f"{table.place}.alpha_u: only one of alpha_u and alpha_v is 0; give both or neither"
        )
    return (np.array([alphas[0]]), np.array([alphas[-1]])), distribution


def _alpha(table, word):
    place = f"{table.place}.{word}"
    alpha = real(table.take(word, DEFAULT_ALPHA), place)
    if alpha != 0.0 and not SMOOTHEST <= alpha <= ROUGHEST:
        limits = f"from {SMOOTHEST:g} to {ROUGHEST:g}, or 0 for a perfectly smooth surface"
        raise TracerError(f"{place}: {alpha:g} is out of range; it has to be {limits}")
    return alpha


def _factors(table) -> tuple[np.ndarray, np.ndarray]:
    """specular_reflectance and specular_transmittance, (3, 1) each."""
    return (
        _factor(table, "specular_reflectance", 1.0),
        _factor(table, "specular_transmittance", 1.0),
    )


def _factor(table, word, default):
    """Share of light by colour, (3, 1); of a texture its mean, and the texture is kept in the table."""
    value, place = table.take(word, default), f"{table.place}.{word}"
    if not table.sources.is_texture(value):
        return colour(value, place, 1.0, TEXTURES)[:, None]
    table.textures[word] = texture(value, place, table.sources)
    return table.textures[word].mean()[:, None]


def _column(table, word, default):
    return colour(table.take(word, default), f"{table.place}.{word}", LARGEST)[:, None]


def _eta(table, default):
    """int_ior over ext_ior, (1,)."""
    return np.array([_index(table, "int_ior", default) / _index(table, "ext_ior", "air")])


def _index(table, word, default):
    value, place = table.take(word, default), f"{table.place}.{word}"
    if isinstance(value, str):
        if value not in INDICES:
            raise TracerError(
                f"{place}: {shown(value)} is not known; give a number or one of {listed(INDICES)}"
            )
        return INDICES[value]
    if real(value, place) <= 0.0:
        raise TracerError(f"{place}: {value:g} is no index of refraction; it has to be above 0")
    return float(value)


_READERS = {
    "diffuse": _diffuse,
    "conductor": _conductor,
    "dielectric": _dielectric,
    "thindielectric": _thin_dielectric,
    "roughconductor": _rough_conductor,
    "roughdielectric": _rough_dielectric,
    "plastic": _plastic,
    "roughplastic": _rough_plastic,
}
BSDFS = (*_READERS, "twosided")
