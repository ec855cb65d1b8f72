"""Shadow rays keep to the sides of walls, too: at the edges where they start and at those where they end."""

import numpy as np
import pytest
from bare_scenes import DTYPES, scene_of, unit
from cases import slow_but
from continuation import PLACES, careless, matrix, rooms
from lamps_outside import lit_from_outside
from suite import suite_seed

from tracer.light.sample import AREA, LightSample
from tracer.shape import Rectangle, end

both = pytest.mark.parametrize("dtype", DTYPES)


@pytest.mark.slow
@both
def test_no_light_of_a_lamp_outside_comes_into_a_closed_room(dtype):
    """From all over the walls, half of the shadow rays from within 4 ulp of edges and corners."""
    assert not any(lit_from_outside(dtype, 50_000, suite_seed() + k) for k in range(3))


def test_shadow_rays_that_start_where_rounding_put_them_bring_light_in(monkeypatch):
    """The broken twin."""
    assert lit_from_outside(np.float32, 30_000, suite_seed(), lambda scene: careless(scene, monkeypatch)) > 0


def standing_lamp(place, inside):
    """A lamp at right angles to the wall x = 1 that touches it, from inside or from outside."""
    step = np.eye(4)
    step[:3, 0], step[:3, 1], step[:3, 2] = (0.5, 0.0, 0.0), (0.0, 0.0, -0.5), (0.0, 1.0, 0.0)
    step[:3, 3] = (0.5 if inside else 1.5, 0.1, 0.0)
    return Rectangle("lamp", matrix(place, step))


def seen(name, place, dtype, inside, n=8000):
    """Light samples within 4 ulp of the edge by which a lamp touches the wall: which are seen from the room,
    of those that face it."""
    shapes, rng = [*rooms(place)[name](), standing_lamp(place, inside)], np.random.default_rng(suite_seed())
    scene, turn = scene_of(shapes, dtype, {len(rooms(place)[name]()): np.ones(3)}), matrix(place)
    middle = turn[:3, :3] @ [-0.2, 0.5, 0.3] + turn[:3, 3]  # on the bright side
    o, d, lamp = np.tile(middle[:, None], n).astype(dtype), unit(rng, n, dtype), np.full(n, scene.first[-1])
    with np.errstate(all="ignore"):
        t, met = scene.intersect(o, d, np.full(n, -1))
        walls = np.flatnonzero(met != scene.first[-1])
        o, d, lamp = o[:, walls], d[:, walls], lamp[walls]
        hit = scene.hit(o, d, t[walls], met[walls])
        at = np.stack((np.ones(walls.size), np.full(walls.size, 0.1), rng.uniform(-0.5, 0.5, walls.size)))
        q = (turn[:3, :3] @ at + turn[:3, 3:]).astype(dtype)
        q += rng.integers(-4, 5, q.shape).astype(dtype) * np.spacing(np.abs(q))
        q, nq, _ = scene._surfaces.project(q, lamp)
        gap = q - hit.p
        distance = np.sqrt((gap * gap).sum(axis=0))
        wi, ones = gap / distance, np.ones(walls.size, dtype)
        light = LightSample(
            0 * lamp, lamp, ones, np.full(walls.size, AREA), q, nq, wi, distance, np.ones_like(q), ones
        )
        facing = ((nq * wi).sum(axis=0) < -1e-2) & ((hit.ng * wi).sum(axis=0) > 1e-2)
        return ~scene.occluded(hit, light)[facing]


@both
@pytest.mark.parametrize("place", PLACES[:3], ids=lambda place: place.name)
@pytest.mark.parametrize("name", slow_but(("box", "fine", "rectangles", "cube"), "fine"))
def test_a_lamp_that_touches_a_wall_is_seen_on_its_own_side_only(name, place, dtype):
    from_inside, from_outside = seen(name, place, dtype, True), seen(name, place, dtype, False)
    assert from_inside.size > 1000 and from_inside.all()
    assert from_outside.size > 1000 and not from_outside.any()


@both
@pytest.mark.parametrize("inside", [True, False])
def test_ends_left_where_rounding_put_them_are_caught(inside, dtype, monkeypatch):
    """The broken twin."""
    monkeypatch.setattr(end, "clear_ends", lambda *columns: None)
    found = seen("fine", PLACES[0], dtype, inside)
    assert not found.all() and found.any()
