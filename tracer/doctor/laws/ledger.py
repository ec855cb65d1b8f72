"""What a path brings back, and how it ends."""

import numpy as np

from tracer.doctor.laws.emission import strategy
from tracer.doctor.laws.records import without_number
from tracer.doctor.rule import Outcome, Rule
from tracer.events import END_REASONS
from tracer.frame import dot

_REASON = {reason: number for number, reason in enumerate(END_REASONS)}
_GIVING = ("hit", "light", "escape")


def total(evidence):
    """Sum (3, P) of each path's contributions, sum of their sizes, and how many there are (P,)."""
    size = evidence.trace.size
    found, sizes, many = np.zeros((3, size)), np.zeros((3, size)), np.zeros(size)
    for kind in _GIVING:
        if not evidence.count(kind):
            continue
        path, gain = evidence.trace.tables[kind].path, evidence(f"{kind}.contribution")
        for channel in range(3):
            found[channel] += np.bincount(path, gain[channel], size)
            sizes[channel] += np.bincount(path, np.abs(gain[channel]), size)
        many += np.bincount(path, minlength=size)
    return found, sizes, many


def ledger(evidence):
    """I14: which paths' radiance is not the sum of what their events brought."""
    right, sizes, many = total(evidence)
    recorded = evidence("path.radiance")
    room = (many + 4.0) * 2.0 * evidence.eps * sizes + 1e-36
    finite = np.isfinite(right).all(axis=0)
    same = (np.abs(recorded - right) <= room) | (np.isnan(recorded) & np.isnan(right))
    bad = ~same.all(axis=0)
    invalid = evidence("path.end") == _REASON["invalid"] if evidence.has("path.end") else ~finite
    bad = np.where(invalid & ~finite, (recorded != 0.0).any(axis=0), bad)
    return Outcome("path", np.arange(bad.size), bad, np.zeros_like(bad), recorded, right, "radiance")


def order(evidence):
    """Depth counts the bounces before an event."""
    hits = evidence.trace.tables["hit"]
    right = np.where(evidence.before("hit", "hit") < 0, 0, hits.depth.take(evidence.before("hit", "hit")) + 1)
    bad = hits.depth != right
    return Outcome("hit", np.arange(bad.size), bad, np.zeros_like(bad), hits.depth, right, "depth")


def reason(evidence):
    """I9: paths end for a reason."""
    end = evidence("end.reason")
    rows = np.arange(end.size)
    depth = evidence.trace.tables["end"].depth
    settings = evidence.settings
    may = np.ones(end.shape, bool)
    last = settings.last_depth
    counted = not evidence.scene.bsdf.any_delta and strategy(settings) == "light"
    may[end == _REASON["max_depth"]] = (depth + counted >= last)[end == _REASON["max_depth"]]
    roulette, step = evidence.before("end", "roulette"), evidence.trace.tables["end"].step
    dead = roulette >= 0
    if dead.any():
        table = evidence.trace.tables["roulette"]
        dead[dead] = (table.step[roulette[dead]] == step[dead] - 1) & ~evidence("roulette.survived")[
            roulette[dead]
        ].astype(bool)
    by_chance = end == _REASON["roulette"]
    may &= ~by_chance | dead
    out = evidence.before("end", "escape") >= 0
    may &= (end != _REASON["escaped"]) | out
    unsure = np.zeros(end.shape, bool)
    for name in ("black", "invalid"):
        here = end == _REASON[name]
        if here.any():
            may[here], unsure[here] = _without_direction(evidence, evidence.before("end", "hit")[here])
    invalid = np.flatnonzero(end == _REASON["invalid"])
    if invalid.size:
        may[invalid] |= without_number(evidence)[evidence.trace.tables["end"].path[invalid]]
    return Outcome("end", rows, ~may & ~unsure, unsure, what="reason")


def _without_direction(evidence, vertex):
    """Whether paths may find no direction to go on in at HITs (rows), and where that is not known."""
    dark, unsure = _dark(evidence, vertex)
    return dark | ~_plain(evidence.scene).take(_material(evidence, vertex)), unsure | (vertex < 0)


def _plain(scene):
    """Whether each material is diffuse of one colour, (M,): others may find no direction to go on in."""
    from tracer.bsdf import Diffuse

    return np.array(
        [
            isinstance(m, Diffuse) and not scene.definition.textures.get(name)
            for name, m in scene.definition.bsdfs.items()
        ]
    )


def _material(evidence, vertex):
    return evidence.scene.bsdf_of.take(evidence("hit.primitive").take(vertex))


