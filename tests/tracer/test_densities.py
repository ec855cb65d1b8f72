"""Every sampler follows the density it claims, by chi-square; what is counted stands in tests/densities.

1 % is shared out by Sidak's formula among all samplers. Each test also sees the smallest fault it claims to
see: a density that leans by a tenth, and where there is one a fault of the sampler's own kind.
"""

import numpy as np
import pytest
from densities import FAMILIES, SAMPLERS, lights
from densities.sampler import Sampler, agreement, even, square
from densities.warps import BACK, landed
from lamps import light_samples, numbers
from stats import chi_square, sidak, uniform

from tracer.bsdf import ALL

LIMIT = sidak(len(SAMPLERS))
DEAR = ("bsdf", "lobe", "envmap", "solid angle", "cone")  # tests that take seconds together
NAMES = [n if not n.startswith(DEAR) else pytest.param(n, marks=pytest.mark.slow) for n in SAMPLERS]

pytestmark = pytest.mark.statistical


@pytest.mark.parametrize("name", NAMES)
def test_samples_follow_their_density(suite_seed, name):
    sampler = SAMPLERS[name]
    counts = sampler.count(suite_seed)
    assert sampler.against(counts) > LIMIT
    for fault in ("leaning", *(fault for fault, _ in sampler.faults)):
        assert sampler.against(counts, fault) < LIMIT, f"{fault} is not seen"


def test_every_kind_of_sampler_is_here():
    assert all(any(True for _ in family.samplers()) for family in FAMILIES)
    materials = {name.split()[1].rstrip("0123456789") for name in SAMPLERS if name.startswith("bsdf")}
    assert materials == {m.__name__ for m in ALL} - {"Conductor", "Dielectric", "ThinDielectric"}
    for kind in ("warp", "normals", "lobe", "area", "cone", "solid angle", "envmap", "constant", "choice"):
        assert any(name.startswith(kind) for name in SAMPLERS), kind
    assert any("0.001" in name for name in SAMPLERS if name.startswith("lobe"))


def test_a_triangle_without_its_root_is_caught(suite_seed):
    """The broken twin: u where sqrt(u) belongs."""
    counts = landed(
        lambda u: np.stack((1 - u[0], u[1] * u[0])), BACK["uniform_triangle"][1], suite_seed, np.float64
    )
    assert agreement(counts, even(counts.size)()) < LIMIT


def test_a_root_in_the_choice_of_the_face_is_caught(suite_seed):
    """The broken twin, from a framework that thousands have used: sqrt(u) where u chooses among areas."""
    scene = lights.room(("tall box", 1.0))
    u = numbers(suite_seed, lights.N, np.float64)
    light = light_samples(scene, lights.FAR, 0, by="area", u=np.stack((np.sqrt(u[0]), *u[1:])), n=lights.N)
    assert agreement(np.bincount(light.primitive, minlength=10), lights.areas("tall box")) < LIMIT


def test_a_sample_where_there_is_no_density_is_caught():
    never = Sampler("never", lambda seed: np.array([10_000, 10_000, 1]), lambda: np.array([0.5, 0.5, 0.0]))
    assert never.p(0) == 0.0


def test_a_density_above_one_is_caught():
    more = Sampler("more", lambda seed: np.array([10_000, 10_000]), lambda: np.array([0.5, 0.502]))
    with pytest.raises(AssertionError, match="more than 1"):
        more.p(0)


def test_chi_square_is_calibrated(suite_seed):
    """Of p-values of true hypotheses, 5 % are below 5 %: between 2.5 % and 8 % of 1000."""
    rng = np.random.default_rng(suite_seed)
    p = [uniform(rng.random((1, 2000)), 16) for _ in range(1000)]
    assert 0.025 < np.mean(np.array(p) < 0.05) < 0.08
    assert chi_square([0, 3, 5], [0.0, 4.0, 4.0]) > 0.0
    assert chi_square([1, 3, 4], [0.0, 4.0, 4.0]) == 0.0
    assert square(np.array([[0.1, 0.9], [0.2, 0.8]]), 2, 2).tolist() == [1.0, 0.0, 0.0, 1.0]
