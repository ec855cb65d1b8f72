"""Samplers side by side, as castray's was chosen: python tests/samplers.py --scenes cornell_unit --spp 16 64

The MSE of a picture is the variance of its pixels between seeds, which needs no reference as no sampler is
biased. Time is processor time of whole renders, by turns. Beside castray's two:

- padded Sobol, Owen: each use of each vertex has the two-dimensional Sobol sequence for itself, shuffled and
  scrambled by hashing (Burley 2020; the hash is that of Vegdahl 2021). The usual choice.
- padded Sobol, xor: the same, scrambled by a digital shift only.
- padded lattice: two-dimensional lattices for each use and vertex, shuffled and shifted.
- multijitter: correlated multi-jittered samples (Kensler 2013), Mitsuba's best. They depend on the number of
  samples, which castray's may not; for comparison only.
"""

import argparse
import statistics
import time
from collections import defaultdict
from dataclasses import dataclass
from math import isqrt
from unittest.mock import patch

import numpy as np

import tracer
from tracer import sampler
from tracer.sampler.lattice import radical_inverse
from tracer.sampler.numbers import USES, dimension, pcg4d, uniform
from tracer.settings import Settings
from tracer.testing.errors import SMALL
from tracer.testing.machine import kernel_seconds

U = np.uint32
DEPTH = 8  # longest path


def owen(word, seed):
    """Nested uniform scrambling of words whose bits are in reverse (Vegdahl 2021)."""
    word = word ^ (word * U(0x3D20ADEA))
    word = (word + seed) * ((seed >> U(16)) | U(1))
    word = word ^ (word * U(0x05526C56))
    return word ^ (word * U(0x53A22864))


def pascal(x):
    """The second coordinate of Sobol's sequence from the first: Pascal's triangle modulo 2."""
    for shift, mask in ((16, 0xFFFF0000), (8, 0xFF00FF00), (4, 0xF0F0F0F0), (2, 0xCCCCCCCC), (1, 0xAAAAAAAA)):
        x = x ^ ((x << U(shift)) & U(mask))
    return x


@dataclass(frozen=True)
class Padded:
    """Each use of each vertex has a sequence for itself. Of three numbers the first is apart."""

    seed: int
    dtype: type
    spp: int

    def __call__(self, pixel, sample, depth, use):
        key = pixel, dimension(depth, use), np.full(1, self.seed, U)
        first, second = pcg4d(*key, np.zeros(1, U)), pcg4d(*key, np.ones(1, U))
        pair = self.pair(sample, *first)
        words = {1: pair[:1], 2: pair}.get(USES[use]) or (self.pair(sample, *second)[0], *pair)
        return uniform(words, self.dtype)


class SobolOwen(Padded):
    def pair(self, sample, a, b, c, _):
        x = owen(radical_inverse(sample), c)
        return tuple(radical_inverse(owen(radical_inverse(w), s)) for w, s in ((x, a), (pascal(x), b)))


class SobolXor(Padded):
    def pair(self, sample, a, b, c, _):
        x = owen(radical_inverse(sample), c)
        return x ^ a, pascal(x) ^ b


class PaddedLattice(Padded):
    def pair(self, sample, a, b, c, _):
        x = owen(radical_inverse(sample), c)
        return x + a, x * U(sampler.lattice.COMPONENTS["film"][1, 0]) + b


class Multijitter(Padded):
    def pair(self, sample, a, b, c, d):
        n, m = self.spp, isqrt(self.spp)
        rows = n // m
        assert m * rows == n, f"{n} samples are not multijittered here"
        jitter = pcg4d(a ^ sample, b, c, d)
        place = shuffled(sample, n, c)
        x, y = place % U(m), place // U(m)
        across = x + (shuffled(y, rows, a) + jitter[0] * 2.0**-32) / rows
        down = y + (shuffled(x, m, b) + jitter[1] * 2.0**-32) / m
        return (across * (2.0**32 / m)).astype(U), (down * (2.0**32 / rows)).astype(U)


def shuffled(number, n, seed):
    """Numbers below n, a power of 2, in an order that seed decides: a bijection of their bits."""
    mask = U(n - 1)
    for k in range(4):
        number = (number * (seed >> U(k) | U(1)) + (seed >> U(8 + k))) & mask
        number = number ^ (number >> U(max(n.bit_length() // 2, 1)))
    return number


SAMPLERS = {
    "independent": sampler.Independent,
    "lattice": sampler.Lattice,
    "padded Sobol, Owen": SobolOwen,
    "padded Sobol, xor": SobolXor,
    "padded lattice": PaddedLattice,
    "multijitter": Multijitter,
}


def made(kind, settings):
    """The sampler of a kind for some settings."""
    more = (settings.spp,) if issubclass(kind, Padded) else ()
    return kind(settings.seed, settings.dtype, *more)


def measured(scene, names, side, spp, seeds, say=lambda line: None):
    """{name: (MSE, relMSE, processor seconds of a picture)}, and the kernel's milliseconds."""
    height = max(1, round(side * scene.height / scene.width))
    rgb, seconds, kernels = defaultdict(list), defaultdict(list), []
    for seed in range(seeds):
        settings = Settings(width=side, height=height, spp=spp, max_depth=DEPTH, seed=seed)
        kernels.append(kernel_seconds())
        for name in names:
            say(f"{scene.name}, {spp} spp, {name}: {seed + 1} of {seeds}")
            with patch("tracer.sampler.of", lambda s, name=name: made(SAMPLERS[name], s)):
                began = time.process_time()
                picture = tracer.render(scene, settings)
                seconds[name].append(time.process_time() - began)
            rgb[name].append(picture.rgb.astype(np.float64))
    found = {}
    for name in names:
        variance, mean = np.var(rgb[name], axis=0, ddof=1), np.mean(rgb[name], axis=0)
        relative = (variance / (mean * mean + SMALL)).mean()
        found[name] = float(variance.mean()), float(relative), statistics.median(seconds[name])
    return found, 1e3 * statistics.median(kernels)


def rows(scene, names, side, spps, seeds, say=lambda line: None):
    """The rows of a table; the last columns are in units of those of `independent`."""
    for spp in spps:
        found, kernel = measured(scene, names, side, spp, seeds, say)
        base = found["independent"]
        for name in names:
            mse, relative, seconds = (v / b for v, b in zip(found[name], base, strict=True))
            yield {
                "scene": scene.name,
                "sampler": name,
                "spp": spp,
                "MSE": f"{found[name][0]:.3g}",
                "relMSE": f"{found[name][1]:.3g}",
                "s": f"{found[name][2]:.3g}",
                "kernel ms": f"{kernel:.2f}",
                "MSE ratio": f"{mse:.3f}",
                "relMSE ratio": f"{relative:.3f}",
                "time ratio": f"{seconds:.2f}",
                "time x MSE": f"{seconds * mse:.3f}",
            }


def main():
    from benchmarks.section import table  # which imports this module

    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--scenes", nargs="+", default=["cornell_unit"])
    words.add_argument("--samplers", nargs="+", default=list(SAMPLERS), choices=SAMPLERS)
    words.add_argument("--side", type=int, default=64, help="pixels across")
    words.add_argument("--spp", type=int, nargs="+", default=[16, 64, 256])
    words.add_argument("--seeds", type=int, default=8)
    asked = words.parse_args()
    names = list(dict.fromkeys(("independent", *asked.samplers)))
    for scene in map(tracer.load, asked.scenes):
        print(table(list(rows(scene, names, asked.side, asked.spp, asked.seeds))), end="\n\n", flush=True)


if __name__ == "__main__":
    main()
