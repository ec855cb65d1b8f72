"""castray's samplers beside others, how fast their errors fall, and what a sample of a lamp is worth."""

from unittest.mock import patch

import lamps
import numpy as np
import samplers

import tracer
from benchmarks import scenes
from benchmarks.section import SEED, settings, short, table
from tracer.engine import plan

RARE = {("touching", "bsdf", "area")}  # a bounce in 2000 misses the lamp: eight times the samples


def measure(size, say):
    """On a diffuse scene and on one with glass."""
    scenes = [tracer.load(name) for name in ("cornell_unit", "cornell_glass")]
    names, side, seeds = list(samplers.SAMPLERS), max(size.side // 2, 4), size.repeats + 1
    return table(
        [row for scene in scenes for row in samplers.rows(scene, names, side, size.spps[-3:], seeds, say)]
    )


def slopes(size, say):
    """The root mean square error of whole pictures against samples, and the slope of a line through it."""
    rows = []
    for sampler, asked in (("independent", "-0.5"), ("lattice", "below -0.6")):
        errors = {}
        for spp in size.error_spps:
            say(f"{sampler}: {spp} spp")
            pictures = [
                tracer.render(scenes.box(), settings(size, spp=spp, sampler=sampler, seed=SEED + k)).rgb
                for k in range(size.error_seeds)
            ]
            errors[spp] = np.sqrt(np.var(pictures, axis=0, ddof=1, dtype=np.float64).mean())
        slope = np.polyfit(np.log(list(errors)), np.log(list(errors.values())), 1)[0]
        found = {f"{spp} spp": short(error) for spp, error in errors.items()}
        rows.append({"sampler": sampler, **found, "slope": f"{slope:+.3f}", "asked": asked})
    return table(rows)


def rectangles(size, say):
    """Variance of a sample, by way to find the lamp, over what it is known to be."""
    rows = []
    for (name, strategy, by), known in lamps.VARIANCES.items():
        say(f"{name}: {strategy}, {by}")
        spp = size.lamp_spp * (8 if (name, strategy, by) in RARE else 1)
        samples = lamps.radiance_samples(SEED, lamps.room(name), strategy, by, spp)
        variance, error = lamps.variance_and_error(samples)
        rows.append(
            {
                "lamp": name,
                "strategy": strategy,
                "light sampling": by if strategy != "bsdf" else "-",
                "variance": f"{variance:.4g}",
                "known": f"{known:.4g}",
                "off by": f"{variance / known - 1:+.2%} ± {error:.2%}",
            }
        )
    return table(rows)


def sharing(size, say):
    """Errors of adaptive pictures over those of even ones, by the power that shares samples out."""
    rows = []
    for scene in map(tracer.load, ("cornell_unit", "cornell_glass")):
        for sampler in ("lattice", "independent"):
            even = _errors(size, scene, sampler, "off")
            for goal in plan.GOALS[1:]:
                found = {}
                for name, power in (("1/2", 0.5), ("1/3", 1.0 / 3.0), ("1/4", 0.25), ("1/5", 0.2)):
                    say(f"{scene.name}: {sampler}, {goal}, {name}")
                    with patch.object(plan, "POWER", power):
                        ratios = _errors(size, scene, sampler, goal) / even
                    found[f"power {name}"] = " / ".join(f"{ratio:.2f}" for ratio in ratios)
                rows.append({"scene": scene.name, "sampler": sampler, "goal": goal, **found})
    return table(rows)


def _errors(size, scene, sampler, goal):
    """MSE and relMSE (2,) of pictures, as the scatter between seeds."""
    side = size.side * 3 // 8
    pictures = [
        tracer.render(
            scene,
            settings(size, width=side, height=side, spp=size.sharing_spp, sampler=sampler, seed=SEED + k),
            adaptive=goal,
        ).rgb
        for k in range(size.error_seeds)
    ]
    variance = np.var(pictures, axis=0, ddof=1, dtype=np.float64)
    mean = np.mean(pictures, axis=0, dtype=np.float64)
    return np.array([variance.mean(), (variance / (mean * mean + plan.DARK)).mean()])
