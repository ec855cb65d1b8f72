"""A closed room that shines evenly: the one scene whose every radiance is known exactly.

If all walls send Le and reflect the share rho, the radiance L is the same everywhere, L = Le + rho L: light
that has been reflected up to k - 1 times sums to Le (1 - rho^k) / (1 - rho). Mistakes of energy show here
and nowhere so clearly. Each comparison allows 4 standard errors, which a right tracer exceeds once in 16 000,
and the rounding of the precision. Of all comparisons here together one set of runs in 150 fails by chance.
"""

import checks
import numpy as np
import pytest
from stats import mean_and_error

import tracer
from lessons import zoo
from tracer import Settings

DEPTHS = (1, 2, 3, 8, 50)
INTEGRATORS = ("walk", "direct", "path")

pytestmark = pytest.mark.statistical

SPHERE_ROOM = {
    "sensor": {
        "type": "perspective",
        "fov": 90.0,
        "to_world": [{"look_at": {"origin": [0.2, 0.1, 0], "target": [1, 0, 0], "up": [0, 1, 0]}}],
        "film": {"width": 16, "height": 16},
    },
    "grey": {"type": "diffuse", "reflectance": 0.8},
    "room": {
        "type": "sphere",
        "flip_normals": True,
        "bsdf": "grey",
        "emitter": {"type": "area", "radiance": 0.5},
    },
}


def small(suite_seed, spp=64, **options):
    return Settings(width=16, height=16, spp=spp, seed=suite_seed, **options)


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("max_depth", DEPTHS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_furnace_has_its_radiance(suite_seed, integrator, max_depth, precision):
    settings = small(suite_seed, integrator=integrator, max_depth=max_depth, precision=precision)
    assert checks.furnace(settings) <= 1.0


@pytest.mark.parametrize("max_depth", DEPTHS)
@pytest.mark.parametrize(
    "options",
    [
        {"hemisphere": "uniform"},
        {"hemisphere": "uniform", "integrator": "direct"},
        {"heuristic": "balance"},
        {"strategy": "light"},
        {"strategy": "bsdf", "hemisphere": "uniform"},
        {"roulette": "0.8"},
        {"roulette": "off"},
        {"jitter": False},
    ],
    ids=lambda options: "-".join(map(str, options.values())),
)
def test_the_furnace_has_its_radiance_with_every_option(suite_seed, options, max_depth):
    assert checks.furnace(small(suite_seed, spp=32, max_depth=max_depth, **options)) <= 1.0


def test_the_furnace_has_its_radiance_at_unlimited_depth(suite_seed):
    assert checks.furnace(small(suite_seed, max_depth=-1)) <= 1.0


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("max_depth", DEPTHS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_round_furnace_has_its_radiance(suite_seed, integrator, max_depth, precision):
    """Inside a sphere every point of the lamp sends the same, so that even light samples hardly vary."""
    settings = small(suite_seed, 16, integrator=integrator, max_depth=max_depth, precision=precision)
    room = tracer.load_dict(SPHERE_ROOM)
    assert checks.furnace(settings, scene=room, Le=0.5, rho=0.8) <= 1.0


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("integrator", ["walk", "path"])
def test_without_roulette_bounces_alone_give_the_furnace_exactly(suite_seed, integrator, precision):
    """f cos / pdf is rho at every bounce: no variance is left, only rounding."""
    strategy = {"walk": "mis", "path": "bsdf"}[integrator]
    settings = small(
        suite_seed,
        2,
        integrator=integrator,
        strategy=strategy,
        max_depth=20,
        roulette="off",
        precision=precision,
    )
    truth = 2.0 * (1.0 - 0.5**20)
    radiance = checks.samples(tracer.load("furnace"), settings)
    assert np.abs(radiance / truth - 1.0).max() <= checks.ROUNDING[precision]


def slightly_dark(beta, sample, cos):
    """The smallest fault that the test claims to see: 0.2 % of the throughput lost at every bounce."""
    return np.float32(0.998) * zoo.RIGHT.throughput(beta, sample, cos)


@pytest.mark.parametrize("integrator", ["walk", "path"])
def test_a_loss_of_two_thousandths_a_bounce_is_caught(suite_seed, integrator):
    wrong = zoo.changed(throughput=slightly_dark)
    settings = small(suite_seed, 256, integrator=integrator, max_depth=8)
    assert checks.furnace(settings) <= 1.0
    assert checks.furnace(settings, wrong) > 1.0


def test_the_standard_error_is_small_enough_to_mean_something(suite_seed):
    """4 standard errors at depth 8 are below 1.5 % of the radiance for every integrator."""
    for integrator in INTEGRATORS:
        settings = small(suite_seed, integrator=integrator, max_depth=8)
        mean, error = mean_and_error(checks.samples(tracer.load("furnace"), settings))
        assert (4.0 * error < 0.015 * mean).all(), (integrator, error / mean)
