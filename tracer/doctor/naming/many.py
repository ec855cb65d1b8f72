"""What breaks the laws of many events."""

import numpy as np

from tracer.doctor.naming.case import SHARE, Clue
from tracer.doctor.statistics.cells import uniform

_FEW = 20  # points on a lamp
_LIKELY = 1e-3  # a guess at how numbers were made must make them likely


def numbers(case):
    """Numbers that are not uniform."""
    bad = [cell.facts for cell in case.outcome.facts["cells"]]
    frozen = {facts["use"]: float(np.median(facts["u"])) for facts in bad if np.ptp(facts["u"]) < 1e-4}
    if not frozen or len(frozen) < len({facts["use"] for facts in bad}):
        return None
    if frozen.keys() == {"film"}:
        return Clue("F05", f"every sample is at {frozen['film']:.4g} of its pixel: there is no jitter")
    values = ", ".join(f"{value:.4g} for {use}" for use, value in frozen.items())
    return Clue("P02", f"every number is the same ({values}): the generator always starts alike")


def once(case):
    """Numbers that come twice."""
    facts = case.outcome.facts
    if facts["distinct"] <= 2:
        return Clue("P02", "the same numbers at every vertex: the generator always starts alike")
    if facts["within"] > 0.5:  # generators that are shared give the same numbers to different paths
        return Clue(None, f"{case.outcome.note}; the same ones come again within one path")
    return Clue("P03", case.outcome.note, ())


def points(case):
    """Light points that are not spread evenly."""
    facts = case.outcome.facts
    a, b, raw = facts["a"], facts["b"], facts["raw"]
    along = np.corrcoef(raw)[0, 1]
    if abs(along) > 0.999:
        return Clue("D17", "the two coordinates of every point are the same number: all lie on the diagonal")
    if _of_the_choice(case.evidence, facts["primitive"], a):
        return Clue("D17", "the number that chooses the lamp is the first coordinate of the point on it, too")
    if _of_the_choice(case.evidence, facts["primitive"], b):
        return Clue(
            "D17", "the number that chooses the lamp is the second coordinate of the point on it, too"
        )
    if facts["shape"] == "sphere":
        if uniform(raw[0]) > _LIKELY and uniform(raw[1]) > _LIKELY:
            return Clue("D18", "points are uniform in the sphere's two angles: too many lie at its poles")
        return None
    if facts["shape"] == "triangle" and uniform(np.clip(raw.sum(axis=0), 0.0, 1.0)) > _LIKELY:
        return Clue("D17", "s + t is uniform, where its square should be: a root is missing")
    if facts["shape"] == "quad":
        for s, t in ((a, b), (1.0 - a, b)):
            low = s + t < 1.0
            halves = (s[low], t[low]), (1.0 - s[~low], 1.0 - t[~low])
            if all(_fills_triangle(*half) for half in halves):
                words = (
                    f"its two triangles are evenly filled, but get {low.mean():.1%} and {1 - low.mean():.1%}"
                )
                return Clue(_root_of_the_choice(low), f"{words}: they are not chosen by area")
    return None


def _of_the_choice(evidence, which, number):
    """Whether a number (N,) keeps on each lamp (N,) to an interval as wide as the lamp's probability: in such
    a one lies the number that chose the lamp."""
    pick = evidence.lamps.pick.take(evidence.scene.light_of)
    faces = [f for f, many in enumerate(np.bincount(which)) if many >= _FEW and pick[f] < 0.6]
    kept = [np.ptp(number[which == f]) <= 1.2 * pick[f] for f in faces]
    return bool(kept and np.mean(kept) >= SHARE)


def _root_of_the_choice(low):
    """D15 where one of two halves gets a quarter, as the root of a uniform number leaves it."""
    least = min(low.mean(), 1.0 - low.mean())
    return "D15" if abs(least - 0.25) < 4.0 * np.sqrt(0.1875 / low.size) else None


def _fills_triangle(s, t):
    """Whether points (N,) fill the triangle s + t < 1 evenly."""
    total = s + t
    evenly = uniform(total * total) > _LIKELY
    return evenly and uniform(t / np.where(total > 0.0, total, 1.0)) > _LIKELY


def directions(case):
    """Directions that do not come as often as they should."""
    local = case.outcome.facts.get("local")
    if local is None:
        return None
    evidence, z = case.evidence, local[2]
    negative = (local < 0.0).mean(axis=1)
    few = [axis for axis in range(2) if negative[axis] < 0.001]
    if few:
        names = " and ".join("xy"[axis] for axis in few)
        return Clue(
            "B09", f"the local {names} of directions is never negative: part of the hemisphere is left out"
        )
    if negative[2] > 0.4:
        return Clue("B08", "half of the directions lead into the surface: the whole sphere is sampled")
    cosine = evidence.settings.hemisphere == "cosine"
    if uniform(1.0 - z if cosine else 1.0 - z * z) > _LIKELY:
        follow, claim = ("1/(2 pi)", "cos/pi") if cosine else ("cos/pi", "1/(2 pi)")
        return Clue("B01", f"the directions follow {follow}, and {claim} is claimed")
    return None


def share(case):
    """Roulette that lets too many or too few go on."""
    found, q = case.outcome.facts["share"], case.outcome.facts["q"]
    if abs(found - (1.0 - q).mean()) < 3.0 * np.sqrt((q * (1.0 - q)).sum()) / q.size:
        return Clue("R03", f"a share {found:.3f} goes on, which is 1 - q: the test is reversed")
    return None


NAMES = {
    "numbers-uniform": numbers,
    "numbers-once": once,
    "lamp-points": points,
    "directions": directions,
    "roulette-share": share,
}
