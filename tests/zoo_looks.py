"""What each bug of the zoo does to a picture, or to the events behind it, as numbers to be tested.

A look gives independent numbers (K,), one for each sample, pixel or path. Those of the wrong tracer minus
those of the right one have the sign that the bug's symptom says. Both draw the same random numbers, so that
most of the noise cancels.
"""

from functools import partial

import numpy as np
from cases import loaded
from checks import HOMEWORK, samples

from tracer.engine import waves
from tracer.events import END_REASONS, LOBES
from tracer.frame import dot
from tracer.integrator.wave import Wave

MORE, LESS, OTHER = 1, -1, 0
LAMP = (0.44, 0.14, 0.56, 0.2)
ROUND_THE_LAMP = (0.36, 0.1, 0.64, 0.2)
METAL_BALLS = (0.1, 0.45, 0.5, 0.75)
GLASS_BALL = (0.55, 0.6, 0.85, 0.95)
BELOW_THE_LAMP = (0.0, 0.25, 1.0, 1.0)
LEFT, BACK = (HOMEWORK[name][0] for name in ("left wall", "back wall"))
EVERYTHING = (0.0, 0.0, 1.0, 1.0)
BOTTOM = (0.0, 0.9, 1.0, 1.0)


def picture(bug, steps, seed, side=32, spp=8, inside=EVERYTHING, **options):
    """Samples (P, spp) of the pixels in a part (x0, y0, x1, y1) of the bug's scene, mean of the channels."""
    settings = bug.asked(width=side, height=side, spp=spp, seed=seed, **options)
    y, x = (np.stack(np.divmod(np.arange(side * side), side)) + 0.5) / side
    x0, y0, x1, y1 = inside
    pixels = np.flatnonzero((x >= x0) & (x < x1) & (y >= y0) & (y < y1))
    return samples(loaded(bug.scene), settings, steps, pixels).mean(axis=0)


def light(bug, steps, seed, **part):
    """Every sample."""
    return picture(bug, steps, seed, **part).ravel()


def clipped(bug, steps, seed, most=100.0, **part):
    """Every sample, but none above `most`: rare bright ones would drown the rest."""
    return np.minimum(light(bug, steps, seed, **part), most)


def spread(bug, steps, seed, **part):
    """Variance of the samples of each pixel."""
    return picture(bug, steps, seed, **part).var(axis=1)


def alikeness(bug, steps, seed, **part):
    """How far two pixels beside each other are off their means the same way, sample by sample."""
    found = picture(bug, steps, seed, **part)
    off = found - found.mean(axis=1, keepdims=True)
    return (off[0::2] * off[1::2]).ravel() / off.var()


