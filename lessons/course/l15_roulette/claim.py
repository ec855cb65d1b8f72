"""Russian roulette in the furnace: the mean stays, rays fall and variance grows with the chance to die."""

import numpy as np

RHO = 0.5  # albedo of the furnace's walls, which shine with radiance 1
DARKER = 0.7  # albedo of the question's walls
SPP = 4096
USUAL, LOW, HALF = 0.8, 0.2, 0.5


def experiment(run):
    """Rays, means and spreads for several chances to go on."""
    values = {"rho": RHO, "true": 1.0 / (1.0 - RHO), "usual": USUAL, "low": LOW, "half": HALF}
    for percent in (95, 80, 50):
        q = percent / 100.0
        samples, rays = played(run, q)
        known = np.sqrt(known_variance(RHO, q))
        assert abs(samples.mean() - 2.0) < 5.0 * known / np.sqrt(SPP)
        assert abs(samples.std() / known - 1.0) < 0.15
        assert abs(rays * (1.0 - q) - 1.0) < 0.1
        values |= {f"rays_{percent}": rays, f"spread_{percent}": known, f"cost_{percent}": known**2 * rays}
    assert known_variance(RHO, LOW) == np.inf

    few, rays = played(run, LOW)
    box, low_box = (run.wave(m, spp=SPP).radiance[1].astype(float) for m in ("box", "low_box"))
    assert abs(run.wave("unpaid", spp=SPP).radiance[1].mean() - 1.0 / (1.0 - RHO * USUAL)) < 0.02
    return values | {
        "rays_20": rays,
        "dead": float((few == 1.0).mean()),
        "largest": float(few.max()),
        "survivor": RHO / LOW,
        "box_mean": box.mean(),
        "box_largest": float(low_box.max()),
        "box_times": (low_box.std() / box.std()) ** 2,
        "unpaid": 1.0 / (1.0 - RHO * USUAL),
        "unpaid_most": 1.0 / (1.0 - RHO),
        "paid_most": 1.0 / (1.0 - RHO / USUAL),
        "darker": DARKER,
        "least": DARKER**2,
        "albedo": DARKER,
        "lost": 1.0 - DARKER,
        "root": np.sqrt(DARKER),
    }


def played(run, q):
    """Radiance of each sample, green channel, and rays for a path."""
    wave = run.wave("start", spp=SPP, roulette=str(q))
    return wave.radiance[1].astype(float), wave.rays / SPP


def known_variance(rho, q):
    """Variance of the sum of (rho / q)^k up to a bounce K with P(K >= k) = q^k: what a path of the furnace is
    worth."""
    if rho * rho >= q:
        return np.inf
    alone = 1.0 / (1.0 - rho * rho / q)  # of the squares (rho / q)^2k
    if rho == q:
        pairs = 2.0 * rho / (1.0 - rho) ** 2
    else:
        pairs = 2.0 / (rho / q - 1.0) * (alone - 1.0 / (1.0 - rho))
    return alone + pairs - 1.0 / (1.0 - rho) ** 2


def would_have_ended(run, path):
    """Whether a path passes its first roulette, but would not if only half of the paths went on."""
    at = run.lesson.moments["start"]
    events = run.pixel(at.x, at.y).paths[path].events
    u = next(float(e.values["u"]) for e in events if e.kind.name == "roulette")
    return HALF <= u < USUAL
