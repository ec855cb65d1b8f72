"""What the tests of rough surfaces share."""

import numpy as np

from tracer.bsdf.microfacet import Facets


def facets(kind, alpha_u, alpha_v, dtype=np.float64):
    return Facets(kind, np.array([alpha_u], dtype), np.array([alpha_v], dtype))


def direction(mu, n=1, dtype=np.float64, phi=0.7):
    """n copies of a direction with cosine mu."""
    r = np.sqrt((1.0 - mu) * (1.0 + mu))
    return np.repeat(np.array([[r * np.cos(phi)], [r * np.sin(phi)], [mu]]).astype(dtype), n, axis=1)


def numbers(seed, n, dtype):
    """(2, n) uniform numbers as the sampler gives them."""
    bits = 24 if dtype == np.float32 else 32
    return (np.random.default_rng(seed).integers(0, 2**bits, (2, n)) * 2.0**-bits).astype(dtype)
