"""Random numbers: a pure function of seed, pixel, sample, depth and use; uniform and independent.

Chi-square at 1 %, shared out by Sidak's formula among the tests of one kind.
"""

from collections import Counter

import numpy as np
import pytest
from cases import SCENES, loaded
from scipy import stats as distributions
from stats import sidak, uniform

from tracer import Settings
from tracer.engine import waves
from tracer.integrator.wave import Wave
from tracer.sampler import USES, Independent, pack_pixel, pcg4d

N = 1 << 16
DTYPES = (np.float32, np.float64)
MASK = 0xFFFFFFFF


def reference(v):
    """pcg4d in plain whole numbers (Jarzynski and Olano 2020, their listing)."""
    x, y, z, w = ((a * 1664525 + 1013904223) & MASK for a in v)
    for shift in (True, False):
        x = (x + y * w) & MASK
        y = (y + z * x) & MASK
        z = (z + x * y) & MASK
        w = (w + y * z) & MASK
        if shift:
            x, y, z, w = (a ^ (a >> 16) for a in (x, y, z, w))
    return x, y, z, w


def words(values):
    return [np.array(v, np.uint32) for v in np.transpose(values)]


def test_the_hash_is_the_published_one(suite_seed):
    inputs = np.random.default_rng(suite_seed).integers(0, 2**32, (200, 4)).tolist()
    inputs += [[0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1], [MASK] * 4, [2**31, 2**16, 1, MASK]]
    out = np.transpose(pcg4d(*words(inputs))).tolist()
    assert out == [list(reference(v)) for v in inputs]


def test_the_hash_stays_within_32_bits():
    for word in pcg4d(*words([[MASK, 7, 2**31, 12345]])):
        assert word.dtype == np.uint32


def test_known_answers():
    """These numbers are in links and recordings: they may never change."""
    sampler = Independent(7, np.float64)
    pixel, sample = pack_pixel([3], [5]), np.array([11], np.uint32)
    for depth in (0, 2):
        for code, (use, count) in enumerate(USES.items()):
            got = sampler(pixel, sample, np.array([depth]), use)
            want = reference((5 << 16 | 3, 11, depth * len(USES) + code, 7))[:count]
            assert got.tolist() == [[w / 2**32] for w in want]
            single = Independent(7, np.float32)(pixel, sample, np.array([depth]), use)
            assert single.tolist() == [[(w >> 8) / 2**24] for w in want]


@pytest.mark.parametrize("dtype", DTYPES)
def test_numbers_stay_below_one_whatever_the_word(dtype):
    last = {np.float32: 1 - 2.0**-24, np.float64: 1 - 2.0**-32}[dtype]
    sampler = Independent(0, dtype)
    u = sampler(np.arange(N, dtype=np.uint32), np.zeros(N, np.uint32), np.zeros(N, int), "light")
    assert u.dtype == dtype and u.min() >= 0 and u.max() <= last < 1
    assert dtype(MASK >> 8) * dtype(2.0**-24) < 1