def path_by_path(bug, steps, seed, of_event, kind, size=(32, 32), spp=8):
    """The sum over the events of one kind of what of_event(columns, depth, columns of the last hit) gives,
    for each path (N,)."""
    scene = loaded(bug.scene)
    settings = bug.asked(width=size[0], height=size[1], spp=spp, seed=seed)
    pixel, sample = np.divmod(np.arange(size[0] * size[1] * spp), spp)
    wave = Wave(pixel % size[0], pixel // size[0], sample, settings, steps)
    found, ng = np.zeros(pixel.size), np.zeros((3, pixel.size))
    for event in waves.events(scene.at(settings), settings, wave):
        if event.kind.name == "hit":
            ng[:, event.lane] = event.columns["ng"]
        if event.kind.name == kind:
            found[event.lane] += of_event(event.columns, event.depth, ng[:, event.lane])
    return found


def of_paths(of_event, kind, **size):
    """The look of that."""
    return partial(path_by_path, of_event=of_event, kind=kind, **size)


def not_a_number(end, depth, ng):
    """Whether the path ended as something that is not a number."""
    return end["reason"] == END_REASONS.index("invalid")


def below_zero(light, depth, ng):
    """Whether a light sample took light away."""
    return (light["contribution"] < 0.0).any(axis=0)


def off_the_diagonal(light, depth, ng):
    """How far the first point on the homework's lamp lies off its diagonal."""
    s, t = (light["q"][0] - 213.0) / 130.0, (light["q"][2] - 227.0) / 105.0
    return np.abs(s - t) * (depth == 0)


def lopsided(light, depth, ng):
    """Whether the first point on the homework's lamp lies in the half that is chosen too often."""
    s, t = (light["q"][0] - 213.0) / 130.0, (light["q"][2] - 227.0) / 105.0
    return (s + t > 1.0) & (depth == 0)


def at_a_pole(light, depth, ng):
    """How near the first point on a sphere lies to its poles."""
    return np.abs(light["nq"][2]) * (depth == 0)


def through_glass(bounce, depth, ng):
    """What the first surface lets through."""
    return bounce["f"][0] * (bounce["lobe"] == LOBES.index("transmission")) * (depth == 0)


def under_the_surface(bounce, depth, ng):
    """Whether a direction with f above 0 goes into a surface that reflects."""
    return (dot(ng, bounce["wi"]) < 0.0) & (bounce["f"][0] > 0.0)


def tilt(camera, depth, ng):
    """How far a camera ray leads up or down."""
    return np.abs(camera["d"][1])


def part(inside=EVERYTHING, look=light, **options):
    """A look at a part of the picture, or with other options than usual."""
    return partial(look, inside=inside, **options)


# Where to look for each bug, and what is to be seen.
LOOKS = {
    "E01": (part(side=64, spp=16), MORE),
    "E02": (part(LAMP), LESS),
    "E03": (part(LAMP), LESS),
    "E04": (part(side=64, spp=16), MORE),
    "E06": (part(spp=16), MORE),
    "M01": (light, OTHER),
    "M02": (light, LESS),
    "D01": (light, LESS),
    "D02": (light, LESS),
    "D03": (light, MORE),
    "D04": (part(BELOW_THE_LAMP), LESS),
    "D06": (part(LEFT, side=64), MORE),
    "D07": (part(BELOW_THE_LAMP), LESS),
    "D08": (of_paths(below_zero, "light"), MORE),
    "D10": (light, MORE),
    "D11": (light, MORE),
    "D13": (light, MORE),
    "D14": (part(look=clipped, most=5.0), LESS),
    "D15": (of_paths(lopsided, "light"), MORE),
    "D17": (of_paths(off_the_diagonal, "light"), LESS),
    "D18": (of_paths(at_a_pole, "light"), MORE),
    "D20": (light, MORE),
    "D21": (part(BELOW_THE_LAMP), MORE),
    "B01": (light, MORE),
    "B02": (light, LESS),
    "B04": (light, LESS),
    "B05": (light, LESS),
    "B08": (part(BELOW_THE_LAMP, spread, spp=32, side=64, max_depth=3), MORE),
    "B09": (part(side=64), OTHER),
    "B10": (light, OTHER),
    "B12": (light, MORE),
    "B15": (of_paths(not_a_number, "end", size=(64, 64)), MORE),
    "W01": (part(BELOW_THE_LAMP), LESS),
    "W02": (light, OTHER),
    "W03": (part(GLASS_BALL, clipped, side=128, most=2.0), OTHER),
    "W04": (part(BACK, side=64), LESS),
    "N01": (part(LEFT, side=64), LESS),
    "N02": (part(LEFT, side=64), LESS),
    "N03": (light, OTHER),
    "N04": (light, LESS),
    "B17": (part(BELOW_THE_LAMP), LESS),
    "B18": (part(LEFT, side=64), MORE),
    "G09": (of_paths(under_the_surface, "bounce", size=(64, 64)), MORE),
    "B03": (clipped, MORE),
    "B14": (part(look=clipped, most=5.0), OTHER),
    "S07": (part(METAL_BALLS, clipped, side=128, spp=16, most=5.0), LESS),
    "S08": (of_paths(not_a_number, "end"), MORE),
    "S09": (light, MORE),
    "A01": (light, MORE),
    "S01": (light, OTHER),
    "S02": (light, LESS),
    "S04": (light, OTHER),
    "S06": (of_paths(through_glass, "bounce"), MORE),
    "G01": (light, LESS),
    "G02": (part(side=64), OTHER),
    "G03": (light, LESS),
    "G08": (light, LESS),
    "R01": (light, LESS),
    "R03": (light, LESS),
    "R05": (light, LESS),
    "R06": (part(BELOW_THE_LAMP, spread, spp=32, side=64, max_depth=3), MORE),
    "P02": (part(BELOW_THE_LAMP, spread, side=64), LESS),
    "P03": (part(BELOW_THE_LAMP, alikeness, side=64), MORE),
    "F01": (light, LESS),
    "F03": (part(BACK, side=64), MORE),
    "F04": (light, MORE),
    "F05": (part(ROUND_THE_LAMP, spread, spp=32, side=64), LESS),
    "F06": (of_paths(tilt, "camera", size=(40, 24)), MORE),
    "P05": (part(LAMP), LESS),
    "P06": (part(BOTTOM), LESS),
    "castray": (part(LEFT, clipped, side=128), MORE),
}
