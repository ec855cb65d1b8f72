"""Finds the generating vector of `tracer.sampler.lattice`: python tests/lattice.py prints it.

A lattice with a random shift has the variance sum |c(h)|^2 over the frequencies h that it takes for 0 (its
dual lattice). Jumps make |c(h)|^2 fall as prod h^-2; that sum is then the mean over points of prod w(x_j),

    w(x) = sum over h != 0 of exp(2 pi i h x) / h^2 = 2 pi^2 (x^2 - x + 1/6)     (Sloan and Joe 1994),

over the coordinates j that a frequency has. Component by component (Cools et al. 2006) the next one is taken
so that the sum is small for all groups of up to four coordinates and for 4, 8, ..., 2^12 points alike; up to
2^20 points its further bits are then chosen one by one. Which groups count is what a path tracer multiplies:
film, lens, and bounces up to a vertex, with that vertex's light sample; two light samples never.
"""

import numpy as np

DEPTHS = 8  # vertices with components of their own
SEARCHED, EXTENDED = 12, 20  # log2 of the number of points
GROUP = 4  # coordinates in the largest groups
QUARTER = 0.25  # of the components are good enough within a use
LOBE, ROULETTE = 0.5, 0.3  # weights beside 1 for film and directions


def kernel(m):
    """w at the multiples of 2^-m."""
    x = np.arange(2**m) / 2**m
    return 2.0 * np.pi**2 * (x * x - x + 1.0 / 6.0)


class Chain:
    """Sums over groups of coordinates: sums[l, k] is that of prod w(x_j) at point k over all groups of l."""

    def __init__(self, m, sums=None):
        self.m, self.kernel = m, kernel(m)
        self.sums = np.zeros((GROUP, 2**m)) if sums is None else sums
        if sums is None:
            self.sums[0] = 1.0

    def copy(self):
        return Chain(self.m, self.sums.copy())

    def add(self, component, weight=1.0):
        w = weight * self.values(np.array([component]))[0]
        for size in range(GROUP - 1, 0, -1):
            self.sums[size] += self.sums[size - 1] * w

    def values(self, components):
        """w (len(components), 2^m) of the coordinates they would give the points."""
        return self.kernel[(components[:, None] * np.arange(2**self.m)) % 2**self.m]

    def scores(self, components):
        """For each component: errors of its groups of 2, 3 and 4, each in units of all components' median."""
        errors = self.values(components) @ self.sums[1:].T / 2**self.m
        scale = np.median(errors, axis=0)
        return (errors / np.where(scale > 0.0, scale, 1.0)).sum(axis=1)


def grown(chains, choose, depths):
    """{(use, depth, place): component} of so many depths, each chosen by choose(key, met, own): chains with
    what it meets, and with those of its own use."""
    chosen = {}

    def of(use, depth, places):
        """Choose a use's coordinates; they meet one another and what the chains hold."""
        met, own = [chain.copy() for chain in chains], [Chain(chain.m) for chain in chains]
        for place in places:
            chosen[use, depth, place] = component = choose((use, depth, place), met, own)
            for chain in (*met, *own):
                chain.add(component)

    def go_on(use, depth, weights):
        """What comes later meets these coordinates."""
        for place, weight in weights.items():
            for chain in chains:
                chain.add(chosen[use, depth, place], weight)

    of("film", 0, (0, 1))
    go_on("film", 0, {0: 1.0, 1: 1.0})
    for depth in range(depths):
        for use in ("bsdf", "light"):
            of(use, depth, (1, 2, 0))
        of("roulette", depth, (0,))
        go_on("bsdf", depth, {1: 1.0, 2: 1.0, 0: LOBE})
        if depth == 0:
            of("lens", 0, (0, 1))
        go_on("roulette", depth, {0: ROULETTE})
    return chosen


def searched(depths=DEPTHS):
    """Components below 2^SEARCHED, all odd, none equal to or mirrored by another, for up to that many points.

    Each is the best of the quarter that does best within its own use. The first depths' do not hang on how
    many there are.
    """
    all_of, used = np.arange(1, 2**SEARCHED, 2), []

    def score(chains):
        total = np.zeros(all_of.size)
        for chain in chains:
            total += chain.scores(np.arange(1, 2**chain.m, 2))[(all_of % 2**chain.m) // 2]
        return total

    def choose(key, met, own):
        free, within = ~np.isin(all_of, used), score(own)
        good = free & (within <= np.quantile(within[free], QUARTER))
        best = int(all_of[good][np.argmin(score(met)[good])])
        used.extend((best, 2**SEARCHED - best))
        return best

    return grown([Chain(m) for m in range(2, SEARCHED + 1)], choose, depths)


def extended(components):
    """The same with further bits, so that up to 2^EXTENDED points are spread as well."""
    depths = 1 + max(depth for _, depth, _ in components)
    for m in range(SEARCHED + 1, EXTENDED + 1):
        known = components

        def choose(key, met, own, known=known, m=m):
            pair = known[key] + np.array([0, 2 ** (m - 1)])
            return int(pair[np.argmin(met[0].scores(pair))])

        components = grown([Chain(m)], choose, depths)
    return components


if __name__ == "__main__":
    found = extended(searched())
    for use in ("film", "lens"):
        print(f"{use}: {[found[use, 0, j] for j in (0, 1)]}")
    for depth in range(DEPTHS):
        print(
            [found[use, depth, j] for use in ("light", "bsdf") for j in range(3)]
            + [found["roulette", depth, 0]]
        )