def axes(varied, seed, use, dtype=np.float32):
    """N numbers of a use along one axis: neighbouring pixels, samples, depths or seeds."""
    n = np.arange(N)
    place = {"pixel": np.full(N, 77), "sample": np.full(N, 5), "depth": np.full(N, 3)}
    if varied == "seed":
        return np.concatenate(
            [
                Independent(s, dtype)(pack_pixel([7], [1]), np.array([5], np.uint32), np.array([3]), use)
                for s in range(seed, seed + 2048)
            ],
            axis=1,
        )
    place[varied] = n
    pixel = pack_pixel(place["pixel"] % 256, place["pixel"] // 256)
    return Independent(seed, dtype)(pixel, place["sample"].astype(np.uint32), place["depth"], use)


VARIED = ("pixel", "sample", "depth", "seed")


@pytest.mark.statistical
@pytest.mark.parametrize("use", USES)
@pytest.mark.parametrize("varied", VARIED)
def test_numbers_are_uniform_along_every_axis(suite_seed, varied, use):
    u = axes(varied, suite_seed, use)
    bins = {1: 256, 2: 16, 3: 6}[u.shape[0]]
    bins = bins if varied != "seed" else bins // 2
    assert uniform(u, bins) > sidak(len(VARIED) * len(USES))
    u[0] **= 1.1 if varied != "seed" else 1.5  # the broken twins: small numbers a little too common
    assert uniform(u, bins) < sidak(len(VARIED) * len(USES))


@pytest.mark.statistical
@pytest.mark.parametrize("use", USES)
@pytest.mark.parametrize("varied", VARIED)
def test_neighbours_are_independent(suite_seed, varied, use):
    """The pair (a number, the same one of the next pixel, sample, depth or seed) fills the square evenly."""
    u = axes(varied, suite_seed, use)[0]
    pairs = np.stack((u[:-1], u[1:]))
    assert uniform(pairs, 16 if varied != "seed" else 8) > sidak(len(VARIED) * len(USES))


@pytest.mark.statistical
def test_different_uses_at_one_vertex_are_independent(suite_seed):
    """So are light and bounce, whose sharing would leave every mean right and hide from other tests."""
    numbers = [row for use in USES for row in axes("pixel", suite_seed, use)]
    pairs = [(a, b) for k, a in enumerate(numbers) for b in numbers[k + 1 :]]
    assert min(uniform(np.stack(pair), 16) for pair in pairs) > sidak(len(pairs))


@pytest.mark.statistical
def test_equal_words_are_as_rare_as_chance_has_them(suite_seed):
    """Of n words of 32 bits, n^2 / 2^33 pairs are equal; Poisson's 99.9 % interval around that is allowed."""
    n = 1 << 18
    u = Independent(suite_seed, np.float64)(
        np.arange(n, dtype=np.uint32), np.zeros(n, np.uint32), np.zeros(n, int), "bsdf"
    )
    for row in u:
        repeats = n - np.unique(row).size
        low, high = distributions.poisson.interval(0.999, n * n / 2**33)
        assert low <= repeats <= high
        assert n - np.unique(np.floor(row * 2.0**29)).size > high  # the broken twin: words of 29 bits


@pytest.mark.statistical
def test_the_number_of_a_neighbour_used_again_is_caught(suite_seed):
    """The broken twin: light and bounce share one number in a hundred."""
    light, bounce = axes("pixel", suite_seed, "light")[0], axes("pixel", suite_seed, "bsdf")[0]
    shared = np.where(np.arange(N) % 50 == 0, light, bounce)
    assert uniform(np.stack((light, shared)), 16) < sidak(100)


def test_it_is_a_pure_function():
    sampler = Independent(3)
    lanes = np.arange(1000)
    args = pack_pixel(lanes % 32, lanes // 32), lanes.astype(np.uint32), lanes % 7
    whole = sampler(*args, "light")
    sampler(*args, "bsdf")
    assert sampler(*args, "light").tobytes() == whole.tobytes()
    assert Independent(3)(*args, "light").tobytes() == whole.tobytes()
    backwards = sampler(*(a[::-1] for a in args), "light")[:, ::-1]
    assert backwards.tobytes() == whole.tobytes()
    alone = sampler(*(a[[417]] for a in args), "light")[:, 0]
    assert alone.tobytes() == np.ascontiguousarray(whole[:, 417]).tobytes()


def asked_for(scene, settings, heard=lambda depth: depth):
    """How often each (pixel, sample, depth, use) is asked for while a picture is traced.

    heard: which depth the sampler takes a depth for.
    """
    pixel, sample = np.divmod(np.arange(8 * 8 * 4), 4)
    wave = Wave(pixel % 8, pixel // 8, sample, settings)
    inner, asked = wave.random, Counter()

    def counted(pixel, sample, depth, use):
        depth = heard(depth)
        asked.update((*key, use) for key in zip(pixel.tolist(), sample.tolist(), depth.tolist(), strict=True))
        return inner(pixel, sample, depth, use)

    wave.random = counted
    for _ in waves.events(scene.at(settings), settings, wave):
        pass
    return asked


@pytest.mark.parametrize("integrator", ["walk", "direct", "path"])
@pytest.mark.parametrize("scene", SCENES)
def test_no_number_is_used_twice(suite_seed, scene, integrator):
    settings = Settings(width=8, height=8, spp=4, integrator=integrator, seed=suite_seed)
    asked = asked_for(loaded(scene), settings)
    assert len(asked) > 500
    assert set(asked.values()) == {1}


def test_the_same_numbers_at_every_depth_are_caught(suite_seed):
    """The broken twin: the depth never reaches the sampler."""
    settings = Settings(width=8, height=8, spp=4, seed=suite_seed, max_depth=4)
    assert max(asked_for(loaded("cornell_unit"), settings, np.zeros_like).values()) > 1