def _dark(evidence, vertex):
    """Whether nothing can be reflected at HITs (rows), and where rounding decides."""
    p, n, wo = (evidence(f"hit.{name}").take(vertex, axis=1) for name in ("p", "n", "wo"))
    primitive = evidence("hit.primitive").take(vertex)
    wo_local = evidence.scene.frame(n, p, primitive).to_local(wo)
    dark = ~evidence.scene.bsdf.reflects(evidence.scene.bsdf_of.take(primitive), wo_local)
    return dark, ~dark & (np.abs(dot(n, wo)) <= 4.0 * evidence.off_unit)


def dead_stay_dead(evidence):
    """I9: who loses at roulette brings nothing more."""
    lost = ~evidence("roulette.survived").astype(bool)
    table = evidence.trace.tables["roulette"]
    end = evidence.after("roulette", "end")
    step = np.where(end >= 0, evidence.trace.tables["end"].step.take(end), -1)
    bad = lost & (step != table.step + 1)
    rows = np.flatnonzero(lost)
    return Outcome("roulette", rows, bad[rows], np.zeros(rows.shape, bool))


def nothing_absorbed(evidence):
    """Diffuse surfaces that reflect anything absorb no path: they take their share from its throughput."""
    scene = evidence.scene
    if scene.has_smooth_normals:
        return None
    end = evidence("end.reason")
    lost = np.flatnonzero(end == _REASON["absorbed"])
    vertex = evidence.before("end", "hit")[lost]
    lost, vertex = lost[vertex >= 0], vertex[vertex >= 0]
    plain = _plain(scene)
    here = plain.take(_material(evidence, vertex))
    if not plain.any():
        return None
    lit = (evidence("hit.beta").take(vertex, axis=1) > 0.0).any(axis=0)
    cos = dot(evidence("hit.n").take(vertex, axis=1), evidence("hit.wo").take(vertex, axis=1))
    bad = here & lit & (cos > 64.0 * evidence.off_unit)
    rows = np.arange(end.size)
    wrong = np.zeros(end.size, bool)
    wrong[lost[bad]] = True
    return Outcome("end", rows, wrong, np.zeros_like(wrong), what="reason")


def light_due(evidence):
    """A light sample at every vertex that can use one, and no second one."""
    settings, scene = evidence.settings, evidence.scene
    if strategy(settings) == "bsdf" or not scene.has_lights:
        rows = np.arange(evidence.count("light"))
        return (
            Outcome("light", rows, np.ones(rows.size, bool), np.zeros(rows.size, bool)) if rows.size else None
        )
    hits = evidence.trace.tables["hit"]
    material = scene.bsdf_of.take(evidence("hit.primitive"))
    vertex = evidence.before("light", "hit")
    many = np.bincount(vertex[vertex >= 0], minlength=hits.path.size)
    wanted = evidence.trace.light_samples
    dark, grazing = _dark(evidence, np.arange(hits.path.size))
    due = ~scene.bsdf.is_delta(material) & ~dark & (hits.depth < settings.last_depth)
    bad = (many != due * wanted) & ~grazing & ~(dark & (many == 0))
    return Outcome("hit", np.arange(bad.size), bad, grazing, many, due * wanted, "light samples")


RULES = (
    Rule(
        "depth",
        "Depth counts the bounces",
        "Each vertex is one bounce deeper than the one before.",
        "depth_k+1 = depth_k + 1",
        ("hit.p",),
        order,
    ),
    Rule(
        "light-due",
        "One light sample at each vertex",
        "Where lights are sampled, each vertex that does not only mirror does so, all equally often.",
        "1 per vertex",
        ("hit.primitive", "hit.p", "hit.n", "hit.wo"),
        light_due,
    ),
    Rule(
        "end",
        "Paths end for a reason",
        "A path ends by roulette, by leaving the scene, at a black surface, "
        "at the declared depth or by a number that is none; nothing else may end it.",
        "no end that is not paid for",
        ("end.reason", "hit.p", "hit.n", "hit.wo", "hit.primitive"),
        reason,
    ),
    Rule(
        "dead",
        "Who loses at roulette is dead",
        "A path that loses at roulette brings nothing more.",
        "survived = false ends the path",
        ("roulette.survived",),
        dead_stay_dead,
    ),
    Rule(
        "absorbed",
        "Diffuse surfaces absorb no path",
        "A diffuse surface takes its share from the throughput; it always has a direction above it to go on.",
        "f > 0, pdf > 0 for n . wi > 0, n . wo > 0",
        ("end.reason", "hit.n", "hit.wo", "hit.beta", "hit.primitive"),
        nothing_absorbed,
    ),
    Rule(
        "ledger",
        "A path's radiance is the sum of its terms",
        "Radiance is the sum of what the path's events brought.",
        "L = sum of contributions",
        ("path.radiance", "hit.contribution", "light.contribution", "escape.contribution"),
        ledger,
    ),
)
