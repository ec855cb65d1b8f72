"""Path tracing: lights found both ways, by sampling them and by bouncing into them, weighted.

    Lo(p, wo) = Le(p, wo) + sum over lights of w_l f Le V |cos| / p_light + w_b f Li |cos| / p_bsdf

For every light path w_l + w_b = 1 (multiple importance sampling, Veach 1997, 9.2), so that it counts once,
mostly by the technique that is better at it. settings.strategy keeps only one of the two.
"""

from tracer.integrator.stages import (
    add_light,
    go_on,
    hit_event,
    refuse_unmeetable,
    sample_lights,
    stop_counted,
)


def path(scene, settings, wave):
    """Events of a wave of paths, stage by stage."""
    steps, strategy = wave.steps, settings.strategy
    if strategy == "bsdf":
        refuse_unmeetable(scene, "path with strategy bsdf")
    paths = yield from wave.begin(scene)
    while paths.lane.size:
        paths, hit = yield from wave.meet(scene, paths, strategy)

        # Le: the surface itself shines, weighted against a light sample that would have found it
        lit = steps.shining(scene, hit)
        Le, pdf_light = steps.emission(scene, hit, paths.vertex, lit)
        w = steps.emission_weight(settings, strategy, paths.pdf_bsdf[lit], pdf_light)
        contribution = paths.beta[:, lit] * Le * w
        paths = paths.gain(contribution, lit)
        yield hit_event(paths, hit, lit, Le=Le, pdf_light=pdf_light, w=w, contribution=contribution)

        # Vertices that nothing can be added to
        paths, hit = yield from wave.stop(paths, paths.depth >= settings.last_depth, "max_depth", hit)
        frame = steps.frame(scene, hit)
        wo = frame.to_local(hit.wo)
        dark = ~scene.bsdf.reflects(hit.bsdf, wo)
        paths, hit, wo, frame = yield from wave.stop(paths, dark, "black", hit, wo, frame)

        # Direct light: w f Le V |cos| / p_light from one point on a light
        if strategy != "bsdf":
            sampled = sample_lights(scene, wave, paths, hit, frame, wo)
            if sampled:
                w = steps.light_weight(settings, strategy, sampled.light.pdf, sampled.pdf_bsdf)
                paths = yield from add_light(scene, wave, paths, hit, sampled, w)
        if strategy == "light":
            paths, hit, wo, frame = yield from stop_counted(scene, wave, paths, hit, wo, frame)

        # Indirect light: go where the BSDF chooses
        paths = yield from go_on(scene, wave, paths, hit, frame, wo)
