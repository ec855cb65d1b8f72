"""How time grows with the size of waves, samples, depth, triangles and lamps."""

import time
from contextlib import contextmanager
from dataclasses import replace
from importlib.util import find_spec

import numpy as np

import tracer
from benchmarks import scenes
from benchmarks.section import in_turn, settings, short, table
from tracer.engine import waves
from tracer.scene import Scene
from tracer.shape.rays import Rays
from tracer.testing.machine import kernel_seconds, peak_bytes

MESHES_ASKED = (
    "Asked: 1M triangles built in 10 s; a path at most 8 times of the first, 4 with Embree; the tree\n"
    "at least 20 times as fast as every triangle."
)
SEARCHES = ("bvh", "embree") if find_spec("embreex") else ("bvh",)


@contextmanager
def wave_size(lanes):
    """Waves of so many paths."""
    usual, waves.LANES = waves.LANES, lanes
    try:
        yield
    finally:
        waves.LANES = usual


def lanes(size, say):
    """Paths per second with waves of 512 to 262144 paths, and the memory they take."""
    scene, asked = scenes.box(), settings(size)

    def render(lanes):
        with wave_size(lanes):
            return tracer.render(scene, asked).seconds

    def memory(lanes):
        with wave_size(lanes):
            return peak_bytes(lambda: tracer.render(scene, asked))

    times = in_turn({n: lambda n=n: render(n) for n in size.lanes}, size.repeats, say)
    paths = asked.spp * size.side**2
    return table(
        [
            {
                "paths in a wave": f"{n:,}" + " (usual)" * (n == waves.LANES),
                "seconds": short(t.median),
                "kernel ms": t.kernel,
                "paths/s": short(paths / t.median),
                "memory, MiB": short(memory(n) / 2**20),
            }
            for n, t in times.items()
        ]
    )


def samples(size, say):
    """Paths per second against samples per pixel, and what a render costs beside its paths."""
    works = {n: lambda n=n: tracer.render(scenes.box(), settings(size, spp=n)).seconds for n in size.spps}
    times = in_turn(works, size.repeats, say)
    rows = [
        {
            "spp": n,
            "seconds": short(t.median),
            "kernel ms": t.kernel,
            "paths/s": short(n * size.side**2 / t.median),
        }
        for n, t in times.items()
    ]
    fixed, each = fixed_and_each(list(times), [t.median for t in times.values()])
    said = f"As a fixed time and one for each sample: {1e3 * fixed:.1f} ms + {1e3 * each:.2f} ms per spp."
    return f"{table(rows)}\n\n{said}"


def fixed_and_each(n, seconds):
    """(a, b) of seconds = a + b n, neither below 0, by least squares of relative errors."""
    from scipy.optimize import nnls

    n, seconds = np.asarray(n, float), np.asarray(seconds, float)
    (fixed, each), _ = nnls(np.stack((1.0 / seconds, n / seconds), axis=1), np.ones(n.size))
    return float(fixed), float(each)


def depth(size, say):
    """Time and rays per path against the longest path."""
    rays = {}

    def render(depth):
        picture = tracer.render(scenes.box(), settings(size, max_depth=depth))
        rays[depth] = picture.rays / picture.paths
        return picture.seconds

    times = in_turn({n: lambda n=n: render(n) for n in size.depths}, size.repeats, say)
    paths = size.spp * size.side**2
    return table(
        [
            {
                "max_depth": "unlimited" if n < 0 else n,
                "seconds": short(t.median),
                "kernel ms": t.kernel,
                "µs per path": short(1e6 * t.median / paths),
                "rays per path": short(rays[n]),
                "ns per ray": short(1e9 * t.median / paths / rays[n]),
            }
            for n, t in times.items()
        ]
    )


def triangles(size, say):
    """Build time and time per path against the number of triangles; the tree against brute force."""
    asked, meshes, built, works = settings(size, spp=size.mesh_spp), {}, {}, {}
    for level in size.levels:
        mesh = scenes.ball(level)
        n, meshes[level] = mesh.primitives, mesh
        say(f"{n:,} triangles: building")
        kernel, began = kernel_seconds(), time.perf_counter()
        scene = Scene(scenes.definition_with(mesh), np.float32)
        built[n] = time.perf_counter() - began, kernel
        for accel in SEARCHES:
            by = replace(asked, accel=accel)
            works[n, accel] = lambda scene=scene, by=by: tracer.render(scene, by).seconds
    times = in_turn(works, size.mesh_repeats, say)
    paths, rows = size.mesh_spp * size.side**2, []
    for n, (seconds, kernel) in built.items():
        row = {
            "triangles": f"{n:,}",
            "build, s": short(seconds),
            "kernel ms then": f"{1e3 * kernel:.2f}",
            "kernel ms": times[n, "bvh"].kernel,
        }
        for accel in SEARCHES:
            t, first = times[n, accel].median, times[next(iter(built)), accel].median
            row[f"{accel}: µs per path"] = short(1e6 * t / paths)
            row[f"{accel}: of the first"] = f"{t / first:.2f}"
        rows.append(row)
    brute = against_every_triangle(meshes[size.brute], size, say)
    return f"{table(rows)}\n\n{brute}\n\n{MESHES_ASKED}"


