"""Random numbers: uniform, independent between uses, depths, samples and pixels, and each used once."""

from itertools import combinations

import numpy as np

from tracer.bsdf import Conductor, Dielectric, Diffuse, ThinDielectric
from tracer.doctor.rule import NotRecordedError
from tracer.doctor.statistics.cells import FEWEST, Cell, share, square, uniform, unrelated

NEVER_ABSORB = (Diffuse, Conductor, Dielectric, ThinDielectric)
_BITS = 1e-7  # two numbers are equal by chance less often than this
_USES = {"light": "light.u", "bsdf": "bounce.u", "roulette": "roulette.u"}


def drawn(evidence, use):
    """The numbers (k, N) of one use and the rows of their events: only those whose being recorded does not
    depend on them, and with a low-discrepancy sampler only one sample of each pixel."""
    if use == "film":
        if not evidence.settings.jitter:
            raise NotRecordedError("jitter, which is off")
        path = evidence.trace.tables["camera"].path
        u = evidence("camera.film") - np.stack((evidence("path.x"), evidence("path.y")))[:, path]
        kind, rows = "camera", np.arange(path.size)
    else:
        kind = _USES[use].split(".")[0]
        u = np.atleast_2d(evidence(_USES[use]))
        rows = np.arange(u.shape[1])
        if use == "bsdf":
            rows = rows[_always_recorded(evidence)]
    if evidence.settings.sampler != "independent":
        rows = rows[evidence("path.sample")[evidence.trace.tables[kind].path[rows]] == 0]
    return u[:, rows], rows


def _always_recorded(evidence):
    """Which BOUNCEs are recorded whatever their numbers are."""
    scene = evidence.scene
    plain = np.array([isinstance(m, NEVER_ABSORB) for m in scene.definition.bsdfs.values()])
    smooth = np.array([getattr(shape, "normals", None) is not None for shape in scene.shapes])
    primitive = evidence.at_vertex("bounce", "primitive")
    even = plain.take(evidence.materials("bounce")) & ~smooth.take(scene.shape_of.take(primitive))
    return even & (primitive >= 0)


def _kind(use):
    return "camera" if use == "film" else _USES[use].split(".")[0]


def evenly(evidence):
    """I15: each number is uniform, and those of one use together."""
    for use in ("film", *_USES):
        u, rows = drawn(evidence, use)
        if rows.size < FEWEST:
            continue
        kind = _kind(use)
        for k, column in enumerate(u):
            yield Cell(uniform(column), f"number {k + 1} for {use}", kind, rows, {"use": use, "u": column})
        for a, b in combinations(range(len(u)), 2):
            p = square(u[a], u[b])
            if p is not None:
                yield Cell(p, f"numbers {a + 1} and {b + 1} for {use}", kind, rows, {"use": use, "u": u[a]})


def once(evidence):
    """I15: the same numbers do not come twice."""
    for use in ("light", "bsdf"):
        u, rows = drawn(evidence, use)
        if rows.size < FEWEST:
            continue
        order = np.lexsort(u)
        twice = (u[:, order[1:]] == u[:, order[:-1]]).all(axis=0)
        by_chance = 0.5 * rows.size**2 * max(_BITS, evidence.eps) ** len(u)
        again = rows[order[1:][twice]]
        path = evidence.trace.tables[_kind(use)].path
        within = float((path[again] == path[rows[order[:-1][twice]]]).mean()) if again.size else 0.0
        p = min(1.0, by_chance) if again.size else 1.0
        distinct = rows.size - again.size
        words = f"the numbers for {use}: {distinct} different ones at {rows.size} vertices"
        yield Cell(
            p,
            words,
            _kind(use),
            again if again.size else rows,
            {"use": use, "distinct": distinct, "of": rows.size, "within": within},
        )


def unrelated_ones(evidence):
    """I15: numbers for different uses, depths, samples and pixels have nothing to do with each other."""
    light, bsdf = (dict(zip(("u", "rows"), drawn(evidence, use), strict=True)) for use in ("light", "bsdf"))
    yield from _between_uses(evidence, light, bsdf)
    for use, of in (("light", light), ("bsdf", bsdf)):
        kind = _kind(use)
        table = evidence.trace.tables[kind]
        path, depth = table.path[of["rows"]], table.depth[of["rows"]]
        x, y, sample = (evidence(f"path.{name}")[path] for name in ("x", "y", "sample"))
        key = _key(x, y, sample, depth)
        order = np.argsort(key)
        for words, other in (
            ("depths", _key(x, y, sample, depth + 1)),
            ("samples", _key(x, y, sample + 1, depth)),
            ("pixels", _key(x + 1, y, sample, depth)),
            ("rows of pixels", _key(x, y + 1, sample, depth)),
        ):
            place = np.minimum(np.searchsorted(key[order], other), key.size - 1)
            there = key[order][place] == other
            if np.count_nonzero(there) < FEWEST:
                continue
            a, b = of["u"][:, there], of["u"][:, order[place[there]]]
            for k in range(1, 3):
                p = unrelated(a[k], b[k])
                yield Cell(
                    p,
                    f"number {k + 1} for {use} at neighbouring {words}",
                    kind,
                    of["rows"][there],
                    {"use": use},
                )


def _between_uses(evidence, light, bsdf):
    if not evidence.count("light"):
        return
    row = evidence.before("bounce", "light")[bsdf["rows"]]
    vertex = evidence.before("light", "hit").take(row, mode="clip")
    same = (row >= 0) & (evidence.before("bounce", "hit")[bsdf["rows"]] == vertex)
    if np.count_nonzero(same) < FEWEST:
        return
    a, b = evidence("light.u")[:, row[same]], bsdf["u"][:, same]
    for j in range(3):
        for k in range(3):
            words = f"number {j + 1} for light and number {k + 1} for bsdf"
            yield Cell(unrelated(a[j], b[k]), words, "bounce", bsdf["rows"][same], {"use": "bsdf"})


def _key(x, y, sample, depth):
    return ((y.astype(np.int64) * (1 << 17) + x) * (1 << 16) + sample % (1 << 16)) * (1 << 12) + depth % (
        1 << 12
    )


def survivors(evidence):
    """I9: as many go on at roulette as its probabilities say."""
    q, survived = evidence("roulette.probability"), evidence("roulette.survived")
    rows = np.arange(q.size)
    good = (q >= 0.0) & (q <= 1.0)
    if np.count_nonzero(good) < FEWEST:
        return
    words = f"{survived[good].mean():.4f} of the paths go on, where {q[good].mean():.4f} is said"
    yield Cell(
        share(survived[good], q[good]),
        words,
        "roulette",
        rows[good],
        {"share": survived[good].mean(), "q": q[good]},
    )
