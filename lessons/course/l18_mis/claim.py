"""Two ways to find a lamp, alone and weighted: spreads, weights, and what weights that do not sum to 1 do."""

import numpy as np

from tracer.integrator.steps import mis_weight

SPP = 4096


def experiment(run):
    """Spreads relative to the mean in two pixels, and weights of one bounce."""
    values = {}
    for place in ("start", "rough"):
        spreads = {s: spread(run.wave(place, spp=SPP, strategy=s)) for s in ("light", "bsdf", "mis")}
        assert spreads["mis"] < 2.0 * min(spreads.values())
        values |= {f"{place}_{strategy}": found for strategy, found in spreads.items()}
    assert values["start_bsdf"] < values["start_light"] and values["rough_light"] < values["rough_bsdf"]

    tail = run.event("tail")
    by_bounce, by_light = tail["pdf_bsdf"], tail["pdf_light"]
    assert np.isclose(mis_weight(run.settings(), by_bounce, by_light), tail["w"], rtol=1e-4)

    right, wrong = (run.wave(m, spp=SPP).radiance[1].astype(float) for m in ("start", "mistake"))
    assert wrong.mean() > 1.5 * right.mean()
    return values | {
        "full": tail["contribution"][1] / tail["w"],
        "balance": by_bounce / (by_bounce + by_light),
        "power": tail["w"],
        "of_the_other": by_light / (by_bounce + by_light),
        "ratio": by_bounce / by_light,
        "other_weight": 1.0 - run.event("lucky")["w"],
        "mean": right.mean(),
        "wrong_mean": wrong.mean(),
    }


def spread(wave):
    """Standard deviation of the samples over their mean, green channel."""
    samples = wave.radiance[1].astype(float)
    return samples.std() / samples.mean()


def counts_little(run, path):
    """Whether a path meets the lamp by bouncing, with less than half of the weight."""
    at = run.lesson.moments["start"]
    hits = [e for e in run.pixel(at.x, at.y).paths[path].events[2:] if e.kind.name == "hit"]
    return any(e.values["Le"][1] > 0.0 and e.values["w"] < 0.5 for e in hits)
