"""The sections of BENCHMARKS.md, in its order. `tests/bench.py` measures all but the race."""

from benchmarks import engines, looking, programs, sampling, scaling, stages
from benchmarks.section import Section

BENCH = (
    Section(
        "stages",
        "Where the time goes",
        "Samples of what one process is at, a few milliseconds of processor time apart, in percent. A\n"
        "moment belongs to the first line of which a function is under way.",
        stages.measure,
    ),
    Section(
        "lanes",
        "Paths in a wave",
        "The unit box, 128 x 128, 16 spp, depth 8, one process, with waves of different sizes. Memory is\n"
        "the most that Python and NumPy held at once.",
        scaling.lanes,
    ),
    Section(
        "samples",
        "Samples per pixel",
        "The unit box, 128 x 128, depth 8, one process.",
        scaling.samples,
    ),
    Section(
        "depth",
        "Longest path",
        "The unit box, 128 x 128, 16 spp, one process.",
        scaling.depth,
    ),
    Section(
        "samplers",
        "Samplers",
        "castray's two beside others, depth 8, one process, 64 pixels across; `python tests/samplers.py -h`\n"
        "says which. MSE is the variance between seeds, time that of the processor; ratios are to the\n"
        "independent sampler.",
        sampling.measure,
    ),
    Section(
        "slopes",
        "How fast the error falls",
        "Root mean square error of the unit box, 128 x 128, depth 8, as the scatter between seeds, which\n"
        "needs no reference, and the slope of a line through its logarithms.",
        sampling.slopes,
    ),
    Section(
        "sharing",
        "Samples where the error is",
        "MSE and relMSE of pictures with `--adaptive`, 48 x 48, 64 spp, depth 8, over those with the same\n"
        "number of samples everywhere, as the scatter between seeds, by the power of the variance with\n"
        "which samples are shared out. castray uses 1/4: where rare bright samples decide (glass), 1/2\n"
        "spends most of them around those that it happened to see.",
        sampling.sharing,
    ),
    Section(
        "rectangles",
        "Rectangular lamps",
        "Variance of one sample of a floor point under a square lamp, by the ways to find it (`mis` spends\n"
        "two samples), beside the exact values (by quadrature to 1e-11), with one standard error. Asked:\n"
        "within 5 %. By area it knows no bounds where lamp and floor touch, so `solid_angle` is the default.",
        sampling.rectangles,
    ),
    Section(
        "triangles",
        "Triangles",
        "The unit box with a sphere of triangles in place of the tall box, 128 x 128, 4 spp, depth 8, one\n"
        "process.",
        scaling.triangles,
    ),
    Section(
        "lamps",
        "Lamps",
        "The unit box with many small rectangles under the ceiling, as bright together as its lamp,\n"
        "128 x 128, 16 spp, depth 8, one process.",
        scaling.lamps,
    ),
    Section(
        "engines",
        "Two engines",
        "128 x 128, 16 spp, depth 8. Seconds are of tracing alone, with children that are up; how long the\n"
        "shader takes to be ready stands beside them. Paths are the same if their first five vertices are\n"
        "(`tests/same_paths.py`).",
        engines.measure,
    ),
    Section(
        "start",
        "Starting",
        "Whole processes from the shell, and imports as a fresh interpreter measures them; medians of 9, by\n"
        "turns.",
        programs.start,
    ),
    Section(
        "whole",
        "From the shell to a picture",
        "`castray render`, depth 8, as a process of its own: start, scene, picture and PNG together.",
        programs.whole,
    ),
    Section(
        "recorder",
        "Recording",
        "The unit box, 128 x 128, 16 spp, depth 8, one process: a plain render, the same loop with every\n"
        "event looked at and dropped, with a row of each path kept on disk, and with every event kept there.",
        looking.recorder,
    ),
    Section(
        "pick",
        "Picking and stepping",
        "Picks at 16 spp, of 25 pixels, and steps along a picked path, as the viewer's server does them.",
        looking.pick,
    ),
)
VIEWER = Section(
    "viewer",
    "The viewer",
    "`python tests/bench_viewer.py`: from an input to the frame on the screen that shows all it changed, in\n"
    "Chromium with software GL on the same machine; 20 times each.",
    None,
)
