"""Stress cases S56 and S37: every light on every material by every strategy, and the smoothest rough surface.

Significance: 1 % shared out by Sidak's formula among all comparisons of a family.
"""

import itertools
from functools import cache

import lamps
import numpy as np
import pytest
import trimesh
from cases import slow_but
from checks import samples
from materials import MATERIALS
from stats import mean_and_error, z_limit

import tracer
from lessons import zoo
from tracer import Settings
from tracer.bsdf.microfacet import DISTRIBUTIONS

pytestmark = pytest.mark.filterwarnings("error")

SHINES = {"emitter": {"type": "area", "radiance": 10.0}}
ABOVE = [{"rotate": [1, 0, 0], "angle": 90}, {"translate": [0, 2.5, 1]}]
LIGHTS = {
    "rectangle": {"type": "rectangle", "to_world": [{"scale": 0.8}, *ABOVE], **SHINES},
    "cube": {"type": "cube", "to_world": [{"scale": 0.5}, *ABOVE], **SHINES},
    "sphere": {"type": "sphere", "radius": 0.6, "to_world": ABOVE, **SHINES},
    "mesh": {"type": "ply", "filename": "lamp.ply", "to_world": [{"scale": 0.6}, *ABOVE], **SHINES},
    "constant": {"type": "constant", "radiance": 1.0},
    "envmap": {"type": "envmap", "filename": "sky.npy"},
    "point": {"type": "point", "position": [0, 2.5, 1], "intensity": 10.0},
    "directional": {"type": "directional", "direction": [0.2, -1, -0.5], "irradiance": 3.0},
}
UNMET = ("point", "directional")
SMOOTH = {
    "smooth metal": {"type": "conductor", "material": "Au"},
    "smooth glass": {"type": "dielectric", "int_ior": 1.5},
}
for kind in DISTRIBUTIONS:
    finest = {"alpha": 1e-4, "distribution": kind}
    SMOOTH[f"{kind} metal"] = {"type": "roughconductor", "material": "Au", **finest}
    SMOOTH[f"{kind} glass"] = {"type": "roughdielectric", "int_ior": 1.5, **finest}
PAIRS = len(MATERIALS) * len(LIGHTS) * 2
both = pytest.mark.parametrize("precision", [32, 64])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lights")
    trimesh.creation.icosphere(subdivisions=1).export(folder / "lamp.ply", vertex_normal=False)
    image = np.random.default_rng(0).random((5, 8, 3))
    image[1, 2] = 8.0
    np.save(folder / "sky.npy", image)
    return folder


@cache
def ball(name, light, folder):
    """A ball of a material over a grey floor, under one light."""
    look = {"look_at": {"origin": [0, 1.0, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}
    return tracer.load_dict(
        {
            "sensor": lamps.sensor(side=6) | {"fov": 28.0, "to_world": [look]},
            "ball": {"type": "sphere", "bsdf": (MATERIALS | SMOOTH)[name]},
            "floor": {
                "type": "rectangle",
                "to_world": [{"scale": 3}, {"rotate": [1, 0, 0], "angle": -90}, {"translate": [0, -1.1, 0]}],
                "bsdf": {"type": "diffuse", "reflectance": 0.5},
            },
            "light": LIGHTS[light],
        },
        folder=folder,
    )


@pytest.mark.slow
@pytest.mark.statistical
@both
@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("name", MATERIALS)
def test_s56_the_strategies_agree_for_every_light_on_every_material(
    suite_seed, folder, name, light, precision
):
    """Three estimates, or two of a light that no bounce meets. A Dirac lobe has no light sample: what it
    shows of a light is neither lost nor counted twice."""
    scene, found = ball(name, light, folder), {}
    for k, strategy in enumerate(("mis", "light") if light in UNMET else ("mis", "light", "bsdf")):
        settings = Settings(
            spp=64, strategy=strategy, max_depth=4, roulette="off", precision=precision, seed=suite_seed + k
        )
        radiance = samples(scene, settings)
        assert np.isfinite(radiance).all() and (radiance >= 0).all()
        found[strategy] = mean_and_error(radiance)
    for (a, error_a), (b, error_b) in itertools.combinations(found.values(), 2):
        assert (np.abs(a - b) < z_limit(3 * 3 * PAIRS) * np.hypot(error_a, error_b) + 1e-5).all(), found


@pytest.mark.slow
@pytest.mark.statistical
@pytest.mark.parametrize("light", LIGHTS)
def test_s56_light_samples_twice_too_bright_are_caught(suite_seed, folder, light):
    """The broken twin: on the diffuse ball, under each light."""
    wrong = zoo.changed(light_term=lambda *arguments: 2 * zoo.RIGHT.light_term(*arguments))
    scene, found = ball("diffuse", light, folder), []
    for k, steps in enumerate((zoo.RIGHT, wrong)):
        settings = Settings(spp=256, strategy="light", max_depth=4, roulette="off", seed=suite_seed + k)
        found.append(mean_and_error(samples(scene, settings, steps)))
    (a, error_a), (b, error_b) = found
    assert (np.abs(a - b) > z_limit(3 * 3 * PAIRS) * np.hypot(error_a, error_b) + 1e-5).any(), found


@pytest.mark.statistical
@both
@pytest.mark.parametrize("kind", slow_but(DISTRIBUTIONS, "ggx"))
@pytest.mark.parametrize("name", slow_but(("metal", "glass"), "glass"))
def test_s37_the_picture_of_the_smoothest_rough_surface_is_the_mirrors(
    suite_seed, folder, name, kind, precision
):
    """alpha = 1e-4 against 0, which is a Dirac lobe: each pixel to 3 standard errors and what Sidak adds."""
    pictures = [
        tracer.render(
            ball(material, "rectangle", folder),
            Settings(spp=128, precision=precision, max_depth=5, seed=suite_seed + k),
        )
        for k, material in enumerate((f"{kind} {name}", f"smooth {name}"))
    ]
    a, b = pictures
    error = np.sqrt(a.variance + b.variance + 1e-12)
    limit = max(3.0, z_limit(8 * error.size))
    assert (np.abs(a.rgb - b.rgb) / error).max() < limit
    assert (np.abs(2.0 * a.rgb - b.rgb) / error).max() > limit  # the broken twin
    assert a.dropped == b.dropped == 0
