"""Where the time of a render goes: samples of what one process is at, hundreds of times a second."""

import signal
from collections import Counter

import tracer
from benchmarks import scenes
from benchmarks.section import in_turn, settings, short, table

EVERY = 1e-3  # seconds of processor time between two samples; many systems only manage 4e-3
REST = "everything else"
WHY = """Why the rest cannot be skipped in `cornell_unit`:

- *intersect, shadow rays*: walls that bound a convex room are met as one box, of which a ray from inside
  needs the exit only; walls and lamp never block, so a shadow ray asks the two boxes alone, only where
  light could arrive, and each from where its shadow may fall (a sixth and a third of the vertices). What
  is left is a slab test in each rotated box, which is as little as decides it: a tree over two boxes
  would test their bounds first, which is the same work.
- *light sample*: the solid angle of the lamp, by its four corners, at every vertex. `--light-sampling
  area` has a third of this cost and is as good in this room; beside a lamp it is not (*Rectangular
  lamps*), so it is not the default.
- *random numbers*: one hash of pixel, depth and use makes all numbers of that use. The lattice adds a
  product and a sum each.
- *bsdf and frames, light term, bounce*: one multiplication for each factor of the equation. Without Dirac
  lobes, textures, smooth normals or media nothing asks for them (`castray render cornell_unit
  --explain`).
- *lanes that leave*: paths that are over are carried along until it pays to move the others together.
  What is gathered, chosen or given a sign lane by lane is so without a branch (`tracer/lanes.py`).
- *the loop itself*: events are made of arrays that are there anyway; their cost is Python's, some 10,000
  calls a wave, and falls with the size of waves (*Paths in a wave*)."""
# A moment belongs to the first of these of which a function is under way, by file and start of its name.
STAGES = (
    ("random numbers", ("tracer/sampler",)),
    ("film", ("tracer/film.py", "tracer/engine/waves.py:collect")),
    ("shadow rays", ("tracer/scene.py:Scene.occluded",)),
    ("camera", ("tracer/camera.py", "tracer/integrator/wave.py:Wave.begin")),
    ("intersect", ("tracer/scene.py:Scene.intersect",)),
    (
        "hit",
        ("tracer/scene.py:Scene.hit", "tracer/scene.py:Scene.emission", "tracer/scene.py:Scene.environment"),
    ),
    ("light sample", ("tracer/scene.py:Scene.sample_light",)),
    ("bsdf and frames", ("tracer/bsdf/", "tracer/frame.py:Frame")),
    ("lanes that leave", ("tracer/integrator/wave.py:Wave.stop", "tracer/integrator/wave.py:Wave.end")),
    ("bounce: throughput, roulette, next ray", ("tracer/integrator/stages.py:go_on",)),
    ("light term and weights", ("tracer/integrator/stages.py:", "tracer/integrator/steps.py:")),
    ("the loop itself", ("tracer/integrator/",)),
)  # fmt: skip


def stage(frame):
    """The stage that a stack of frames is in."""
    stack = []
    while frame is not None:
        code = frame.f_code
        stack.append(f"{code.co_filename.replace(chr(92), '/')}:{code.co_qualname}")
        frame = frame.f_back
    return next((name for name, marks in STAGES if any(_marked(place, marks) for place in stack)), REST)


def _marked(place, marks):
    return any(f"/{mark}" in place for mark in marks)


def profile(work):
    """{stage: samples} of work(), by processor time."""
    counts = Counter()

    def look(_, frame):
        counts[stage(frame)] += 1

    before = signal.signal(signal.SIGPROF, look)
    signal.setitimer(signal.ITIMER_PROF, EVERY, EVERY)
    try:
        work()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
    return counts


def measure(size, say):
    """The table of stages for three scenes, in percent, and what a path costs in each."""
    asked, few = settings(size), settings(size, spp=size.mesh_spp)
    found = {
        "cornell_unit": (scenes.box(), asked),
        "cornell_glass": (tracer.load("cornell_glass"), asked),
        f"{20 * 4**size.brute:,} triangles": (scenes.box_with(scenes.ball(size.brute)), few),
    }
    times = in_turn({name: _render(*one) for name, one in found.items()}, size.repeats, say)
    shares, per_path = {}, {}
    for name, (scene, asked) in found.items():
        say(f"profile of {name}")
        shares[name] = _long_profile(scene, asked, size.moments)
        per_path[name] = f"{short(1e6 * times[name].median / (asked.spp * size.side**2))} µs"
    rows = [
        {"stage": one} | {name: _percent(of_one[one], of_one) for name, of_one in shares.items()}
        for one in (*(name for name, _ in STAGES), REST)
    ]
    rows.append({"stage": "one path, one process"} | per_path)
    rows.append({"stage": "kernel ms"} | {name: t.kernel for name, t in times.items()})
    return f"{table(rows)}\n\n{WHY}"


def _render(scene, asked):
    return lambda: tracer.render(scene, asked).seconds


def _long_profile(scene, asked, wanted):
    """Samples of as many renders as give so many of them."""
    counts = Counter()
    while counts.total() < wanted:
        counts += profile(lambda: tracer.render(scene, asked))
    return counts


def _percent(count, counts):
    return f"{100.0 * count / max(counts.total(), 1):.1f} %"
