"""Materials as scenes describe them: words, named metals and indices, and what an index of 1 means."""

import copy

import numpy as np
import pytest

import tracer
from tracer import Settings, TracerError
from tracer.bsdf import (
    Conductor,
    Dielectric,
    Plastic,
    RoughConductor,
    RoughDielectric,
    RoughPlastic,
    ThinDielectric,
    TwoSided,
)
from tracer.bsdf.metals import METALS, WAVELENGTHS, index_of
from tracer.scene_file.materials import INDICES, bsdf

SCENE = {
    "sensor": {
        "type": "perspective",
        "fov": 50.0,
        "to_world": [{"look_at": {"origin": [0, 1, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}],
        "film": {"width": 12, "height": 9},
    },
    "floor": {"type": "rectangle", "to_world": [{"scale": 4}, {"rotate": [1, 0, 0], "angle": -90}]},
    "lamp": {
        "type": "rectangle",
        "to_world": [{"rotate": [1, 0, 0], "angle": 90}, {"translate": [0, 3, 0]}],
        "emitter": {"type": "area", "radiance": 5.0},
    },
}


def scene(material=None, **more):
    description = copy.deepcopy(SCENE)
    if material:
        description["ball"] = {"type": "sphere", "center": [0, 1, 0], "radius": 0.8, "bsdf": material}
    return tracer.load_dict(description | more)


READ = [
    ({"type": "thindielectric"}, ThinDielectric),
    ({"type": "roughconductor"}, RoughConductor),
    ({"type": "roughconductor", "material": "Au", "alpha_u": 0.1, "alpha_v": 0.3}, RoughConductor),
    ({"type": "roughconductor", "alpha": 0}, Conductor),
    ({"type": "roughconductor", "alpha": 0.2, "distribution": "ggx", "fresnel": "schlick"}, RoughConductor),
    ({"type": "conductor", "material": "Ag"}, Conductor),
    ({"type": "conductor", "eta": 0, "k": 1}, Conductor),
    ({"type": "roughdielectric", "int_ior": "water", "ext_ior": 1.0}, RoughDielectric),
    ({"type": "roughdielectric", "int_ior": 1.3, "ext_ior": 1.3}, Dielectric),
    ({"type": "plastic", "nonlinear": True}, Plastic),
    ({"type": "roughplastic", "alpha": 0.3}, RoughPlastic),
    ({"type": "roughplastic", "alpha": 0}, Plastic),
    ({"type": "twosided", "bsdf": {"type": "diffuse"}}, TwoSided),
    ({"type": "twosided", "any name": {"type": "plastic"}}, TwoSided),
]


@pytest.mark.parametrize(("description", "kind"), READ, ids=str)
def test_a_description_gives_its_material(description, kind):
    assert type(bsdf(description, "here")) is kind


@pytest.mark.parametrize("kind", ["roughconductor", "roughdielectric", "roughplastic"])
def test_a_rough_surface_about_which_nothing_is_said_is_that_of_mitsuba(kind):
    facets = bsdf({"type": kind}, "here").facets
    assert (facets.distribution, *facets.alpha_u, *facets.alpha_v) == ("beckmann", 0.1, 0.1)


BAD = [
    ("dielectric", {"int_ior": 0}, ("int_ior", "0")),
    ("dielectric", {"int_ior": -1.5}, ("int_ior", "-1.5")),
    ("dielectric", {"ext_ior": float("nan")}, ("ext_ior", "nan")),
    ("thindielectric", {"int_ior": float("inf")}, ("int_ior", "inf")),
    ("plastic", {"int_ior": 0.0}, ("int_ior",)),
    ("roughdielectric", {"int_ior": "glas"}, ("int_ior", "glas", "bk7")),
    ("conductor", {"eta": [0, 1, 1], "k": 0}, ("eta",)),
    ("conductor", {"eta": -0.2, "k": 3}, ("eta", "-0.2")),
    ("conductor", {"eta": 1, "k": float("nan")}, ("k", "nan")),
    ("conductor", {"eta": 1}, ("k", "missing")),
    ("conductor", {"material": "gold"}, ("material", "gold", "Au")),
    ("roughconductor", {"alpha": -0.1}, ("alpha", "-0.1")),
    ("roughconductor", {"alpha": 1e-6}, ("alpha", "1e-06", "0.0001")),
    ("roughconductor", {"alpha": 10}, ("alpha", "10")),
    ("roughconductor", {"alpha": float("nan")}, ("alpha", "nan")),
    ("roughconductor", {"alpha": 0.1, "alpha_u": 0.2}, ("alpha",)),
    ("roughconductor", {"alpha_u": 0.1, "alpha_v": 0}, ("alpha_v",)),
    ("roughconductor", {"distribution": "phong"}, ("distribution", "phong", "ggx", "beckmann")),
    ("roughconductor", {"distribution": ["ggx"]}, ("distribution",)),
    ("roughplastic", {"alpha_u": 0.1}, ("alpha_u", "unknown")),
    ("dielectric", {"fresnel": "schlik"}, ("fresnel", "schlik", "schlick")),
    ("plastic", {"nonlinear": 1}, ("nonlinear", "1")),
    ("plastic", {"diffuse_reflectance": 1.5}, ("diffuse_reflectance", "1.5")),
    ("twosided", {}, ("twosided", "one")),
    ("twosided", {"a": {"type": "diffuse"}, "b": {"type": "diffuse"}}, ("twosided", "2")),
    ("twosided", {"a": {"type": "dielectric"}}, ("dielectric", "two sides")),
    ("twosided", {"a": {"type": "twosided", "b": {"type": "diffuse"}}}, ("twosided",)),
    ("twosided", {"a": {"type": "ref", "id": "nobody"}}, ("nobody",)),
]


@pytest.mark.parametrize(("kind", "words", "named"), BAD, ids=str)
def test_s30_what_no_material_can_be_is_refused_in_one_line(kind, words, named):
    with pytest.raises(ValueError) as caught:
        bsdf({"type": kind} | words, "here")
    assert isinstance(caught.value, TracerError)
    assert all(name in str(caught.value) for name in ("here", *named)) and "\n" not in str(caught.value)


def test_a_reference_inside_twosided_is_followed():
    description = {
        "white": {"type": "diffuse", "reflectance": 0.25},
        "sheet": {"type": "twosided", "bsdf": {"type": "ref", "id": "white"}},
        "wall": {"type": "rectangle", "bsdf": "sheet"},
    }
    inside = scene(**description).definition.bsdfs["sheet"].bsdf
    assert (inside.reflectance == 0.25).all()


@pytest.mark.parametrize("name", INDICES)
def test_named_indices_are_those_of_their_names(name):
    assert 1.0 <= INDICES[name] <= 2.42
    assert bsdf({"type": "dielectric", "int_ior": name, "ext_ior": 1.0}, "here").eta[0] == INDICES[name]


# Reflectance head on under white light, as tables of colours for rendering give it (to a few hundredths).
LOOKS = {
    "Au": (0.94, 0.78, 0.37),
    "Ag": (0.97, 0.96, 0.93),
    "Cu": (0.93, 0.64, 0.54),
    "Al": (0.91, 0.92, 0.92),
}


@pytest.mark.parametrize("name", METALS)
def test_metals_have_the_colours_of_metals(name):
    eta, k = index_of(name)
    assert ((eta > 0.03) & (eta < 2) & (k > 1.5) & (k < 8)).all()
    assert list(WAVELENGTHS) == sorted(WAVELENGTHS, reverse=True)
    R = bsdf({"type": "conductor", "material": name}, "here").display_colour()[:, 0]
    assert np.allclose(R, LOOKS[name], atol=0.06), R


GHOSTS = [
    {"type": "dielectric", "int_ior": 1.3, "ext_ior": 1.3},
    {"type": "roughdielectric", "int_ior": "water", "ext_ior": "water", "alpha": 0.4},
    {"type": "thindielectric", "int_ior": "air"},
]


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("material", GHOSTS, ids=lambda m: m["type"])
def test_s28_a_scene_with_an_object_of_index_1_is_the_scene_without_it(material, precision):
    settings = Settings(spp=4, precision=precision)
    without, ghost = (tracer.render(scene(m), settings) for m in (None, material))
    assert without.rgb.tobytes() == ghost.rgb.tobytes() and without.rays == ghost.rays
    glass = tracer.render(scene(material | {"int_ior": 1.5, "ext_ior": 1.3}), settings)
    assert glass.rgb.tobytes() != ghost.rgb.tobytes()


def test_what_has_a_colour_or_shines_is_kept_whatever_its_index():
    tinted = GHOSTS[0] | {"specular_transmittance": [0.5, 1, 1]}
    assert len(scene(tinted).shapes) == 3
    lamp = {"type": "sphere", "bsdf": GHOSTS[0], "emitter": {"type": "area", "radiance": 1.0}}
    assert len(scene(bulb=lamp).shapes) == 3
    ghost = {"type": "sphere", "bsdf": GHOSTS[0]}
    alone = {"sensor": SCENE["sensor"], "ghost": ghost}
    assert len(tracer.load_dict(alone).shapes) == 1  # a scene is never empty


@pytest.mark.parametrize("precision", [32, 64])
def test_s28_light_goes_through_a_kept_surface_of_index_1_without_a_turn(precision):
    dtype = np.float32 if precision == 32 else np.float64
    material = bsdf(GHOSTS[0], "here").astype(dtype)
    mu = np.array([1.0, 0.5, 1e-3, -1e-3, -0.7], dtype)
    wo = np.stack((np.sqrt(1 - mu * mu), 0 * mu, mu))
    sample = material.sample(wo, np.zeros((3, 5), dtype))
    assert np.array_equal(sample.wi, -wo)
    assert (sample.pdf == 1).all() and (sample.f == 1).all()
