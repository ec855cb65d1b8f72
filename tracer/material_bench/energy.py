"""What a material sends on of the light that comes from one direction.

Energy is what is counted on the far side of glass too: radiance there is the square of the index times as
much.
"""

import numpy as np

from tracer.frame import same_side


def towards(degrees, n=1, turn=0.7):
    """n copies (3, n) of the direction so many degrees from the normal; beyond 90 it is below."""
    theta = np.radians(degrees)
    w = np.array([np.sin(theta) * np.cos(turn), np.sin(theta) * np.sin(turn), np.cos(theta)])
    return np.repeat(w[:, None], n, axis=1)


def sides(material):
    """The sides to look from: 1 above, -1 below where the material scatters there too."""
    return (1,) if material.one_sided else (1, -1)


def weights(material, wo, seed=0, even=False):
    """(reflected, transmitted) energy of each sample, two (3, N), and the Sample itself.

    even: the numbers that choose the lobe are spread evenly, for quieter means; not for tests of chance.
    """
    u = np.random.default_rng(seed).random((3, wo.shape[1]))
    if even:
        u[0] = (np.arange(wo.shape[1]) + u[0]) / wo.shape[1]
    sample = material.sample(wo, u)
    cos = np.where(sample.delta, 1.0, np.abs(sample.wi[2]))
    weight = sample.f * (cos / np.where(sample.pdf > 0.0, sample.pdf, np.inf))
    weight = weight * energy(material, wo, sample.wi)
    back = same_side(wo, sample.wi)
    return weight * back, weight * ~back, sample


def albedo(material, degrees, n=20_000, seed=0):
    """Share of the light that is reflected and transmitted, (3, K) each, and the standard error of their sum
    (3, K), for directions wo so many degrees from the normal."""
    reflected, transmitted, error = (np.empty((3, len(degrees))) for _ in range(3))
    for k, angle in enumerate(degrees):
        back, across, _ = weights(material, towards(angle, n), seed + k, even=True)
        reflected[:, k], transmitted[:, k] = back.mean(axis=1), across.mean(axis=1)
        error[:, k] = (back + across).std(axis=1) / np.sqrt(n)
    return reflected, transmitted, error


def energy(material, wo, wi):
    """What makes energy of radiance: the squared index across, where the light went across."""
    inside = material.explain(wo, wi).get("eta")
    return 1.0 if inside is None else np.where(same_side(wo, wi), 1.0, inside * inside)
