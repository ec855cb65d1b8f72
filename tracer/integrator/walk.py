"""The rendering equation and nothing else: follow each surface's choice until a light is hit.

    Lo(p, wo) = Le(p, wo) + integral of f(p, wo, wi) Li(p, wi) |cos theta| dwi      (Kajiya 1986)

The integral is estimated by one direction wi drawn from the BSDF, and Li there by the same equation.
"""

from tracer.integrator.stages import go_on, hit_event, refuse_unmeetable


def walk(scene, settings, wave):
    """Events of a wave of paths, stage by stage."""
    refuse_unmeetable(scene, "walk")
    paths = yield from wave.begin(scene)
    while paths.lane.size:
        paths, hit = yield from wave.meet(scene, paths, "bsdf")

        # Le: the surface itself shines
        lit = wave.steps.shining(scene, hit)
        Le, pdf_light = wave.steps.emission(scene, hit, paths.vertex, lit)
        w = wave.steps.emission_weight(settings, "bsdf", paths.pdf_bsdf[lit], pdf_light)
        contribution = paths.beta[:, lit] * Le * w
        paths = paths.gain(contribution, lit)
        yield hit_event(paths, hit, lit, Le=Le, pdf_light=pdf_light, w=w, contribution=contribution)

        # Vertices that nothing can be added to
        paths, hit = yield from wave.stop(paths, paths.depth >= settings.last_depth, "max_depth", hit)
        frame = wave.steps.frame(scene, hit)
        wo = frame.to_local(hit.wo)
        dark = ~scene.bsdf.reflects(hit.bsdf, wo)
        paths, hit, wo, frame = yield from wave.stop(paths, dark, "black", hit, wo, frame)

        # f Li |cos| / p: go where the BSDF chooses
        paths = yield from go_on(scene, wave, paths, hit, frame, wo)
