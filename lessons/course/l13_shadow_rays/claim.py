"""What single precision leaves of a comparison of two equal distances, and which tolerance helps."""

from collections import deque

import numpy as np

from lessons import zoo
from lessons.zoo.light import EPSILON
from lessons.zoo.rounding import NEAR, shadow_distances
from tracer.engine import waves
from tracer.integrator.wave import Wave
from tracer.settings import Settings

SIDE = 40  # pixels along each side of the picture in which light samples are counted
TOLERANCE = 1e-4  # relative: far above rounding, far below anything one could see


def experiment(run):
    """Lengths in millimetres, as the homework has them; shares in percent."""
    light = run.event("start")
    r = np.float32(light["distance"])
    assert light["visible"] and not run.event("mistake")["visible"]
    assert run.event("shadow")["blocker"] == "tall_box"

    free = {name: compared(run, name) for name in ("cornell", "cornell_unit")}
    lost = {name: (t < far).mean() for name, (t, far, _) in free.items()}
    t, far, height = free["cornell"]
    assert 0.4 < lost["cornell"] < 0.65
    assert (t >= far * (1.0 - TOLERANCE)).all()  # a tolerance that grows with the distance loses none
    gaps = np.abs(t - far) / np.spacing(far)
    assert np.median(gaps) < 2.0  # all that is wrong is rounding, more of it where the lamp is seen edge-on

    fine = compared(run, "cornell", precision=64)
    assert 0.1 < (fine[0] < fine[1]).mean()  # more digits do not help: rounding has a sign as well

    assert np.spacing(np.float32(300.0)) > EPSILON > np.spacing(np.float32(2.0))
    bound = float(hits(run)[0].bound[0])
    return {
        "gap": float(np.spacing(r)),
        "epsilon": float(np.finfo(np.float32).eps),
        "epsilon_times": float(np.finfo(np.float32).eps * r),
        "gap_double": float(np.spacing(np.float64(r))),
        "half_gap": float(np.spacing(r)) / 2.0,
        "lost": 100.0 * lost["cornell"],
        "lost_floor": 100.0 * (t < far)[height == 0.0].mean(),
        "lost_double": 100.0 * (fine[0] < fine[1]).mean(),
        "tolerance": EPSILON,
        "relative": TOLERANCE,
        "unit_gap": float(np.spacing(np.float32(1.0))),
        "usual_gaps": float(np.median(gaps)),
        "most_gaps": float(gaps.max()),
        "offset": bound,
        "stuck": float(run.event("acne")["t"]),
    }


def compared(run, scene, **options):
    """The distances that a shadow test compares, where nothing is in the way: of the first hit, of the
    lamp's point, and the height of the surface, each (N,)."""
    found = []

    def test(prepared, hit, light):
        t, r = shadow_distances(prepared, hit, light)
        free = (t >= light.distance * (1.0 - NEAR)) & (light.pdf > 0.0)
        found.append((t[free], r[free], hit.p[1, free]))
        return zoo.RIGHT.visibility(prepared, hit, light)

    first_vertices(run, scene, zoo.changed(visibility=test), **options)
    return tuple(np.concatenate(part) for part in zip(*found, strict=True))


def hits(run):
    """What light is sampled at in the picture of the lesson."""
    found = []

    def note(prepared, hit, light):
        found.append(hit)
        return zoo.RIGHT.visibility(prepared, hit, light)

    first_vertices(run, "cornell", zoo.changed(visibility=note))
    return found


def first_vertices(run, scene, steps, **options):
    """Trace one path to its first light sample in each pixel of a small picture."""
    settings = Settings(
        width=SIDE, height=SIDE, spp=1, integrator="direct", max_depth=2, light_sampling="area", **options
    )
    y, x = np.divmod(np.arange(SIDE * SIDE), SIDE)
    wave = Wave(x, y, np.zeros_like(x), settings, steps)
    deque(waves.events(run.scene(scene).at(settings), settings, wave), maxlen=0)
