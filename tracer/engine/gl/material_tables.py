"""Materials, textures and media as tables that a shader reads; see tables."""

import numpy as np

from tracer.bsdf.roughplastic import NODES
from tracer.engine.gl.rows import rows
from tracer.texture.bitmap import FILTERS, WRAPS, Bitmap

ROUGH = ("RoughConductor", "RoughDielectric", "RoughPlastic")
KINDS = ("Diffuse", "Conductor", "Dielectric", "ThinDielectric", "Plastic", *ROUGH)
_ONE_SIDED, _BLACK, _DELTA, _TWO_SIDED, _ANISOTROPIC = 1, 2, 4, 8, 16


def materials(scene):
    """Parameters of each material; what they mean, the file of its kind in glsl/bsdf/ says."""
    table = rows(len(scene.bsdf_names), ("number",), ("a", "b", "c"), ("painted",))
    table["painted"] = -1
    for number, (name, parameter, _) in enumerate(_painted(scene)):
        inner = getattr(scene.definition.bsdfs[name], "bsdf", scene.definition.bsdfs[name])
        place = _COLOURS[type(inner).__name__][parameter.rpartition(".")[2]]
        table["painted"][scene.bsdf_names.index(name), "abc".index(place)] = number
    for row, outer in zip(table, scene.definition.bsdfs.values(), strict=True):
        inner = getattr(outer, "bsdf", outer)
        flags = _ONE_SIDED * outer.one_sided | _DELTA * outer.delta | _TWO_SIDED * (inner is not outer)
        flags |= _ANISOTROPIC * bool(outer.anisotropic) | _BLACK * (not np.any(outer.albedo() > 0.0))
        kind = type(inner).__name__
        row["number"][:3] = KINDS.index(kind), flags, getattr(inner, "fresnel", "exact") == "schlick"
        row["number"][3] = getattr(inner, "distribution", "ggx") == "beckmann"
        _PARAMETERS[kind](row, inner)
    for k in np.flatnonzero(table["number"][:, 0] == KINDS.index("RoughPlastic")):
        table["c"][k, 3] = NODES * k
    return table


def _painted(scene):
    """(name of the material, parameter, texture) of each texture in use."""
    for name, of in scene.definition.textures.items():
        for parameter, texture in of.items():
            yield name, parameter, texture


def textures(scene):
    """The Textures, and the texels of all of them, (T, 4)."""
    found = [texture for _, _, texture in _painted(scene)]
    table, texels, begin = rows(len(found), ("number",), ("u", "v")), [np.zeros((0, 4), np.float32)], 0
    for row, texture in zip(table, found, strict=True):
        row["u"][:3], row["v"][:3] = texture.to_uv
        row["u"][3] = begin
        if isinstance(texture, Bitmap):
            _, height, width = texture.texels.shape
            row["number"] = (
                width, height, FILTERS.index(texture.filter_type), WRAPS.index(texture.wrap_mode)
            )  # fmt: skip
            colours = texture.texels.reshape(3, -1).T
        else:
            colours = np.stack((texture.color0, texture.color1))
        texels.append(np.column_stack((colours, np.zeros(len(colours)))).astype(np.float32))
        begin += len(colours)
    return table, np.concatenate(texels)


def media(scene):
    """What media take per metre, (M, 4)."""
    sigma_t = scene.media.sigma_t.T
    return np.column_stack((sigma_t, np.zeros(len(sigma_t)))).astype(np.float32)


def through(scene):
    """What the coat of each rough plastic lets through, (materials * NODES,)."""
    found = np.zeros((len(scene.bsdf_names), NODES), np.float32)
    for row, outer in zip(found, scene.definition.bsdfs.values(), strict=True):
        inner = getattr(outer, "bsdf", outer)
        if type(inner).__name__ == "RoughPlastic":
            row[:] = inner.through[:, 0]
    return found


def _diffuse(row, m):
    row["a"][:3] = m.reflectance[:, 0]


def _conductor(row, m):
    perfect = np.isinf(m.k[:, 0])
    row["a"][:3], row["b"][:3] = np.where(perfect, 1.0, m.eta[:, 0]), np.where(perfect, -1.0, m.k[:, 0])
    row["c"][:3] = m.specular_reflectance[:, 0]


def _dielectric(row, m):
    row["a"] = *m.specular_reflectance[:, 0], m.eta[0]
    row["b"][:3] = m.specular_transmittance[:, 0]


def _plastic(row, m):
    row["a"] = *m.diffuse_reflectance[:, 0], m.eta[0]
    row["b"] = *m.specular_reflectance[:, 0], m.inside[0]
    row["c"][0] = m.nonlinear


def _roughconductor(row, m):
    _conductor(row, m)
    row["a"][3], row["b"][3] = m.alpha_u[0], m.alpha_v[0]


def _roughdielectric(row, m):
    _dielectric(row, m)
    row["c"][:2] = m.alpha_u[0], m.alpha_v[0]


def _roughplastic(row, m):
    _plastic(row, m)
    row["c"][:3] = m.alpha[0], m.out[0], m.nonlinear


_METAL, _GLASS = {"specular_reflectance": "c"}, {"specular_reflectance": "a", "specular_transmittance": "b"}


_COAT = {"diffuse_reflectance": "a", "specular_reflectance": "b"}


_COLOURS = {  # which of a, b and c hold a colour that may be a texture
    "Diffuse": {"reflectance": "a"},
    "Conductor": _METAL,
    "Dielectric": _GLASS,
    "ThinDielectric": _GLASS,
    "Plastic": _COAT,
    "RoughConductor": _METAL,
    "RoughDielectric": _GLASS,
    "RoughPlastic": _COAT,
}


_PARAMETERS = {
    "Diffuse": _diffuse,
    "Conductor": _conductor,
    "Dielectric": _dielectric,
    "ThinDielectric": _dielectric,
    "Plastic": _plastic,
    "RoughConductor": _roughconductor,
    "RoughDielectric": _roughdielectric,
    "RoughPlastic": _roughplastic,
}
