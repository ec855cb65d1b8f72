"""What fills the way of light."""

import numpy as np

from tracer.doctor.compare import judged
from tracer.doctor.rule import Rule
from tracer.frame import dot


def mediums(evidence):
    """Number (E,) of the medium in which each HIT was come to, by the surfaces that the path crossed."""
    media, hits = evidence.scene.media, evidence.trace.tables["hit"]
    medium = np.full(hits.path.size, media.camera)
    before = evidence.before("hit", "hit")
    for depth in range(1, int(hits.depth.max(initial=0)) + 1):
        rows = np.flatnonzero((hits.depth == depth) & (before >= 0))
        last = before[rows]
        wi = evidence("bounce.wi").take(evidence.before("hit", "bounce")[rows], axis=1)
        medium[rows] = _beyond(evidence, last, wi, medium[last])
    return medium


def _beyond(evidence, hit, wi, medium):
    """Medium of rays that leave HITs (rows) along wi, come to through `medium`."""
    media, primitive = evidence.scene.media, evidence("hit.primitive").take(hit)
    behind = dot(evidence.brute.normals(evidence("hit.p").take(hit, axis=1), primitive), wi) < 0.0
    beyond = np.where(behind, media.back.take(primitive), media.front.take(primitive))
    return np.where(beyond < 0, medium, beyond)


def _left(evidence, kind, medium, distance, rows, sound=None):
    share = evidence.scene.media.sigma_t.take(medium, axis=1)
    inputs = {"t": (distance, 2.0 * evidence.off_point), "sigma": (share, 0.0)}
    return judged(
        evidence,
        kind,
        rows,
        evidence(f"{kind}.transmittance"),
        lambda t, sigma: np.exp(-sigma * t),
        inputs,
        "transmittance",
        sound,
    )


def on_the_way(evidence):
    """What is left after the way to each HIT."""
    if evidence.scene.media is None:
        return None
    return _left(evidence, "hit", mediums(evidence), evidence("hit.t"), np.arange(evidence.count("hit")))


def from_the_light(evidence):
    """What is left after the way from each light point."""
    if evidence.scene.media is None:
        return None
    vertex = evidence.before("light", "hit")
    medium = _beyond(evidence, vertex, evidence("light.wi"), mediums(evidence)[vertex])
    return _left(evidence, "light", medium, evidence("light.distance"), np.arange(vertex.size))


_LAW = "Of the light that goes a way t through a medium, exp(-sigma_t t) is left (Beer and Lambert)."
RULES = (
    Rule(
        "transmittance",
        "Light is absorbed on the way",
        _LAW,
        "T = exp(-sigma_t t)",
        ("hit.transmittance", "hit.t", "hit.p", "hit.primitive", "bounce.wi"),
        on_the_way,
    ),
    Rule(
        "light-transmittance",
        "Light is absorbed on its way from the lamp",
        _LAW,
        "T = exp(-sigma_t r)",
        ("light.transmittance", "light.distance", "light.wi", "hit.p", "hit.primitive", "bounce.wi"),
        from_the_light,
    ),
)
