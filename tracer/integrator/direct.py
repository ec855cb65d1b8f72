"""Direct light by sampling the lights, indirect light by bouncing: the first estimator that works in a room.

    Lo(p, wo) = Le(p, wo) + sum over lights of f Le V |cos| / p_light + integral over the rest

The first sum holds all the light that arrives straight from a lamp. A bounce that finds a lamp must not add
it again: emission counts only where no light sample could have been made, from the camera and after a
Dirac lobe.
"""

from tracer.integrator.stages import add_light, go_on, hit_event, sample_lights, stop_counted


def direct(scene, settings, wave):
    """Events of a wave of paths, stage by stage."""
    steps = wave.steps
    paths = yield from wave.begin(scene)
    while paths.lane.size:
        paths, hit = yield from wave.meet(scene, paths, "light")

        # Le: the surface itself shines, and no light sample has counted it yet
        lit = steps.shining(scene, hit)
        Le, pdf_light = steps.emission(scene, hit, paths.vertex, lit)
        w = steps.emission_weight(settings, "light", paths.pdf_bsdf[lit], pdf_light)
        contribution = paths.beta[:, lit] * Le * w
        paths = paths.gain(contribution, lit)
        yield hit_event(paths, hit, lit, Le=Le, pdf_light=pdf_light, w=w, contribution=contribution)

        # Vertices that nothing can be added to
        paths, hit = yield from wave.stop(paths, paths.depth >= settings.last_depth, "max_depth", hit)
        frame = steps.frame(scene, hit)
        wo = frame.to_local(hit.wo)
        dark = ~scene.bsdf.reflects(hit.bsdf, wo)
        paths, hit, wo, frame = yield from wave.stop(paths, dark, "black", hit, wo, frame)

        # Direct light: f Le V |cos| / p_light from one point on a light
        sampled = sample_lights(scene, wave, paths, hit, frame, wo)
        if sampled:
            w = steps.light_weight(settings, "light", sampled.light.pdf, sampled.pdf_bsdf)
            paths = yield from add_light(scene, wave, paths, hit, sampled, w)
        paths, hit, wo, frame = yield from stop_counted(scene, wave, paths, hit, wo, frame)

        # Indirect light: go where the BSDF chooses
        paths = yield from go_on(scene, wave, paths, hit, frame, wo)
