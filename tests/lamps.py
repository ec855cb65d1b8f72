"""Scenes of one lamp over one point, and what the lamp sends there."""

import checks
import numpy as np

import tracer
from tracer import Settings
from tracer.definition import Surface
from tracer.frame import dot
from tracer.scene import Scene
from tracer.shape.mesh import Mesh

UP = np.array([0.0, 0.0, 1.0])

# Variance per sample of a floor point under a square lamp, by strategy and light sampling, by quadrature to
# 1e-11; `mis` spends two samples.
VARIANCES = {
    ("small", "light", "area"): 1.34122e-05,
    ("small", "light", "solid_angle"): 8.373657719e-07,
    ("small", "bsdf", "area"): 0.0680787,
    ("small", "mis", "area"): 1.500289538e-05,
    ("small", "mis", "solid_angle"): 2.777072650e-06,
    ("offset", "light", "area"): 4.06475e-05,
    ("offset", "light", "solid_angle"): 2.352293274e-06,
    ("offset", "bsdf", "area"): 0.0137298475,
    ("offset", "mis", "area"): 4.05805e-05,
    ("offset", "mis", "solid_angle"): 2.35017e-06,
    ("near", "light", "area"): 5.88455,
    ("near", "light", "solid_angle"): 0.124254,
    ("near", "bsdf", "area"): 0.0462163,
    ("near", "mis", "area"): 0.146387,
    ("near", "mis", "solid_angle"): 0.0390851,
    ("touching", "light", "solid_angle"): 0.3043374198,
    ("touching", "bsdf", "area"): 0.000510912,
    ("touching", "mis", "area"): 0.0234224,
    ("touching", "mis", "solid_angle"): 0.0501374,
}
MEANS = {"small": 0.0734776, "offset": 0.0139237, "near": 0.951424, "touching": 0.999489}


def sensor(origin=(0, 0, 9), target=(0, 0, 0), side=1):
    """A camera at `origin` that looks at `target`."""
    look = {"look_at": {"origin": list(origin), "target": list(target), "up": [0, 1, 0.1]}}
    film = {"width": side, "height": side}
    return {"type": "perspective", "fov": 40, "to_world": [look], "film": film}


def rectangle(center, half_u, half_v, towards=None, radiance=1.0):
    """A rectangle that shines to the side of the point `towards`."""
    center, u, v = (np.asarray(a, float) for a in (center, half_u, half_v))
    n = np.cross(u, v)
    flip = towards is not None and (np.asarray(towards) - center) @ n < 0.0
    matrix = np.eye(4)
    matrix[:3] = np.stack((u, v, n / np.sqrt(np.linalg.norm(n)), center), axis=1)
    emitter = {"type": "area", "radiance": radiance}
    return {"type": "rectangle", "to_world": matrix.tolist(), "flip_normals": bool(flip), "emitter": emitter}


def sphere(center, radius, radiance=1.0, **more):
    """A sphere that shines."""
    emitter = {"type": "area", "radiance": radiance}
    return {"type": "sphere", "center": list(center), "radius": radius, "emitter": emitter, **more}


def scene(*objects, camera=None):
    """A scene of these objects."""
    named = {f"object{k}": table for k, table in enumerate(objects)}
    return tracer.load_dict({"sensor": camera or sensor(), **named})


def mesh(vertices, faces, flip_normals=False):
    """A scene of triangles that shine with radiance 1 to the side from which they are counter-clockwise."""
    definition = scene(sphere([0, 0, 0], 1.0)).definition
    shape = Mesh("mesh", np.asarray(vertices, float), np.asarray(faces), flip_normals)
    return Scene(definition._replace(surfaces=(Surface(shape, definition.surfaces[0].bsdf, np.ones(3)),)))


def polygon(radius, height, sides):
    """Vertices and faces of a regular polygon around the z axis that faces downwards.

    What it sends is less than what the circle around it would send, and by no more than (pi/sides)^2 of that.
    """
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    rim = np.stack((radius * np.cos(angle), radius * np.sin(angle), np.full(sides, height)), axis=1)
    faces = np.stack((np.zeros(sides, int), 1 + np.roll(np.arange(sides), -1), 1 + np.arange(sides)), axis=1)
    return np.concatenate(([[0.0, 0.0, height]], rim)), faces


