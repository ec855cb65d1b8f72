"""Scenes of one lamp over one point, and what the lamp sends there."""

import json
from functools import cache
from pathlib import Path

import numpy as np

import tracer
from tracer import Settings
from tracer.frame import dot

UP = np.array([0.0, 0.0, 1.0])


@cache
def truth():
    """tests/truth.json by key."""
    entries = json.loads((Path(__file__).parent / "truth.json").read_text(encoding="utf-8"))
    return {entry["key"]: entry for entry in entries}


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


def numbers(seed, n, dtype, rows=3):
    """Numbers (rows, n) in [0, 1) as the sampler gives them."""
    bits = 24 if dtype == np.float32 else 32
    return (np.random.default_rng(seed).integers(0, 2**bits, (rows, n)) * 2.0**-bits).astype(dtype)


def light_samples(of, point, seed, n=100_000, precision=64, by="solid_angle"):
    """Light samples for a receiver at `point`, and the scene that gave them."""
    of = of.at(Settings(precision=precision, light_sampling=by))
    p = np.repeat(np.asarray(point, float)[:, None], n, axis=1).astype(of.dtype)
    with np.errstate(all="ignore"):
        return of.sample_light(p, numbers(seed, n, of.dtype))


def irradiance(light, normal=UP):
    """Estimates (N,) of the irradiance on a surface with that normal: Le cos / pdf."""
    cos = np.maximum(dot(np.asarray(normal)[:, None], light.wi.astype(float)), 0.0)
    brought = np.divide(light.Le[0] * cos, light.pdf, out=np.zeros(cos.shape), where=light.pdf > 0.0)
    assert np.isfinite(brought).all()
    return brought


def close(samples, value, sigmas=4.0, bar=0.01, slack=0.0):
    """Whether the mean of samples (N,) is the value but for `sigmas` standard errors, at most `bar` of it."""
    error = samples.std(ddof=1) / np.sqrt(samples.size)
    assert sigmas * error <= bar * abs(value) + 1e-300, f"standard error {error / value}"
    return abs(samples.mean() - value) <= sigmas * error + (1e-12 + slack) * abs(value)
