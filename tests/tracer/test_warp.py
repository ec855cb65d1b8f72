"""Maps from the unit square and local frames: each map has the density it says, each frame is one.

Densities are tested by chi-square at 1 %, shared out by Sidak's formula among the maps and precisions.
"""

import numpy as np
import pytest
from stats import chi_square, sidak, uniform

from tracer import warp
from tracer.frame import Frame, cross, dot, length

N = 100_000
DTYPES = (np.float32, np.float64)
CONE = 0.3  # 1 - cos of its half angle


def square(seed, dtype, n=N):
    bits = 24 if dtype == np.float32 else 32
    return (np.random.default_rng(seed).integers(0, 2**bits, (2, n)) * 2.0**-bits).astype(dtype)


def longitude(w):
    return np.arctan2(w[1], w[0]) / (2 * np.pi) % 1.0


# Each map, and where its points land if they are carried back to the unit square by the known distribution.
BACK = {
    "concentric_disk": (
        warp.concentric_disk,
        lambda p: (longitude(p), p[0] ** 2 + p[1] ** 2),
    ),
    "cosine_hemisphere": (warp.cosine_hemisphere, lambda w: (longitude(w), 1 - w[2] ** 2)),
    "uniform_hemisphere": (warp.uniform_hemisphere, lambda w: (longitude(w), w[2])),
    "uniform_sphere": (warp.uniform_sphere, lambda w: (longitude(w), 0.5 * w[2] + 0.5)),
    "uniform_cone": (
        lambda u: warp.uniform_cone(u, u.dtype.type(CONE)),
        lambda w: (longitude(w), (1 - w[2]) / CONE),
    ),
    "uniform_triangle": (
        warp.uniform_triangle,
        lambda b: ((1 - b[0]) ** 2, b[1] / np.maximum(1 - b[0], 1e-30)),
    ),
}

DENSITIES = {
    "concentric_disk": (warp.concentric_disk_pdf, 1 / np.pi),
    "uniform_hemisphere": (warp.uniform_hemisphere_pdf, 1 / (2 * np.pi)),
    "uniform_sphere": (warp.uniform_sphere_pdf, 1 / (4 * np.pi)),
}

both = pytest.mark.parametrize("dtype", DTYPES)


@pytest.mark.statistical
@both
@pytest.mark.parametrize("name", BACK)
def test_a_map_spreads_its_points_as_it_says(suite_seed, name, dtype):
    there, back = BACK[name]
    points = there(square(suite_seed, dtype))
    assert points.dtype == dtype
    landed = np.clip(np.stack(back(points.astype(np.float64))), 0.0, 1.0)
    assert uniform(landed, 16) > sidak(len(BACK) * len(DTYPES))


@pytest.mark.statistical
def test_a_triangle_without_its_root_is_caught(suite_seed):
    """The broken twin: u where sqrt(u) belongs."""
    u = square(suite_seed, np.float64)
    wrong = np.stack((1 - u[0], u[1] * u[0]))
    assert uniform(np.stack(BACK["uniform_triangle"][1](wrong)), 16) < sidak(len(BACK) * len(DTYPES))


@both
@pytest.mark.parametrize("name", DENSITIES)
def test_a_constant_density_is_one_over_the_measure(suite_seed, name, dtype):
    pdf, value = DENSITIES[name]
    points = BACK[name][0](square(suite_seed, dtype, 1000) * dtype(0.999))
    inside = pdf(points)
    assert inside.dtype == dtype and np.allclose(inside, value, rtol=1e-6)


def test_the_densities_are_zero_where_nothing_lands():
    below = np.array([[0.6], [0.0], [-0.8]])
    assert warp.cosine_hemisphere_pdf(below) == 0 and warp.uniform_hemisphere_pdf(below) == 0
    assert warp.concentric_disk_pdf(np.array([[0.9], [0.9]])) == 0


@pytest.mark.parametrize("drop", [1e-12, 1e-6, 0.3, 1.0, 2.0])
def test_a_cones_density_is_one_over_its_solid_angle(drop):
    assert np.isclose(warp.uniform_cone_pdf(np.array([drop]))[0] * 2 * np.pi * drop, 1.0, rtol=1e-15)


@both
@pytest.mark.parametrize(
    "name", ["cosine_hemisphere", "uniform_hemisphere", "uniform_sphere", "uniform_cone"]
)
def test_every_corner_of_the_square_gives_a_unit_direction(name, dtype):
    last = 1.0 - (2.0**-24 if dtype == np.float32 else 2.0**-32)
    u = np.array(np.meshgrid([0.0, 0.25, 0.5, last], [0.0, 0.25, 0.5, last])).reshape(2, -1).astype(dtype)
    w = BACK[name][0](u)
    assert np.abs(length(w) - 1).max() < 4 * np.finfo(dtype).eps
    if "hemisphere" in name:
        assert (w[2] > 0).all(), "grazing is allowed, on the surface is not"


def many_normals(seed, dtype):
    """Directions everywhere, the axes among them with both signs of zero, and next to the poles."""
    n = np.random.default_rng(seed).normal(size=(3, 20_000))
    n = n / length(n)
    tiny = np.array([[1e-20, 0, -1e-9], [1e-20, -1e-9, 0], [-1, -1, 1.0]])
    axes = np.concatenate((np.eye(3), -np.eye(3)), axis=1)
    return np.concatenate((n, tiny, axes, -axes), axis=1).astype(dtype)


@both
def test_a_frame_is_right_handed_and_orthonormal_for_every_normal(suite_seed, dtype):
    """Within 4 roundings (Duff et al. 2017 measured 2.5 in float64, 1.4 in float32, of its own length)."""
    n = many_normals(suite_seed, dtype)
    frame = Frame.around(n)
    limit = 4 * np.finfo(dtype).eps
    for axis in frame:
        assert axis.dtype == dtype
        assert np.abs(length(axis.astype(np.float64)) - 1).max() < limit
    for a, b in ((frame.s, frame.t), (frame.t, frame.n), (frame.n, frame.s)):
        assert np.abs(dot(a.astype(np.float64), b.astype(np.float64))).max() < limit
    assert np.abs(cross(frame.s, frame.t) - frame.n).max() < limit


@both
def test_to_local_and_back_is_the_same_direction(suite_seed, dtype):
    n = many_normals(suite_seed, dtype)
    w = np.random.default_rng(suite_seed + 1).normal(size=n.shape)
    w = (w / length(w)).astype(dtype)
    frame = Frame.around(n)
    assert np.abs(frame.to_world(frame.to_local(w)) - w).max() < 16 * np.finfo(dtype).eps
    assert np.array_equal(frame.to_local(w)[2], dot(n, w))


def test_chi_square_is_calibrated(suite_seed):
    """Of p-values of true hypotheses, 5 % are below 5 %: between 2.5 % and 8 % of 1000."""
    rng = np.random.default_rng(suite_seed)
    p = [uniform(rng.random((1, 2000)), 16) for _ in range(1000)]
    assert 0.025 < np.mean(np.array(p) < 0.05) < 0.08
    assert chi_square([0, 3, 5], [0.0, 4.0, 4.0]) > 0.0
    assert chi_square([1, 3, 4], [0.0, 4.0, 4.0]) == 0.0