def disk(radius, height):
    """A scene of one disk, a polygon of 720 sides: within 2e-5."""
    return mesh(*polygon(radius, height, 720))


def numbers(seed, n, dtype, rows=3):
    """Numbers (rows, n) in [0, 1) as the sampler gives them."""
    bits = 24 if dtype == np.float32 else 32
    return (np.random.default_rng(seed).integers(0, 2**bits, (rows, n)) * 2.0**-bits).astype(dtype)


def light_samples(of, point, seed, n=100_000, precision=64, by="solid_angle", u=None):
    """n light samples for a receiver at `point` (3,), or one for each of points (3, n). u: numbers (3, n)."""
    # Not by `at`, which refuses pictures of lamps as small as some here.
    of = Scene(of.definition, Settings(precision=precision).dtype, light_sampling=by)
    point = np.asarray(point, float)
    p = np.repeat(point[:, None], n, axis=1) if point.ndim == 1 else point
    with np.errstate(all="ignore"):
        return of.sample_light(p.astype(of.dtype), numbers(seed, n, of.dtype) if u is None else u)


def irradiance(light, normal=UP):
    """Estimates (N,) of the irradiance on a surface with that normal: Le cos / pdf."""
    cos = np.maximum(dot(np.asarray(normal)[:, None], light.wi.astype(float)), 0.0)
    brought = np.divide(light.Le[0] * cos, light.pdf, out=np.zeros(cos.shape), where=light.pdf > 0.0)
    assert np.isfinite(brought).all()
    return brought


# One receiver under a square lamp (accuracy.md 2.6): half side, height, place of the receiver along x.
ROOMS = {
    "small": (0.5, 2.0, 0.0),
    "offset": (0.5, 1.0, 2.0),
    "near": (1.0, 0.25, 0.0),
    "touching": (2.0, 0.05, 0.0),
}


def floor(reflectance=1.0):
    """A large diffuse floor."""
    bsdf = {"type": "diffuse", "reflectance": reflectance}
    return {"type": "rectangle", "to_world": [{"scale": 50}], "bsdf": bsdf}


def room(name):
    """A white floor under the lamp, and a camera low over the floor that sees one point of it."""
    half, height, x = ROOMS[name]
    lamp = rectangle([0, 0, height], [half, 0, 0], [0, half, 0], towards=[0, 0, 0])
    return scene(lamp, floor(), camera=sensor([x + 0.03, 0.02, 0.02], [x, 0, 0]))


def radiance_samples(seed, of, strategy, by, spp, precision=64, **options):
    """Samples (spp,) of the one pixel of a scene, all through its centre."""
    settings = Settings(
        spp=spp, seed=seed, strategy=strategy, light_sampling=by, precision=precision, jitter=False,
        roulette="off", **{"max_depth": 2, **options},
    )  # fmt: skip
    return checks.samples(of, settings)[0, 0]


def variance_and_error(samples):
    """Variance, and its own relative standard error."""
    off = samples - samples.mean()
    square = (off**2).mean()
    return square, np.sqrt(((off**4).mean() / square**2 - 1) / samples.size)


def close(samples, value, sigmas=4.0, bar=0.01, slack=0.0):
    """Whether the mean of samples (N,) is the value but for `sigmas` standard errors, at most `bar` of it;
    a mean that is off by three times that (the broken twin) is not."""
    mean, error = samples.mean(), samples.std(ddof=1) / np.sqrt(samples.size)
    assert sigmas * error <= bar * abs(value) + 1e-300, f"standard error {error / value}"
    allowed = sigmas * error + (1e-12 + slack) * abs(value)
    for way in (-3.0, 3.0):
        assert abs((1.0 + way * bar) * mean - value) > allowed, "the fault is not seen"
    return abs(mean - value) <= allowed
