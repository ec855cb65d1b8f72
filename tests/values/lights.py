"""What lamps send to a receiver, and the solid angles they cover."""

import lamps
import numpy as np
from meshes import icosphere

from tracer.light import rectangle as of_rectangle
from tracer.light import sphere as of_sphere
from tracer.shape.mesh import Mesh
from values.registry import DTYPES, Estimate, estimator, kernel

LIGHT = {"center": [0, 0, 2], "half_u": [0.5, 0, 0], "half_v": [0, 0.5, 0]}
WALL = {"center": [0, 0, 0.5], "half_u": [0, 0.5, 0], "half_v": [0, 0, 0.5]}


def rectangle_case(key, given):
    """Lamp, receiver, its normal, and the factor from irradiance to the value."""
    factor = given["rho"] / np.pi if "rho" in given else 1.0
    if "corner" in key:
        a, b, h = given["a"], given["b"], given["h"]
        lamp = {"center": [a / 2, b / 2, h], "half_u": [a / 2, 0, 0], "half_v": [0, b / 2, 0]}
        return lamp, [0, 0, 0], lamps.UP, factor
    lamp = WALL if "touching" in key else LIGHT
    if "light_center" in given:
        lamp = {"center": given["light_center"], "half_u": given["half_u"], "half_v": given["half_v"]}
    return lamp, given["point"], given.get("normal", lamps.UP), factor


def from_rectangle(key, given, bits, seed, n, by="solid_angle"):
    lamp, point, normal, factor = rectangle_case(key, given)
    scene = lamps.scene(lamps.rectangle(**lamp, towards=point))
    light = lamps.light_samples(scene, point, seed, n, bits, by)
    return factor * lamps.irradiance(light, normal)


NEARER = ("touching_floor.d=1e-6", "touching_floor.d=1e-12")
estimator("rect.", but=("edge_on", *NEARER), n=200_000)(from_rectangle)
estimator(*(f"rect.wall_{near}" for near in NEARER), n=200_000, only=64, why="float32 cannot tell it from 0")(
    from_rectangle
)


@kernel("rect.edge_on")
def edge_on(key, given, to):
    """No sample brings anything: their sum."""
    lamp = lamps.rectangle(*(given[k] for k in ("light_center", "half_u", "half_v")))
    scene, ways = lamps.scene(lamp), ("area", "solid_angle")
    both = (lamps.light_samples(scene, [0, 0, 0], 0, 10_000, to.bits, by) for by in ways)
    return sum(lamps.irradiance(light).sum() for light in both)


TINY = "sphere.R=1e-6.d=1.tilt=60"


@estimator(TINY, n=400_000, only=64, why="float32 cannot hold so small a sphere there, and says so")
@estimator("sphere.R=", but=("tilt=119", TINY.removeprefix("sphere.")), n=400_000)
def from_sphere(key, given, bits, seed, n, u=None):
    """The sphere above the receiver, whose normal is tilted away from it."""
    tilt = np.radians(given["tilt_deg"])
    scene = lamps.scene(lamps.sphere([0, 0, given["d"]], given["R"]))
    light = lamps.light_samples(scene, [0, 0, 0], seed, n, bits, u=u)
    return lamps.irradiance(light, np.array([np.sin(tilt), 0.0, np.cos(tilt)]))


