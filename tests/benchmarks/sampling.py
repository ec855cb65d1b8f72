"""castray's samplers beside others."""

import samplers

import tracer
from benchmarks.section import table


def measure(size, say):
    """On a diffuse scene and on one with glass."""
    scenes = [tracer.load(name) for name in ("cornell_unit", "cornell_glass")]
    names, side, seeds = list(samplers.SAMPLERS), max(size.side // 2, 4), size.repeats + 1
    return table(
        [row for scene in scenes for row in samplers.rows(scene, names, side, size.spps[-3:], seeds, say)]
    )
