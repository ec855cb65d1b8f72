"""What the loops have in common beside their formulas: events with many columns, shadow rays, roulette."""

from typing import NamedTuple

import numpy as np

from tracer.event import Sparse
from tracer.events import BOUNCE, HIT, LIGHT, ROULETTE, TECHNIQUES
from tracer.frame import cos_theta
from tracer.integrator.steps import RIGHT, any_channel
from tracer.lanes import gather, put
from tracer.settings import TracerError

_DELTA = TECHNIQUES.index("delta")


class Direct(NamedTuple):
    """A light sample at each vertex that can use one, with what the surface makes of it."""

    lanes: np.ndarray | slice  # which of the wave's paths take part
    light: object  # LightSample
    f: np.ndarray  # (3, N) BSDF towards the light
    cos: np.ndarray  # (N,) absolute cosine there
    pdf_bsdf: np.ndarray  # (N,) density of a bounce in the same direction
    u: np.ndarray  # (3, N) the numbers used
    transmittance: np.ndarray | None  # (3, N) share of the light left after the way, None for all of it


def refuse_unmeetable(scene, who):
    """TracerError if bounces alone cannot find one of the lights."""
    if scene.unmeetable:
        raise TracerError(
            f"{who}: no ray ever meets {scene.unmeetable[0]}, a light without size; "
            "use integrator direct, or path with strategy mis or light"
        )


def hit_event(paths, hit, lit, Le, pdf_light, w, contribution):
    """The HIT of paths; Le, pdf_light, w and contribution are of those on lamps only, at places lit (K,)."""
    of_lit = {"Le": Le, "pdf_light": pdf_light, "w": w, "contribution": contribution}
    unlit = {"w": 1.0}
    light = {name: Sparse(lit, few, hit.t.size, unlit.get(name, 0.0)) for name, few in of_lit.items()}
    if paths.transmittance is not None:
        light["transmittance"] = paths.transmittance
    return HIT(
        paths.lane,
        paths.depth,
        p=hit.p,
        t=hit.t,
        primitive=hit.primitive,
        ng=hit.ng,
        n=hit.n,
        wo=hit.wo,
        front=hit.front,
        beta=paths.beta,
        pdf_bsdf=paths.pdf_bsdf,
        **light,
    )


def sample_lights(scene, wave, paths, hit, frame, wo):
    """A light sample at every vertex whose material is not made of Dirac lobes, as a Direct; None if there
    is no such vertex, or no light."""
    if not scene.has_lights or scene.bsdf.all_delta:
        return None
    lanes = slice(None)
    if scene.bsdf.any_delta:
        lanes = np.flatnonzero(~scene.bsdf.is_delta(hit.bsdf))
        if not lanes.size:
            return None
        paths, hit, frame, wo = paths.take(lanes), hit.take(lanes), frame.take(lanes), gather(wo, lanes)
    u = wave.random(paths.pixel, paths.sample, paths.depth, "light")
    light = wave.steps.light_point(scene, hit, u)
    wi = frame.to_local(light.wi)
    f = wave.steps.eval(scene, hit, wo, wi)
    if scene.has_smooth_normals:
        f = f * wave.steps.sides_agree(hit, light.wi)
    pdf_bsdf = wave.steps.pdf(scene, hit, wo, wi)
    if scene.lights.any_delta:  # no bounce meets these lights: their samples are never weighted
        pdf_bsdf = np.where(light.technique == _DELTA, 0.0, pdf_bsdf).astype(f.dtype)
    left = None
    if paths.medium is not None:
        medium = scene.media.towards(hit, light.wi, paths.medium)
        left = wave.steps.transmittance(scene, medium, light.distance)
    return Direct(lanes, light, f, np.abs(cos_theta(wi)), pdf_bsdf, u, left)


def add_light(scene, wave, paths, hit, direct, w):
    """Cast the shadow rays that can carry light and add what arrives; yield the event, return the paths."""
    lanes, light, f, cos, pdf_bsdf, u, left = direct
    beta = paths.beta if isinstance(lanes, slice) else gather(paths.beta, lanes)
    arriving = wave.steps.light_term(beta, f, cos, light, w)
    through = {}
    if left is not None:
        arriving, through = arriving * left, {"transmittance": left}
    bright = any_channel(arriving) & (paths.lane[lanes] >= 0)
    visible = _seen(scene, wave, hit, lanes, light, bright)
    contribution = arriving * visible
    yield LIGHT(
        paths.lane[lanes],
        paths.depth[lanes],
        light=light.light,
        primitive=light.primitive,
        pick=light.pick,
        technique=light.technique,
        q=light.q,
        nq=light.nq,
        wi=light.wi,
        distance=light.distance,
        Le=light.Le,
        visible=visible,
        f=f,
        cos=cos,
        pdf=light.pdf,
        pdf_bsdf=pdf_bsdf,
        w=w,
        beta=beta,
        u=u,
        contribution=contribution,
        **through,
    )
    return paths.gain(contribution, lanes)


