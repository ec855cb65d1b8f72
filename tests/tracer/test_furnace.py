"""A closed room that shines evenly: the one scene whose every radiance is known exactly.

If all walls send Le and reflect the share rho, the radiance L is the same everywhere, L = Le + rho L: light
that has been reflected up to k - 1 times sums to Le (1 - rho^k) / (1 - rho). Mistakes of energy show here
and nowhere so clearly. Each comparison allows 4 standard errors, which a right tracer exceeds once in 16 000,
and the rounding of the precision. Of all comparisons here together one set of runs in 150 fails by chance.

Light samples alone have no finite variance in a cubic room: where walls meet, cos cos' / r^2 has no bound,
and the share of samples above t falls only as t^-3/2. What a mean of N samples with the largest M still
misses is then about 3 M / N; 5 M / N is allowed on top. In the round room there is no such tail.
"""

from dataclasses import fields
from functools import partial

import checks
import numpy as np
import pytest
from cases import INTEGRATORS, slow_but
from stats import mean_and_error

import tracer
from lessons import zoo
from tracer import Settings

DEPTHS = (1, 2, 3, 8, 50)

WAYS = next(f.metadata["choices"] for f in fields(Settings) if f.name == "light_sampling")

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


@pytest.mark.parametrize("precision", slow_but((32, 64), 32))
@pytest.mark.parametrize("max_depth", DEPTHS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_furnace_has_its_radiance(suite_seed, integrator, max_depth, precision):
    settings = small(suite_seed, integrator=integrator, max_depth=max_depth, precision=precision)
    assert checks.furnace(settings) <= 1.0


@pytest.mark.parametrize("max_depth", slow_but(DEPTHS, 3, 50))
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
        *({"light_sampling": way, "integrator": "direct"} for way in WAYS),
        *({"light_sampling": way, "strategy": "mis"} for way in WAYS),
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


def darker(share, beta, sample, cos):
    """A little of the throughput is lost at every bounce."""
    return beta.dtype.type(1.0 - share) * zoo.RIGHT.throughput(beta, sample, cos)


@pytest.mark.parametrize(("integrator", "share"), [("walk", 0.005), ("path", 0.01)])
def test_a_small_loss_at_every_bounce_is_caught(suite_seed, integrator, share):
    """The broken twin: the smallest fault that the furnace claims to see with each integrator."""
    settings = small(suite_seed, 256, integrator=integrator, max_depth=8)
    assert checks.furnace(settings) <= 1.0
    assert checks.furnace(settings, zoo.changed(throughput=partial(darker, share))) > 1.0


def test_a_small_loss_is_caught_by_light_samples_in_a_round_room(suite_seed):
    """The broken twin of the round furnace."""
    settings, room = small(suite_seed, 64, integrator="direct", max_depth=8), tracer.load_dict(SPHERE_ROOM)
    wrong = zoo.changed(throughput=partial(darker, 0.01))
    assert checks.furnace(settings, scene=room, Le=0.5, rho=0.8) <= 1.0
    assert checks.furnace(settings, wrong, scene=room, Le=0.5, rho=0.8) > 1.0


def test_the_standard_error_is_small_enough_to_mean_something(suite_seed):
    """4 standard errors at depth 8 are below 1 % of the radiance."""
    for integrator in ("walk", "path"):
        settings = small(suite_seed, integrator=integrator, max_depth=8)
        mean, error = mean_and_error(checks.samples(tracer.load("furnace"), settings))
        assert (4.0 * error < 0.01 * mean).all(), (integrator, error / mean)
