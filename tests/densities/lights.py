"""Points on lamps and directions towards them, of every technique."""

from functools import cache, partial
from pathlib import Path

import lamps
import numpy as np
from lamps import numbers

import tracer
from densities.sampler import Sampler, even, longitude, square
from tracer import Settings
from tracer.frame import Frame
from tracer.light.constant import Constant
from tracer.light.envmap import Envmap
from tracer.light.sample import Ball

N = 60_000
CELLS = 8
TURN = [{"scale": [1.5, 0.6, 1]}, {"rotate": [1, 2, 3], "angle": 37.0}, {"translate": [0.3, -0.2, 0.5]}]
LAMPS = {
    "rectangle": {"type": "rectangle", "to_world": TURN},
    "cube": {"type": "cube", "to_world": [{"scale": [1.5, 0.6, 0.9]}, *TURN[1:]]},
    "sphere": {"type": "sphere", "radius": 0.8, "center": [0.3, -0.2, 0.5]},
    "tall box": {"type": "obj", "filename": "meshes/cornell_tall_box.obj", "to_world": [{"scale": 0.01}]},
}
FAR = np.array([3.0, 40.0, 20.0])  # a receiver
CONES = (1.001, 1.5, 10.0, 1e3)  # distances of a receiver from the middle of a sphere of radius 1
BALL = Ball(np.zeros(3), 2.0)


@cache
def room(*of):
    """A scene of lamps, each (name in LAMPS, radiance)."""
    objects = {
        f"lamp{k}": {**LAMPS[name], "emitter": {"type": "area", "radiance": radiance}}
        for k, (name, radiance) in enumerate(of)
    }
    scenes = Path(tracer.__file__).resolve().parents[1] / "scenes"
    return tracer.load_dict({"sensor": lamps.sensor(), **objects}, folder=str(scenes))


def by_area(name, precision, seed, n=N):
    return lamps.light_samples(room((name, 1.0)), FAR, seed, n, precision, "area")


def faces(name, precision, seed):
    """How often each face is chosen."""
    shape = room((name, 1.0)).shapes[0]
    return np.bincount(by_area(name, precision, seed).primitive, minlength=shape.primitives)


def areas(name):
    """The faces' shares of the area."""
    area = room((name, 1.0)).shapes[0].area()
    return area / area.sum()


def points(name, precision, seed):
    """Points of the largest face, in cells of its own coordinates."""
    scene, face = room((name, 1.0)), int(np.argmax(areas(name)))
    light = by_area(name, precision, seed, int(N / areas(name)[face]))
    q = light.q[:, light.primitive == face]
    a, b = scene.at(Settings(precision=precision)).uv(q, np.full(q.shape[1], face)).astype(np.float64)
    if name == "sphere":
        b = 0.5 - 0.5 * np.cos(np.pi * b)
    elif name == "tall box":  # barycentric coordinates of the second and third corner
        a, b = (a + b) ** 2, a / np.maximum(a + b, 1e-30)
    return square(np.stack((a, b)), CELLS, CELLS)


def in_a_cone(distance, precision, seed):
    """Directions to a sphere: around its axis, and by the share of the cone that is nearer to it."""
    axis = np.array([0.48, -0.6, 0.64])
    scene = lamps.scene(lamps.sphere([0, 0, 0], 1.0))
    wi = lamps.light_samples(scene, -distance * axis, seed, N, precision).wi.astype(np.float64)
    local = Frame.around(axis[:, None]).to_local(wi)
    drop = (local[0] ** 2 + local[1] ** 2) / (1.0 + local[2])  # 1 - cos, with its digits
    whole = (1.0 / distance) ** 2 / (1.0 + np.sqrt((1.0 - 1.0 / distance) * (1.0 + 1.0 / distance)))
    return square(np.stack((longitude(local), drop / whole)), CELLS, CELLS)


def on_a_rectangle(name, precision, seed):
    """Where directions to a square lamp meet it."""
    half, height, x = lamps.ROOMS[name]
    lamp = lamps.rectangle([0, 0, height], [half, 0, 0], [0, half, 0], towards=[0, 0, 0])
    light = lamps.light_samples(lamps.scene(lamp), [x, 0, 0], seed, N, precision)
    wi = light.wi.astype(np.float64)
    met = np.array([[x], [0.0]]) + wi[:2] * (height / wi[2])
    return square(0.5 * met / half + 0.5, CELLS, CELLS)