def stop_counted(scene, wave, paths, *columns):
    """Yield the end of the paths whose next vertex could add nothing but its own emission, where light
    samples count that already; return the others, and their columns."""
    if scene.bsdf.any_delta or wave.steps.emission_weight is not RIGHT.emission_weight:
        return paths, *columns
    last = paths.depth + 1 >= wave.settings.last_depth
    return (yield from wave.stop(paths, last, "max_depth", *columns))


def _seen(scene, wave, hit, lanes, light, bright):
    """Whether each light sample is seen, (N,); asked only where `bright` (N,): elsewhere nothing arrives."""
    rays = int(np.count_nonzero(bright))
    wave.rays += rays
    if not rays:
        return bright
    if 2 * rays > bright.size and isinstance(lanes, slice):  # to pick them out costs more than to ask for all
        return wave.steps.visibility(scene, hit, light) & bright
    asked = np.flatnonzero(bright)
    of_wave = asked if isinstance(lanes, slice) else lanes[asked]
    visible = np.zeros(bright.shape, bool)
    visible[asked] = wave.steps.visibility(scene, hit.take(of_wave), light.take(asked))
    return visible


def bounce_event(paths, sample, wi, cos, u, beta):
    """The BOUNCE of paths; wi is the new direction in world space, beta the throughput after it."""
    return BOUNCE(
        paths.lane,
        paths.depth,
        lobe=sample.lobe,
        wi=wi,
        f=sample.f,
        cos=cos,
        pdf=sample.pdf,
        delta=sample.delta,
        u=u,
        beta_before=paths.beta,
        beta=beta,
    )


def go_on(scene, wave, paths, hit, frame, wo):
    """Choose where each path goes on: bounce, roulette, next ray. Yield the events, return the paths."""
    steps, settings = wave.steps, wave.settings
    u = wave.random(paths.pixel, paths.sample, paths.depth, "bsdf")
    sample = steps.bounce(scene, hit, wo, u)
    wi = frame.to_world(sample.wi)
    if scene.has_smooth_normals:
        sample = sample._replace(f=sample.f * steps.sides_agree(hit, wi))
    cos = np.abs(cos_theta(sample.wi))
    nowhere = ~steps.carries(sample)
    if paths.medium is not None:
        nowhere |= ~any_channel(paths.beta)  # nothing got through to here
    paths, hit, wi, sample, cos, u = yield from wave.stop(paths, nowhere, "absorbed", hit, wi, sample, cos, u)
    beta = steps.throughput(paths.beta, sample, cos)
    yield bounce_event(paths, sample, wi, cos, u, beta)
    pdf = np.where(sample.delta, np.inf, sample.pdf).astype(beta.dtype) if sample.delta.any() else sample.pdf
    paths = paths._replace(beta=beta, pdf_bsdf=pdf)
    q = steps.survival(settings, beta, paths.depth)
    played = np.flatnonzero(q < 1.0)
    if played.size:
        paths, hit, wi = yield from _play(wave, paths, hit, wi, q, played)
    o, d = steps.next_ray(scene, hit, wi)
    if paths.medium is not None:
        paths = paths._replace(medium=scene.media.towards(hit, d, paths.medium))
    return paths._replace(depth=paths.depth + 1, o=o, d=d, vertex=hit.p, source=hit.primitive)


def _play(wave, paths, hit, wi, q, played):
    """Russian roulette for the lanes `played`; yield its events, return what survives."""
    everyone = played.size == q.size
    at_stake = paths if everyone else paths.take(played)
    u = wave.random(at_stake.pixel, at_stake.sample, at_stake.depth, "roulette")[0]
    q = q if everyone else q[played]
    survived, beta = wave.steps.roulette(at_stake.beta, q, u)
    yield ROULETTE(at_stake.lane, at_stake.depth, probability=q, u=u, survived=survived, beta=beta)
    alive, after = survived, beta
    if not everyone:
        after, alive = paths.beta.copy(), np.ones(paths.lane.shape, bool)
        put(after, played, beta)
        alive[played] = survived
    paths = paths._replace(beta=after)
    return (yield from wave.stop(paths, ~alive, "roulette", hit, wi))
