"""Every kind of light: what it sends, how it is chosen, and one answer from every loop.

Comparisons allow 4 standard errors, which a right tracer exceeds once in 16 000; chi-square is at 1 %. That
directions follow their densities is in test_densities.
"""

import checks
import lamps
import numpy as np
import pytest
from densities.lights import BALL, ready_sky, sky
from stats import chi_square, mean_and_error, sidak

import tracer
from lessons import zoo
from tracer import Settings
from tracer.events import TECHNIQUES
from tracer.frame import dot
from tracer.light.envmap import Envmap

both = pytest.mark.parametrize("precision", [32, 64])
GREY = {"type": "diffuse", "reflectance": 0.5}


LIGHTS = {
    "point": {"type": "point", "position": [0.5, 0, 3], "intensity": [5, 4, 3]},
    "directional": {"type": "directional", "direction": [1, 0.3, -1], "irradiance": 2.0},
    "constant": {"type": "constant", "radiance": [1.0, 0.8, 0.6]},
    "envmap": {"type": "envmap", "filename": "sky.npy", "to_world": [{"rotate": [1, 0, 0], "angle": 90}]},
    "rectangle": lamps.rectangle([-1, 1, 2], [0.5, 0, 0], [0, 0.5, 0], towards=[0, 0, 0], radiance=9.0),
    "sphere": lamps.sphere([3, 1, 3], 0.6, 20.0),
}


MANY = tuple(name for name in LIGHTS if name != "constant")  # there can be only one sky


def stage(folder, *names):
    """A ball over a floor under these lights."""
    np.save(folder / "sky.npy", sky())
    floor = {"type": "rectangle", "to_world": [{"scale": 2}], "bsdf": GREY}
    ball = {"type": "sphere", "radius": 0.6, "center": [0.3, 0.2, 0.7], "bsdf": GREY}
    camera = lamps.sensor([0, -5, 4], side=8)
    objects = {"sensor": camera, "floor": floor, "ball": ball, **{name: LIGHTS[name] for name in names}}
    return tracer.load_dict(objects, folder=folder)


def settings(seed, spp=256, **options):
    return Settings(spp=spp, seed=seed, max_depth=4, roulette="off", **options)


@pytest.mark.statistical
@both
@pytest.mark.parametrize(
    "names", [*((name,) for name in LIGHTS), pytest.param(MANY, marks=pytest.mark.slow)], ids="-".join
)
def test_s56_every_loop_finds_the_same_light(suite_seed, tmp_path, names, precision):
    scene = stage(tmp_path, *names)
    unmet = "point" in names or "directional" in names
    ways = [("direct", "mis"), ("path", "mis"), ("path", "light")]
    ways += [] if unmet else [("walk", "mis"), ("path", "bsdf")]
    found = [
        checks.samples(scene, settings(suite_seed + k, integrator=i, strategy=s, precision=precision))
        for k, (i, s) in enumerate(ways)
    ]
    for other in found[1:]:
        assert checks.agreement([found[0]], [other]) <= 1.0
    mean, error = mean_and_error(found[1])
    assert (error < 0.02 * mean).all()


@pytest.mark.statistical
@pytest.mark.parametrize("name", LIGHTS)
def test_s56_light_samples_a_third_too_bright_are_caught(suite_seed, tmp_path, name):
    """The broken twin: one loop's of two that both need them, and of each kind of light."""
    scene, wrong = stage(tmp_path, name), zoo.changed(light_term=brighter)
    right = checks.samples(scene, settings(suite_seed, integrator="path"))
    twin = checks.samples(scene, settings(suite_seed + 1, integrator="direct"), wrong)
    assert checks.agreement([right], [twin]) > 1.0


def brighter(*arguments):
    return 4 / 3 * zoo.RIGHT.light_term(*arguments)


@pytest.mark.parametrize("name", ["point", "directional"])
@pytest.mark.parametrize("options", [{"integrator": "walk"}, {"strategy": "bsdf"}], ids=["walk", "bsdf"])
def test_bounces_alone_refuse_a_light_they_never_meet(tmp_path, name, options):
    with pytest.raises(tracer.TracerError, match=f"no ray ever meets {name}.*use integrator direct"):
        tracer.render(stage(tmp_path, name, "constant"), settings(0, 1, **options))


@both
def test_a_point_light_is_never_weighted_and_has_no_density(precision):
    scene = lamps.scene({"type": "point", "position": [0, 0, 2], "intensity": 1.0}, {"type": "rectangle"})
    light = lamps.light_samples(scene, [0, 0, 0], 0, 3, precision)
    assert (light.technique == TECHNIQUES.index("delta")).all() and (light.pdf == light.pick).all()


@both
def test_a_directional_light_sends_its_irradiance_everywhere(suite_seed, precision):
    scene = lamps.scene(
        {"type": "directional", "direction": [0.6, 0, -0.8], "irradiance": 3.0}, {"type": "rectangle"}
    )
    for point in ([0, 0, 0], [100, -50, 3]):
        light = lamps.light_samples(scene, point, suite_seed, 3, precision)
        assert np.abs(lamps.irradiance(light) / 2.4 - 1).max() < {32: 4e-7, 64: 1e-12}[precision]
        assert (np.abs(light.q).max(axis=0) > 1.0).all(), "the shadow ray ends inside the scene"