def solid_angles(name):
    """The shares of its cells in the solid angle, from that of rectangles with a corner over the receiver."""
    half, height, x = lamps.ROOMS[name]
    a, b = np.meshgrid(*(np.linspace(-half, half, CELLS + 1) - o for o in (x, 0.0)), indexing="ij")
    corner = np.arctan(a * b / (height * np.sqrt(a * a + b * b + height * height)))
    omega = corner[1:, 1:] - corner[:-1, 1:] - corner[1:, :-1] + corner[:-1, :-1]
    return (omega / omega.sum()).ravel()


def areas_of_cells(name):
    """The fault: uniform over the area."""
    return even(CELLS, CELLS)()


def sky(seed=0, rows=7, columns=12):
    """An image of a sky with a bright and a black patch."""
    image = np.random.default_rng(seed).random((rows, columns, 3)) ** 4
    image[2, 3] = 20.0
    image[3:6, 6:9] = 0.0
    return image


def ready_sky(precision, turn=None):
    turn = np.eye(3) if turn is None else turn
    return Envmap("sky", sky(), turn).ready({32: np.float32, 64: np.float64}[precision], BALL)


def around(light, seed, cells=(16, 32)):
    """Directions of a sky, by height and longitude."""
    n = 200_000
    wi = light.sample(np.zeros((3, n), light.dtype), numbers(seed, n, light.dtype, 2))[2].astype(np.float64)
    return square(np.stack((0.5 * wi[1] + 0.5, np.arctan2(wi[0], wi[2]) / (2 * np.pi) % 1.0)), *cells)


def of_density(light, fault=lambda d: 1.0, cells=(16, 32), points=48):
    """What a sky's density puts there, by 48 x 48 points a cell: it jumps where texels meet."""
    y, phi = ((np.arange(n * points) + 0.5) / (n * points) for n in cells)
    y, phi = (grid.ravel() for grid in np.meshgrid(2 * y - 1, 2 * np.pi * phi, indexing="ij"))
    r = np.sqrt(1 - y * y)
    d = np.stack((r * np.sin(phi), y, r * np.cos(phi)))
    density = (light.pdf(d) * fault(d)).reshape(cells[0], points, cells[1], points)
    return density.sum(axis=(1, 3)).ravel() * 4 * np.pi / d.shape[1]


def without_sine(light):
    """The fault: rows near the poles taken to be as long as the others."""
    shares = of_density(light, lambda d: np.sqrt(np.maximum(1 - d[1] ** 2, 0)))
    return shares / shares.sum()


def sphere_of_directions(precision, seed):
    """Directions of a constant sky."""
    dtype = {32: np.float32, 64: np.float64}[precision]
    light = Constant("sky", np.ones(3)).ready(dtype, BALL)
    wi = light.sample(np.zeros((3, N), dtype), numbers(seed, N, dtype, 2))[2].astype(np.float64)
    return square(np.stack((longitude(wi), 0.5 * wi[2] + 0.5)), CELLS, CELLS)


POWERS = (("rectangle", (1.0, 2.0, 3.0)), ("sphere", 0.5), ("cube", (4.0, 0.0, 0.0)))


def picks(precision, seed):
    """How often each of three lamps is chosen."""
    light = lamps.light_samples(room(*POWERS), FAR, seed, N, precision)
    return np.bincount(light.light, minlength=len(POWERS))


def powers():
    """Their shares of the luminous power."""
    of = np.array([0.212671, 0.715160, 0.072169])
    power = [
        (of * colour).sum() * shape.area().sum()
        for (_, colour), shape in zip(POWERS, room(*POWERS).shapes, strict=True)
    ]
    return np.array(power) / np.sum(power)


def samplers():
    for precision in (32, 64):
        bits = f"float{precision}"
        for name in LAMPS:
            if room((name, 1.0)).shapes[0].primitives > 1:
                yield Sampler(
                    f"area {name}, faces {bits}", partial(faces, name, precision), partial(areas, name)
                )
            yield Sampler(f"area {name} {bits}", partial(points, name, precision), even(CELLS, CELLS))
        for distance in CONES:
            yield Sampler(
                f"cone {distance:g} {bits}", partial(in_a_cone, distance, precision), even(CELLS, CELLS)
            )
        for name in lamps.ROOMS:
            yield Sampler(
                f"solid angle {name} {bits}",
                partial(on_a_rectangle, name, precision),
                partial(solid_angles, name),
                (("by area", partial(areas_of_cells, name)),) if name != "small" else (),
            )
        light = ready_sky(precision)
        yield Sampler(
            f"envmap {bits}",
            partial(around, light),
            partial(of_density, ready_sky(64)),
            (("without its sine", partial(without_sine, light)),),
        )
        yield Sampler(f"constant {bits}", partial(sphere_of_directions, precision), even(CELLS, CELLS))
        yield Sampler(f"choice by power {bits}", partial(picks, precision), powers)
