"""Rays that go on from within 4 ulp of edges and corners stay in the room and meet no neighbour falsely.

tests/continuation.py says what counts. Zero is asked, of a share of what `make accuracy` traces.
"""

import numpy as np
import pytest
from cases import slow_but
from continuation import AIMS, KINDS, PLACES, WAYS, careless, continuation, judge, room, trace
from suite import suite_seed

DTYPES = [np.float32, np.float64]

both = pytest.mark.parametrize("dtype", DTYPES)
placed = pytest.mark.parametrize(
    "place",
    [pytest.param(p, id=p.name, marks=[] if p.name == "origin" else pytest.mark.slow) for p in PLACES],
)


@both
@placed
@pytest.mark.parametrize("kind", slow_but(KINDS, next(iter(KINDS))))
def test_no_ray_from_an_edge_escapes_or_meets_what_it_cannot(kind, place, dtype):
    n = 1 + 6000 // (len(AIMS) * len(WAYS) * len(KINDS[kind]))
    for k, name in enumerate(KINDS[kind]):
        for aim in AIMS:
            for way in WAYS:
                found = continuation(name, place, dtype, aim, way, n, suite_seed() + k)
                assert found.rays > n // 2 and not any(found[1:]), (name, aim, way, found)


@both
@pytest.mark.parametrize("name", ["box", "block", "fine", "rectangles", "cube on a wall", "block in a cube"])
def test_starts_left_where_rounding_put_them_are_caught(name, dtype, monkeypatch):
    """The broken twin."""
    made = room(name, PLACES[0], dtype)
    careless(made.scene, monkeypatch)
    assert any(continuation(name, PLACES[0], dtype, aim, "anywhere", 3000, suite_seed())[1:] for aim in AIMS)


@both
def test_rays_that_meet_neighbours_falsely_are_counted(dtype):
    """The broken twin of the judge: every ray is said to meet a coplanar neighbour, then nothing at all."""
    made = room("fine", PLACES[0], dtype)
    face, _, _, wi, _, _, leaves = trace(made, "edges", "anywhere", 500, np.random.default_rng(suite_seed()))
    plane = np.abs(made.n.T @ made.n - 1.0) < 1e-9
    neighbour = np.array([np.flatnonzero(plane[a] & ~made.reaches[a])[-1] for a in face])
    escaped, self_hit, behind = judge(made, face, wi, neighbour)
    assert leaves.all() and self_hit.all() and behind.sum() > 490 and not escaped.any()
    assert judge(made, face, wi, np.full(500, -1))[0].all()


@both
@placed
@pytest.mark.parametrize("kind", KINDS)
def test_a_ray_from_an_edge_is_the_same_in_any_company(kind, place, dtype):
    """Who else is moved does not change where a ray goes, bit for bit."""
    made = room(KINDS[kind][0], place, dtype)
    rng = np.random.default_rng(suite_seed())
    face, _, o, wi, t, met, _ = trace(made, "corners", "along a neighbour", 400, rng)
    for lane in rng.permutation(400)[:10]:
        with np.errstate(all="ignore"):
            alone = made.scene.intersect(o[:, [lane]], wi[:, [lane]], face[[lane]])
        assert alone[0].tobytes() == t[[lane]].tobytes() and alone[1] == met[lane]
