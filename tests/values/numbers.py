"""Statistics, rounding, maps from the unit square, and rays through balls and corners."""

from types import SimpleNamespace

import lamps
import numpy as np
from rough import numbers

import tracer
from tracer import Settings, film, tails, warp
from tracer.bsdf import Dielectric
from tracer.frame import Frame, dot, normalize
from tracer.integrator.steps import mis_weight
from tracer.shape.rays import Rays
from tracer.shape.sphere import Sphere
from values.registry import DTYPES, bound, estimator, kernel, refuted

FILM = "the film adds up in float64, whatever the precision of the paths"
TAILS = "p-values are float64, whatever the precision of the paths"


@kernel("bernoulli.var.", only=64, why=FILM)
def hit_or_miss(key, given, to):
    """Spread of a block of samples, a share p of which is 1, per sample."""
    samples = np.zeros((1, 1, film.BLOCK))
    samples[..., : round(given["p"] * film.BLOCK)] = 1.0
    block = film.block(samples)
    return block.spread[0, 0] / block.samples


@kernel("float.tiny32")
def least_variance(key, given, to):
    """A variance that is not 0 is kept as at least the smallest normal number."""
    return film.gather(np.array([[0.0, 1e-30]] * 3)).variance()[0, 0]


@refuted("accum.naive.", only=64, why=FILM)
def variance_of_large_numbers(key, given, to):
    """Of the four large numbers that the naive formula fails at; 30, by Welford."""
    return film.block(1e9 + np.array([[[4.0, 7.0, 13.0, 16.0]]])).spread[0, 0] / 3.0


@bound("gamma3.", only=32, why="a bound for float32")
def rounding_of_products(key, given, to):
    """Largest error of a dot product, over that of its absolute values."""
    a, b = np.random.default_rng(0).normal(size=(2, 3, 200_000)).astype(to.dtype)
    exact = dot(a.astype(np.float64), b.astype(np.float64))
    return (np.abs(dot(a, b) - exact) / dot(np.abs(a).astype(np.float64), np.abs(b).astype(np.float64))).max()


@bound("gamma5.", only=64, why="a bound for float64")
def rounding_of_lengths(key, given, to):
    """How far a normalised vector's component may be off: three and a half roundings (in long double)."""
    a = np.random.default_rng(0).normal(size=(3, 200_000))
    exact = normalize(a.astype(np.longdouble))
    return float(np.abs((normalize(a) - exact) / exact).max())


@kernel("mis.power2.overflow", only=64, why="1e200 is above every float32")
def power_of_large_densities(key, given, to):
    return weight(given, to)


@kernel("mis.power2.underflow", only=64, why="1e-170 is below every float32")
def power_of_small_densities(key, given, to):
    return weight(given, to)


def weight(given, to):
    mine, other = (to([given[p]]) for p in ("p1", "p2"))
    return mis_weight(SimpleNamespace(heuristic="power"), mine, other)[0]


@kernel("stat.sidak.z.", only=64, why=TAILS)
def limit(key, given, to):
    return tails.normal_z(tails.shared(given["family_alpha"], given["n"]))


@kernel("stat.max_abs_z.mean.", only=64, why=TAILS)
def largest_of_many(key, given, to):
    """The mean of the largest |z|: the integral of the chance that it is above z."""
    x, weight = np.polynomial.legendre.leggauss(400)
    z, weight = 5.0 * (x + 1.0), 5.0 * weight
    return (weight * tails.together(tails.normal_p(z), given["n"])).sum()


@kernel("stat.pass_rate.", only=64, why=TAILS)
def within_three(key, given, to):
    return 1.0 - tails.normal_p(3.0)


@estimator("uniform_hemi.", n=200_000)
def mean_height(key, given, bits, seed, n):
    return warp.uniform_hemisphere(numbers(seed, n, DTYPES[bits]))[2]


@estimator("cosine.bin.", n=500_000)
def share_of_heights(key, given, bits, seed, n):
    z = warp.cosine_hemisphere(numbers(seed, n, DTYPES[bits]))[2].astype(np.float64)
    return ((z > (given["k"] - 1) / 5) & (z <= given["k"] / 5)).astype(float)


@kernel("reflect.retro.")
def corner_of_mirrors(key, given, to):
    """How far a path that met three mirrors at right angles is off the way it came, at most."""
    mirror = {"type": "conductor"}
    walls = {}
    for axis in range(3):
        center, u, v = (np.roll(w, axis) for w in ([0.0, 5, 5], [0.0, 5, 0], [0.0, 0, 5]))
        walls[f"mirror{axis}"] = lamps.rectangle(center, u, v, towards=[9, 9, 9]) | {"bsdf": mirror}
        del walls[f"mirror{axis}"]["emitter"]
    sensor = lamps.sensor([3, 4, 5], [1, 0.8, 0.9], side=2)
    scene = tracer.load_dict({"sensor": sensor | {"fov": 4}, **walls})
    settings = Settings(spp=64, precision=to.bits, integrator="walk", max_depth=8)
    off = []
    for path in tracer.inspect(scene, settings, 0, 1).paths:
        ways = [event.values["d"] for event in path.events if event.kind.name in ("camera", "escape")]
        assert len(ways) == 2 and sum(event.kind.name == "hit" for event in path.events) == 3
        off.append(np.abs(ways[0] + ways[1]).max())
    return max(off)


def through_a_ball(n, height, lobes, to):
    """Origin and direction, both (3, 1), of a ray along x at a height over the middle of a glass ball of
    radius 1, after it has met the surface once for each number: 0 to be mirrored, 1 to pass."""
    ball = Sphere("ball", np.zeros(3), 1.0).kernel(0, 1.0, to.dtype)
    ones = np.ones((3, 1), to.dtype)
    glass = Dielectric(to([n]), ones, ones)
    o, d = to([[-2.0], [height], [0.0]]), to([[1.0], [0.0], [0.0]])
    source = -1
    for u in lobes:
        t, _ = ball.closest(Rays.towards(o, d, np.array([source])))
        o = normalize(o + t * d)
        frame, source = Frame.around(o), 0
        number = np.full((3, 1), u * (1.0 - 2.0**-24), to.dtype)
        d = frame.to_world(glass.sample(frame.to_local(-d), number).wi)
    return o, d


@kernel("rainbow.primary.")
def rainbow(key, given, to):
    """In, mirrored once, out: at the height where all neighbours leave the same way."""
    n = float(key.rpartition("n=")[2])
    _, d = through_a_ball(n, np.sqrt((4.0 - n * n) / 3.0), (1, 0, 1), to)
    return 180.0 - np.degrees(np.arctan2(np.abs(d[1, 0]), -d[0, 0]))


@kernel("ball.efl")
def focal_length(key, given, to):
    """Where a ray close to the axis crosses it, seen from the middle; rays 1e-7 off it: no aberration."""
    o, d = through_a_ball(given["n"], 1e-7 * given["D"], (1, 1), to)
    return o[0, 0] - d[0, 0] * o[1, 0] / d[1, 0]
