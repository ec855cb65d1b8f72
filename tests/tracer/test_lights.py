"""Lamps: true densities, and one answer whichever way a lamp is found.

That points and directions follow their densities is in test_densities.
"""

import numpy as np
import pytest
from densities.lights import FAR, LAMPS, room
from lamps import light_samples

from tracer import Settings
from tracer.frame import dot

N = 60_000


def sampled(scene, seed, n=N, precision=64, by="area"):
    """The scene in a precision, and light samples for a receiver far away."""
    scene = scene.at(Settings(precision=precision, light_sampling=by))
    return scene, light_samples(scene, FAR, seed, n, precision, by)


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("name", LAMPS)
def test_points_lie_on_their_lamp(suite_seed, name, precision):
    scene, light = sampled(room((name, 1.0)), suite_seed, 2000, precision)
    eps = np.finfo(scene.dtype).eps
    assert np.abs(np.sqrt(dot(light.wi, light.wi)) - 1).max() < 4 * eps
    assert np.abs(np.sqrt(dot(light.nq, light.nq)) - 1).max() < 8 * eps
    if name == "sphere":
        out = light.q - scene.shapes[0].center[:, None]
        assert np.abs(np.sqrt(dot(out, out)) - 0.8).max() < 16 * eps
    else:
        n, c = scene.shapes[0].planes()
        off = (n[:, light.primitive] * light.q).sum(axis=0) - c[light.primitive]
        assert np.abs(off).max() < 32 * eps * max(1.0, np.abs(light.q).max())


@pytest.mark.parametrize("name", LAMPS)
def test_the_density_per_solid_angle_is_that_per_area_seen_from_the_receiver(suite_seed, name):
    """pdf cos_light = pick pdf_area distance^2 where the lamp faces the receiver; elsewhere it is dark."""
    scene, light = sampled(room((name, (3.0, 2.0, 1.0)), ("rectangle", 0.7)), suite_seed)
    cos = -dot(light.nq, light.wi)
    area = np.array([shape.area().sum() for shape in scene.shapes])
    want = light.pick / area[light.light] * light.distance**2
    facing = cos > 0
    assert np.allclose((light.pdf * cos)[facing], want[facing], rtol=1e-12)
    assert not light.pdf[~facing].any() and not light.Le[:, ~facing].any()
    assert (light.Le[:, facing] > 0).all()


@pytest.mark.parametrize("precision", [32, 64])
@pytest.mark.parametrize("by", ["area", "solid_angle"])
@pytest.mark.parametrize("name", LAMPS)
def test_a_bounce_that_finds_a_lamp_names_the_density_of_the_light_sample(suite_seed, name, by, precision):
    """Both techniques see the same lamp: radiance and density agree along every direction."""
    scene, light = sampled(room((name, (3.0, 2.0, 1.0))), suite_seed, 4000, precision, by=by)
    facing = np.flatnonzero(light.pdf > 0)
    light = light.take(facing)
    o = np.repeat(np.array([[3.0], [40.0], [20.0]]), facing.size, axis=1).astype(scene.dtype)
    with np.errstate(all="ignore"):
        t, primitive = scene.intersect(o, light.wi, np.full(facing.size, -1))
        same = np.flatnonzero((primitive == light.primitive) & (-dot(light.nq, light.wi) > 0.1))
        hit = scene.hit(o[:, same], light.wi[:, same], t[same], primitive[same])
    assert same.size > 0.3 * facing.size
    assert (scene.shining(hit) == np.arange(same.size)).all()
    Le, pdf = scene.emission(hit, o[:, same], np.arange(same.size))
    assert np.array_equal(Le, light.Le[:, same])
    assert np.allclose(pdf, light.pdf[same], rtol={32: 3e-3, 64: 1e-10}[precision])
