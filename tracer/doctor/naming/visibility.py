"""What hides light points, or lets them be seen."""

import numpy as np

from tracer.doctor.naming.case import MOST, SHARE, Clue
from tracer.frame import dot

_A_TOSS = 0.02, 0.85  # shares of the light points that rounding may hide
_OF_DOUBLES = 0.95  # of doubles nine tenths, measured with a tracer in Python
_STRANGERS = 0.6  # of the disagreement of strangers: 0.8 and more where rounding decides, else below 0.1
_FEWEST = 10.0  # disagreements that strangers would have, to speak of any
_ALL = 0.999
_ROUNDING = "rounding alone would hide about half of them, be it at the lamp or where the shadow ray starts"


def visible(case):
    """Whether light points are seen."""
    outcome = case.outcome
    sure = ~outcome.unsure
    seen, free = outcome.recorded.astype(bool)[sure], outcome.right.astype(bool)[sure]
    wrongly_dark, wrongly_seen = ~seen & free, seen & ~free
    if not wrongly_seen.any() and not (seen & free).any():
        words = "no light point at all is seen, though nothing lies before it but the lamp itself"
        return Clue("D04", words, ("D03",))
    rows = outcome.rows[sure]
    if not wrongly_seen.any():
        return _hidden(case, rows[free], seen[free])
    if _from_the_camera(case, rows, seen, free):
        words = "seen is what the camera sees, not the vertex: the shadow ray starts at the camera"
        return Clue(None, words)
    if seen.mean() >= _ALL:
        words = "every blocked light point counts as seen: the test is not made, or reversed"
        return Clue("D03", words)
    if wrongly_dark.sum() >= 0.99 * free.sum() and wrongly_seen.sum() >= 0.99 * (~free).sum():
        return Clue("D03", "seen and blocked are exchanged")
    if not wrongly_dark.any():
        share = wrongly_seen.sum() / (~free).sum()
        said = f"{share:.0%}" if share >= 0.01 else f"{100.0 * share:.1g}%"
        return Clue(None, f"{said} of the blocked light points count as seen")
    return Clue(None, "some free light points count as blocked, and some blocked ones as seen")


def _hidden(case, rows, seen):
    """Free light points (rows) that count as blocked: rounding's work only if no neighbour tells of another
    whether it is seen."""
    share = 1.0 - seen.mean()
    words = f"{share:.1%} of the free light points count as blocked"
    most = _A_TOSS[1] if case.evidence.eps > np.finfo(np.float64).eps * 1e3 else _OF_DOUBLES
    if not _A_TOSS[0] <= share <= most:
        return Clue(None, f"{words}: {_ROUNDING}")
    if not _tossed(case.evidence, rows, seen):
        return Clue(None, f"{words}: {_which(case.evidence, rows, seen)}; it is not rounding that decides")
    return Clue(
        "D01",
        f"{share:.0%} of the free light points count as blocked, by the lamp itself: the "
        "comparison of the two distances has no tolerance, and rounding decides",
        ("D02",),
    )


def _tossed(evidence, rows, seen):
    """Whether light samples of almost the same points p and q disagree about being seen as strangers do."""
    from scipy.spatial import cKDTree

    some = np.linspace(0, rows.size - 1, min(rows.size, 2 * MOST)).astype(int)
    rows, seen = rows[some], seen[some]
    p, q = evidence.at_vertex("light", "p")[:, rows], evidence("light.q")[:, rows]
    faces = np.stack((evidence.at_vertex("light", "primitive")[rows], evidence("light.primitive")[rows]))
    places = np.concatenate((p / evidence.scale, q / evidence.scale, 10.0 * faces)).T
    other = seen[cKDTree(places).query(places, k=2)[1][:, 1]]
    strangers = 2.0 * seen.mean() * (1.0 - seen.mean())
    return strangers * seen.size >= _FEWEST and (other != seen).mean() >= _STRANGERS * strangers


def _which(evidence, rows, seen):
    """What the points have in common that are not seen, in words."""
    light = evidence("light.light")[rows]
    many = np.bincount(light, minlength=len(evidence.scene.light_names))
    dark = np.bincount(light, ~seen, minlength=many.size)
    whole = dark >= SHARE * np.maximum(many, 1)
    if dark[whole].sum() >= SHARE * dark.sum() and not whole[many > 0].all():
        names = [name for name, all_dark in zip(evidence.scene.light_names, whole, strict=True) if all_dark]
        return f"all of those on {', '.join(names[:3])}{', ...' if len(names) > 3 else ''}"
    return "neighbouring points alike"


def _from_the_camera(case, rows, seen, free):
    """Whether what is seen is what the camera sees, where that differs from what vertices see."""
    evidence = case.evidence
    if not evidence.has("camera.o") or not evidence.count("camera"):
        return False
    some = np.linspace(0, rows.size - 1, min(rows.size, MOST)).astype(int)
    rows, seen, free = rows[some], seen[some], free[some]
    o = evidence("camera.o")[:, evidence.before("light", "camera")[rows]]
    q, target = evidence("light.q")[:, rows], evidence("light.primitive")[rows]
    nowhere = np.full(rows.size, -1)
    slack = 4.0 * evidence.off_vertex
    blocked, maybe = evidence.brute.between(o, q, nowhere, target, slack, evidence.trace.culled)
    hidden, near = evidence.lamps.hidden(o, np.maximum(target, 0), slack)
    facing = dot(evidence.brute.normals(q, np.maximum(target, 0)), o - q) > 0.0
    blocked, maybe = (v | hidden | ~facing for v in (blocked, maybe))
    sure = (blocked == maybe) & ~near & (target >= 0)
    tells = sure & (blocked == free)
    alike = (seen == ~blocked)[sure]
    return bool(tells.any() and not (~blocked[sure]).all() and alike.mean() >= 0.99)
