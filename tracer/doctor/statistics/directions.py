"""Bounces: whether directions come as often as their density says."""

import numpy as np

from tracer.bsdf import Diffuse
from tracer.doctor.statistics.cells import FEWEST, Cell, balanced, same, share, square, uniform
from tracer.doctor.statistics.lamps import _single
from tracer.doctor.statistics.numbers import NEVER_ABSORB
from tracer.events import END_REASONS

_WANTING = [END_REASONS.index(reason) for reason in ("absorbed", "invalid")]
_SEED = 20250  # of the reference's own numbers


def hemisphere(evidence, rows):
    """Local directions (3, N) of BOUNCEs, and the two numbers (N,) that are uniform if they are right."""
    scene = evidence.scene
    n, p, wi = (
        (evidence.at_vertex("bounce", name)[:, rows] for name in ("n", "p")),
        None,
        evidence("bounce.wi")[:, rows],
    )
    n, p = n
    local = scene.frame(n, p, evidence.at_vertex("bounce", "primitive")[rows]).to_local(wi)
    z = local[2]
    height = 1.0 - z * z if evidence.settings.hemisphere == "cosine" else 1.0 - z
    return local, height, np.arctan2(local[1], local[0]) / (2.0 * np.pi) % 1.0


def diffuse(evidence):
    """I1: directions from diffuse surfaces, of the hemisphere that is declared."""
    scene = evidence.scene
    if scene.has_smooth_normals:
        return
    kinds = np.array([isinstance(m, Diffuse) for m in scene.definition.bsdfs.values()])
    good = kinds.take(evidence.materials("bounce")) & evidence.sound("bounce", "wi")
    rows = _single(evidence, "bounce", np.flatnonzero(good))
    if rows.size < FEWEST:
        return
    local, a, b = hemisphere(evidence, rows)
    facts = {"local": local}
    yield Cell(uniform(a), "the height of directions from diffuse surfaces", "bounce", rows, facts)
    yield Cell(uniform(b), "the azimuth of directions from diffuse surfaces", "bounce", rows, facts)
    p = square(a, b)
    if p is not None:
        yield Cell(p, "directions from diffuse surfaces", "bounce", rows, facts)


def others(evidence):
    """I1: directions from other surfaces, against those of the scene's own sampler with fresh numbers."""
    scene = evidence.scene
    materials = list(scene.definition.bsdfs.values())
    which = evidence.materials("bounce")
    good = evidence.sound("bounce", "wi")
    names = scene.bsdf_names
    for number in np.unique(which):
        if isinstance(materials[number], Diffuse) and not scene.has_smooth_normals:
            continue
        rows = _single(evidence, "bounce", np.flatnonzero((which == number) & good))
        if rows.size >= FEWEST:
            yield from _beside(evidence, rows, number, names[number])
        if scene.has_smooth_normals or not isinstance(materials[number], NEVER_ABSORB):
            yield from _led_on(evidence, number, names[number])


def _reference(evidence, vertex, number, seed):
    """What the scene's own sampler does at vertices with fresh numbers: its samples, whether they carry
    anything (N,), the frame and the local wo."""
    scene = evidence.scene
    frame = scene.frame(vertex["n"], vertex["p"], vertex["primitive"])
    wo = frame.to_local(vertex["wo"])
    u = np.random.Generator(np.random.PCG64([_SEED, int(number), *seed])).random((3, wo.shape[1]))
    texture = scene.painted(vertex["p"], vertex["primitive"])
    sample = scene.bsdf.sample(np.full(wo.shape[1], number), wo, u, texture)
    carries = (sample.pdf > 0.0) & (sample.f > 0.0).any(axis=0)
    if scene.has_smooth_normals:
        ng = evidence.brute.normals(vertex["p"], vertex["primitive"])
        world = frame.to_world(sample.wi)
        carries &= ((vertex["n"] * world).sum(axis=0) * (ng * world).sum(axis=0)) > 0.0
    return sample, carries, frame, wo


def _led_on(evidence, number, name):
    """How often a direction leads on, and how often the path ends for want of one: facets send some into the
    surface. Where an end's reason is the tracer's own word alone."""
    if not evidence.has("end.reason") or "end.reason" in evidence.trace.rebuilt:
        return
    hits = np.arange(evidence.count("hit"))
    bounce, end = evidence.after("hit", "bounce"), evidence.after("hit", "end")
    on = (bounce >= 0) & (evidence.before("bounce", "hit").take(bounce, mode="clip") == hits)
    over = (end >= 0) & (evidence.before("end", "hit").take(end, mode="clip") == hits) & ~on
    over &= np.isin(evidence("end.reason").take(end, mode="clip"), _WANTING)
    here = evidence.scene.bsdf_of.take(evidence("hit.primitive")) == number
    good = evidence.is_unit("hit.n") & evidence.is_unit("hit.wo")
    if evidence.has("hit.beta"):
        good &= (evidence("hit.beta") > 0.0).any(axis=0)
    rows = _single(evidence, "hit", np.flatnonzero((on | over) & here & good))
    if rows.size < FEWEST:
        return
    vertex = {k: evidence(f"hit.{k}")[..., rows] for k in ("n", "p", "wo", "primitive")}
    _, carries, _, wo = _reference(evidence, vertex, number, (1,))
    differ = (on[rows].astype(float) - carries) * (np.abs(wo[2]) > 64.0 * evidence.off_unit)
    yield Cell(balanced(differ), f"how often directions from {name} lead on", "hit", rows)


def _beside(evidence, rows, number, name):
    vertex = {k: evidence.at_vertex("bounce", k)[..., rows] for k in ("n", "p", "wo", "primitive")}
    sample, carries, frame, wo = _reference(evidence, vertex, number, ())
    wi = frame.to_local(evidence("bounce.wi")[:, rows])
    lobe, delta = evidence("bounce.lobe")[rows], evidence("bounce.delta")[rows].astype(bool)
    # A vertex and its reference change places with equal chance: only pairs that differ tell something.
    ours, theirs = 2 * lobe + delta, 2 * sample.lobe.astype(int) + sample.delta
    differ = carries & (ours != theirs)
    if np.count_nonzero(differ) >= FEWEST:
        for kind in np.unique(theirs):
            either = differ & ((ours == kind) | (theirs == kind))
            if np.count_nonzero(either) >= FEWEST:
                p = share(ours[either] == kind, np.full(np.count_nonzero(either), 0.5))
                yield Cell(p, f"how often each lobe of {name} is chosen", "bounce", rows[either], {})
    smooth = carries & ~delta & ~sample.delta
    if np.count_nonzero(smooth) < FEWEST:
        return
    wi, other, wo = wi[:, smooth], sample.wi[:, smooth], wo[:, smooth]
    half, half_other = (_half(wo, w) for w in (wi, other))
    for words, a, b in (
        ("height", wi[2], other[2]),
        ("half vectors", half, half_other),
        ("azimuth", _turn(wo, wi), _turn(wo, other)),
    ):
        yield Cell(same(a, b), f"the {words} of directions from {name}", "bounce", rows[smooth], {})


def _half(wo, wi):
    h = wo + wi
    return np.abs(h[2]) / np.maximum(np.sqrt((h * h).sum(axis=0)), 1e-300)


def _turn(wo, wi):
    """Azimuth of wi from that of wo, from 0 to 1."""
    return ((np.arctan2(wi[1], wi[0]) - np.arctan2(wo[1], wo[0])) / (2.0 * np.pi)) % 1.0
