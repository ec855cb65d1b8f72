"""Path tracing with light samples and multiple importance sampling.

The rendering equation (Kajiya 1986), term by term, for every path of the wave at once:

    Lo(p, wo) = Le(p, wo) + integral of f(p, wo, wi) Li(p, wi) |cos theta| dwi

Li from lights is estimated both by sampling a light and by bouncing into it, weighted so that each light
path counts once (Veach 1997, 9.2); settings.strategy keeps only one of the two.
"""

import numpy as np

from tracer.events import BOUNCE, ESCAPE, HIT, LIGHT, ROULETTE
from tracer.frame import Frame, cos_theta


def path(scene, settings, wave):
    """Events of a wave of paths, stage by stage."""
    steps, random, strategy = wave.steps, wave.random, settings.strategy
    paths, event = wave.begin(scene)
    yield event
    while paths.lane.size:
        if settings.last_depth < 0:
            yield wave.end(paths, "max_depth")
            return
        t, primitive = scene.intersect(paths.o, paths.d, paths.source)
        wave.rays += t.size

        # Nothing there: the ray leaves the scene
        met = primitive >= 0
        if not met.all():
            lost = paths.take(np.flatnonzero(~met))
            dark = np.zeros_like(lost.beta)
            yield ESCAPE(
                lost.lane, lost.depth, d=lost.d, Le=dark, pdf_light=dark[0], w=1 + dark[0], contribution=dark
            )
            yield wave.end(lost, "escaped")
            met = np.flatnonzero(met)
            paths, t, primitive = paths.take(met), t[met], primitive[met]
        hit = scene.hit(paths.o, paths.d, t, primitive)

        # Le: the surface itself shines
        Le, pdf_light = scene.emission(hit)
        w = steps.emission_weight(settings, strategy, paths.pdf_bsdf, pdf_light)
        contribution = paths.beta * Le * w
        paths = paths._replace(L=paths.L + contribution)
        yield HIT(
            paths.lane, paths.depth, p=hit.p, t=hit.t, primitive=hit.primitive, ng=hit.ng, n=hit.n, wo=hit.wo,
            front=hit.front, beta=paths.beta, Le=Le, pdf_bsdf=paths.pdf_bsdf, pdf_light=pdf_light, w=w,
            contribution=contribution,
        )  # fmt: skip