@estimator("sphere.R=1.d=2.tilt=119", n=400_000)
def from_sphere_above_the_horizon(key, given, bits, seed, n):
    """One direction in 2000 is above the horizon, so most samples are spent where a first round found those.

    Cells of the two random numbers that brought anything, and all cells beside them, get half of the samples;
    the rest of the square gets the others, so that nothing is left out.
    """
    cells, dtype = 64, DTYPES[bits]
    first = lamps.numbers(seed + 1, n, dtype)
    found = from_sphere(key, given, bits, seed, n, first) > 0.0
    place = (first[1:] * cells).astype(int)
    bright = np.zeros((cells, cells), bool)
    bright[place[0][found], place[1][found]] = True
    near = np.zeros_like(bright)
    for down in (-1, 0, 1):
        for across in (-1, 0, 1):
            near |= np.roll(bright, (down, across), (0, 1))
    share, total, square = near.mean(), 0.0, 0.0
    rng, u = np.random.default_rng(seed), lamps.numbers(seed, n // 2, dtype)
    for part, of in ((near, share), (~near, 1.0 - share)):
        cell = np.argwhere(part)[rng.integers(0, part.sum(), n // 2)].T
        u[1:] = (cell + lamps.numbers(rng.integers(2**31), n // 2, dtype, 2)) / cells
        estimate = Estimate.of(of * from_sphere(key, given, bits, seed, n // 2, u))
        total, square = total + estimate.mean, square + estimate.error**2
    return Estimate(total, np.sqrt(square))


@kernel("point.d=")
def from_point(key, given, to):
    tilt = np.radians(given["tilt_deg"])
    position = [given["d"] * np.sin(tilt), 0.0, given["d"] * np.cos(tilt)]
    scene = lamps.scene({"type": "point", "position": position, "intensity": 1.0}, {"type": "rectangle"})
    light = lamps.light_samples(scene, [0, 0, 0], 0, 1, to.bits)
    return (light.Le[0] * light.wi[2] / light.pdf)[0]


@kernel("solidangle.rect.")
def of_a_rectangle(key, given, to):
    a, b, h = given["half_a"], given["half_b"], given["h"]
    seen = [to([x]) for x in (-a, a, -b, b, h, 2 * a, 2 * b)]
    return of_rectangle.solid_angle(of_rectangle.Seen(*seen))[0]


@kernel("solidangle.cone.")
def of_a_sphere(key, given, to):
    return 2.0 * np.pi * of_sphere.one_minus_cos(to(given["sin"]), to([1.0]))[0]


def covered(light):
    """Estimates (n,) of the solid angle a lamp covers: one over the density."""
    return np.divide(1.0, light.pdf, out=np.zeros(light.pdf.shape), where=light.pdf > 0.0)


@estimator("solidangle.tri.", n=400_000)
def of_a_triangle(key, given, bits, seed, n):
    """Triangles are sampled by area; the mean of one over the density is what they cover."""
    scene = lamps.mesh(given["vertices"], [[0, 1, 2]], flip_normals=True)
    return covered(lamps.light_samples(scene, [0, 0, 0], seed, n, bits))


@estimator("mesh.icosphere.sub=4.solid_angle", n=100_000)
def of_a_closed_mesh(key, given, bits, seed, n):
    """Seen from inside, every direction meets it once."""
    scene = lamps.mesh(*icosphere(given["subdivisions"]), flip_normals=True)
    return covered(lamps.light_samples(scene, [0.2, -0.1, 0.3], seed, n, bits))


@kernel("mesh.icosphere.sub=3.area", only=64, why="the tables of a scene's faces are made in float64")
def area_of_a_mesh(key, given, to):
    return Mesh("ball", *icosphere(given["subdivisions"])).area().sum()


@estimator("nori.polylum", n=200_000)
def from_a_triangle(key, given, bits, seed, n):
    """A triangle that shines to the receiver's side, over a floor that faces +y."""
    a, b, c = np.array(given["vertices"])
    scene = lamps.mesh([a, b, c], [[0, 1, 2]], flip_normals=bool(np.cross(b - a, c - a) @ a > 0.0))
    light = lamps.light_samples(scene, [0, 0, 0], seed, n, bits)
    return given["rho"] / np.pi * lamps.irradiance(light, np.array([0.0, 1.0, 0.0]))


@estimator("disk.coaxial.", n=100_000, slack=2e-5)
def from_a_disk(key, given, bits, seed, n):
    scene = lamps.disk(given["r"], given["h"])
    return lamps.irradiance(lamps.light_samples(scene, [0, 0, 0], seed, n, bits))


@estimator("ff.disks.", n=1_000_000, slack=2e-5, dear=True)
def between_disks(key, given, bits, seed, n):
    """Receivers all over one disk, the other shines: irradiance over pi."""
    rng = np.random.default_rng(seed + 1)
    r, phi = given["r1"] * np.sqrt(rng.random(n)), 2.0 * np.pi * rng.random(n)
    p = np.stack((r * np.cos(phi), r * np.sin(phi), 0.0 * r))
    return (
        lamps.irradiance(lamps.light_samples(lamps.disk(given["r2"], given["h"]), p, seed, n, bits)) / np.pi
    )


@estimator("ff.parallel.", n=200_000)
def between_opposite_rectangles(key, given, bits, seed, n):
    a, b, c = given["a"], given["b"], given["c"]
    lamp = lamps.rectangle([0, 0, c], [a / 2, 0, 0], [0, b / 2, 0], towards=[0, 0, 0])
    return over_a_floor(lamp, (-a / 2, a / 2), (-b / 2, b / 2), bits, seed, n)


@estimator("ff.perp.", n=200_000)
def between_a_floor_and_a_wall(key, given, bits, seed, n):
    """The wall of height h stands on the edge x = 0 of a floor w wide; both are l long."""
    length, w, h = given["l"], given["w"], given["h"]
    wall = lamps.rectangle([0, 0, h / 2], [0, length / 2, 0], [0, 0, h / 2], towards=[1, 0, h / 2])
    return over_a_floor(wall, (0, w), (-length / 2, length / 2), bits, seed, n)


def over_a_floor(lamp, x, y, bits, seed, n):
    """Irradiance over pi (n,) at random points of a rectangle of the floor."""
    u = np.random.default_rng(seed + 1).random((2, n))
    p = np.stack((x[0] + (x[1] - x[0]) * u[0], y[0] + (y[1] - y[0]) * u[1], 0.0 * u[0]))
    return lamps.irradiance(lamps.light_samples(lamps.scene(lamp), p, seed, n, bits)) / np.pi


@estimator("ff.hottel2d.", n=200_000)
def between_strips(key, given, bits, seed, n):
    """Strips along y, cut off 1e4 away: 1e-8 of the lamp."""
    (x0, _), (x1, _) = given["P"]
    ends = [np.array([x, 0.0, z]) for x, z in given["Q"]]
    middle, half = 0.5 * (ends[1] + ends[0]), 0.5 * (ends[1] - ends[0])
    lamp = lamps.rectangle(middle, half, [0, 1e4, 0], towards=[0.5 * (x0 + x1), 0, 0])
    return over_a_floor(lamp, (x0, x1), (0.0, 0.0), bits, seed, n)


@estimator("mirror_image.rect.", n=100_000)
def with_its_image(key, given, bits, seed, n):
    """The lamp and its image in an upright mirror: light samples for the first, bounces for the second."""
    lamp = lamps.rectangle(**LIGHT, towards=[0, 0, 0])
    mirror = lamps.rectangle([given["mirror_x"], 0, 1], [0, 0, 1], [0, 1, 0], towards=[0, 0, 1])
    mirror.pop("emitter")
    mirror["bsdf"] = {"type": "conductor", "specular_reflectance": given["r"]}
    scene = lamps.scene(lamp, mirror, lamps.floor(), camera=lamps.sensor([0.03, 0.02, 0.02], [0, 0, 0]))
    return np.pi * lamps.radiance_samples(seed, scene, "mis", "solid_angle", n, bits, max_depth=3)


# Strategy, way of sampling the lamp, and heuristic of keys var.TECHNIQUE.ROOM.
TECHNIQUES = {
    "bsdf": ("bsdf", "area", "power"),
    "bsdf.mc": ("bsdf", "area", "power"),
    "solidangle": ("light", "solid_angle", "power"),
    "mis.power2.area": ("mis", "area", "power"),
    "mis.power2.solid": ("mis", "solid_angle", "power"),
    "mis.balance.area": ("mis", "area", "balance"),
    "mis.balance.solid": ("mis", "solid_angle", "balance"),
}


@estimator("var.", but=("bsdf", "balance"), n=1 << 18)
@estimator("var.bsdf.", "var.mis.balance.", n=1 << 20, dear=True)
def of_an_estimator(key, given, bits, seed, n):
    """The variance of one sample (bsdf.mc: its mean) under a square lamp."""
    technique, _, name = key.removeprefix("var.").rpartition(".")
    strategy, by, heuristic = TECHNIQUES[technique]
    samples = lamps.radiance_samples(seed, lamps.room(name), strategy, by, n, bits, heuristic=heuristic)
    if technique == "bsdf.mc":
        return samples
    variance, error = lamps.variance_and_error(samples)
    return Estimate(variance, variance * error)