def against_every_triangle(mesh, size, say):
    """How many times as fast the camera's rays at the mesh are as a test of every triangle, in one line."""
    centre = mesh.vertices.mean(axis=0)
    random = np.random.default_rng(settings(size).seed)
    o = np.repeat(scenes.box().camera.origin[:, None], size.brute_rays, axis=1).astype(np.float32)
    d = (centre[:, None] + random.normal(scale=0.25, size=o.shape) - o).astype(np.float32)
    d /= np.linalg.norm(d, axis=0)
    nowhere = np.full(size.brute_rays, -1, np.int32)
    kernel = mesh.kernel(0, 4.0, np.float32)
    corners = [c.astype(np.float32) for c in mesh.corners()]
    with np.errstate(all="ignore"):
        times = in_turn(
            {
                "the tree": lambda: kernel.closest(Rays.towards(o, d, nowhere)),
                "every triangle": lambda: brute_force(corners, o, d),
            },
            min(size.mesh_repeats, 2),
            say,
        )
        found, wanted = kernel.closest(Rays.towards(o, d, nowhere))[0], brute_force(corners, o, d)[0]
    agree = np.mean(np.isfinite(found) == np.isfinite(wanted))
    ratio = times["every triangle"].median / times["the tree"].median
    each = [f"{name} {short(1e6 * t.median / size.brute_rays)} µs per ray" for name, t in times.items()]
    kernel = times["the tree"].kernel
    return (
        f"{mesh.primitives:,} triangles, {size.brute_rays:,} rays: {', '.join(each)} (kernel {kernel} ms): "
        f"{ratio:.0f} times; both say the same of {100 * agree:.2f} % of the rays."
    )


def brute_force(corners, o, d, chunk=1 << 20):
    """Distance (N,) from o along d, both (3, N), to the nearest of all triangles, and which.

    (Moeller and Trumbore 1997), triangle by ray in NumPy, in pieces that stay in the cache.
    """
    a, e1, e2 = (c.T[:, :, None] for c in corners)
    t, face = np.full(o.shape[1], np.inf, o.dtype), np.full(o.shape[1], -1)
    step = max(1, chunk // o.shape[1])
    for begin in range(0, len(a), step):
        found = _distances(*(c[begin : begin + step] for c in (a, e1, e2)), o, d)
        best = np.argmin(found, axis=0)
        nearest = found[best, np.arange(t.size)]
        nearer = nearest < t
        t[nearer], face[nearer] = nearest[nearer], begin + best[nearer]
    return t, face


def _distances(a, e1, e2, o, d):
    """Distances (T, N) along rays to triangles given by a corner and two sides, (T, 3, 1) each."""
    p = _cross(d, e2)
    inverse = 1.0 / _dot(e1, p)
    s = o - a
    u = _dot(s, p) * inverse
    q = _cross(s, e1)
    v = _dot(d[None], q) * inverse
    t = _dot(e2, q) * inverse
    hit = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t > 0.0)
    return np.where(hit, t, np.inf)


def _dot(a, b):
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def _cross(a, b):
    a = a if a.ndim == 3 else a[None]
    x = a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1]
    y = a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]
    return np.stack((x, y, a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), axis=1)


def lamps(size, say):
    """Load time and time per path against the number of lamps, all of one brightness together."""
    made, loaded = {}, {}
    for n in size.lamps:
        say(f"{n} lamps: loading")
        began = time.perf_counter()
        made[n] = tracer.load_dict(scenes.lit_by(n)).at(settings(size))
        loaded[n] = time.perf_counter() - began
    works = {n: lambda n=n: tracer.render(made[n], settings(size)).seconds for n in size.lamps}
    times = in_turn(works, size.repeats, say)
    first = next(iter(times.values())).median
    return table(
        [
            {
                "lamps": f"{n:,}",
                "load, s": short(loaded[n]),
                "render, s": short(t.median),
                "kernel ms": t.kernel,
                "µs per path": short(1e6 * t.median / (size.spp * size.side**2)),
                "of the first": f"{t.median / first:.2f}",
            }
            for n, t in times.items()
        ]
    )