@pytest.mark.statistical
def test_a_constant_sky_over_an_open_floor_gives_its_albedo(suite_seed):
    """Lo = rho L, whichever way it is found; bounces alone have no variance at all."""
    scene = lamps.scene(
        {"type": "constant", "radiance": 2.0},
        {"type": "rectangle", "bsdf": GREY},
        camera=lamps.sensor([0, 0, 1], side=4),
    )
    for strategy in ("bsdf", "light", "mis"):
        radiance = checks.samples(scene, settings(suite_seed, 2048, strategy=strategy))
        mean, error = mean_and_error(radiance)
        assert checks.off(mean, 1.0, error, 1e-5) <= 1.0 and (error < 0.01).all()
        assert checks.off(1.08 * mean, 1.0, error, 1e-5) > 1.0  # the broken twin
    bounced = checks.samples(scene, settings(suite_seed, 16, strategy="bsdf"))
    assert np.abs(bounced - 1.0).max() < 1e-6


def test_escaping_rays_carry_the_sky_and_its_density(tmp_path, suite_seed):
    scene = stage(tmp_path, "envmap")
    options = settings(suite_seed, 8)
    ready = scene.at(options)
    seen = 0
    for x in range(8):
        for path in tracer.inspect(scene, options, x, 0).paths:
            for event in path.events:
                if event.kind.name != "escape":
                    continue
                v = event.values
                Le, pdf = ready.environment(v["d"][:, None])
                assert np.array_equal(v["Le"], Le[:, 0]) and v["pdf_light"] == pdf[0]
                assert event.depth or v["w"] == 1.0
                seen += 1
    assert seen > 20


def directions(seed, n):
    """Directions uniform over the sphere."""
    d = np.random.default_rng(seed).normal(size=(3, n))
    return d / np.sqrt(dot(d, d))


@pytest.mark.slow
@both
def test_the_density_of_a_sky_integrates_to_one(suite_seed, precision):
    d = directions(suite_seed, 2_000_000).astype({32: np.float32, 64: np.float64}[precision])
    pdf = ready_sky(precision).pdf(d).astype(np.float64) * 4 * np.pi
    assert abs(pdf.mean() - 1) < 4 * pdf.std() / np.sqrt(pdf.size) < 0.01


@both
def test_a_sky_says_the_same_about_a_direction_whichever_way_it_is_asked(suite_seed, precision):
    light = ready_sky(precision, turn=np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]))
    p = np.zeros((3, 5000), light.dtype)
    _, _, wi, distance, Le, pdf = light.sample(p, lamps.numbers(suite_seed, 5000, light.dtype, 2))
    assert np.array_equal(Le, light.radiance(wi)) and np.array_equal(pdf, light.pdf(wi))
    assert (pdf > 0).all() and (Le >= 0).all() and (distance >= 2 * BALL.radius).all()
    assert np.abs(dot(wi, wi) - 1).max() < 8 * np.finfo(light.dtype).eps


def test_a_sky_lies_as_mitsuba_lays_it():
    """Columns from -z by way of +x, rows from +y down; texels are points, bilinear between."""
    image = np.zeros((5, 4, 3))
    image[2, :, 0] = [1, 2, 3, 4]  # the equator, at longitudes 45, 135, 225 and 315 degrees
    image[0, :, 1] = 7.0
    light = Envmap("sky", image, np.eye(3)).ready(np.float64, BALL)
    root = np.sqrt(0.5)
    d = np.array([[root, 0, -root], [root, 0, root], [1, 0, 0], [0, 1, 0], [0, 0, -1]]).T
    assert np.allclose(light.radiance(d)[0], [1, 2, 1.5, 0, 2.5], atol=1e-12)
    assert np.allclose(light.radiance(d)[1], [0, 0, 0, 7, 0], atol=1e-12)


@pytest.mark.statistical
def test_all_kinds_are_chosen_by_their_power(suite_seed, tmp_path):
    of = np.array([0.212671, 0.715160, 0.072169])
    power = {
        "rectangle": np.pi * 9.0,
        "sphere": np.pi * 20.0 * 4 * np.pi * 0.6**2,
        "point": 4 * np.pi * of @ [5, 4, 3],
    }
    only = stage(tmp_path, "rectangle", "sphere", "point", "directional").at(Settings(precision=64))
    low, high = only.bounds()
    power["directional"] = np.pi * (0.5 * np.linalg.norm(high - low)) ** 2 * 2.0
    u = lamps.numbers(suite_seed, 60_000, np.float64)
    light = only.sample_light(np.full((3, 60_000), 0.1), u)
    share = np.array([power[name] for name in only.light_names])
    share /= share.sum()
    assert np.allclose(light.pick, share[light.light])
    counts = np.bincount(light.light, minlength=4)
    assert chi_square(counts, 60_000 * share) > sidak(1)
    wrong = share * [1.0, 1.0, 1.0, 0.9]  # the broken twin: one light's power a tenth too small
    assert chi_square(counts, 60_000 * wrong / wrong.sum()) < sidak(1)
