"""What the zoo's pictures look like, for the doctor to compare somebody's picture with.

Those of the homework's scene are in a table that `python tests/signatures.py` writes; of other scenes
they are rendered small, when they are asked for.
"""

from collections import deque
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from lessons.zoo.bug import Bug
from tracer.doctor.picture import Features, Looks, features
from tracer.engine import render, waves
from tracer.integrator.wave import Wave
from tracer.settings import Settings

TABLE = Path(__file__).with_name("cornell.npz")
SIDE, SPP, SEED = 40, 256, 20_000  # of the table
QUICK_SIDE, QUICK_SPP = 24, 16  # of scenes without a table
_FEW, _MANY = (32, 16), (24, 64)  # side and samples per pixel of mixtures
_MIXTURES = 10  # that are rendered at most: five of two mistakes, five of three
# Right tracers: the homework's, in which the bugs are planted, and one that finds lamps by chance alone.
RIGHTS = (Bug("right", "", "", "", "", {}), Bug("walk", "", "", "", "", {}, integrator="walk"))
_SHARES = 64  # samples per pixel that tell light straight from lamps from other light
_EVERY = 4  # levels of samples per pixel: 1, 4, 16, ...


@dataclass(frozen=True)
class Album:
    """What the pictures of a scene look like: those of right tracers, and of each bug by its id.

    picture: (H, W, 3), the right one. rights: the homework's tracer first. rules: id of the law that a bug's
    trace breaks first, by the bug's id; empty where no table says so.
    """

    picture: np.ndarray
    rights: tuple
    bugs: dict
    rules: dict


def sized(scene, side):
    """Width and height of the scene's shape with that longer side."""
    shrink = side / max(scene.width, scene.height)
    return {"width": max(1, round(scene.width * shrink)), "height": max(1, round(scene.height * shrink))}


def samples(scene, settings, steps):
    """Every sample of a picture as it counts in the film, (spp, H, W, 3)."""
    height, width, spp = settings.height, settings.width, settings.spp
    pixel, sample = np.divmod(np.arange(height * width * spp), spp)
    found = np.empty((pixel.size, 3), np.float32)
    for start in range(0, pixel.size, waves.LANES):
        lanes = slice(start, start + waves.LANES)
        wave = Wave(pixel[lanes] % width, pixel[lanes] // width, sample[lanes], settings, steps)
        deque(waves.events(scene.at(settings), settings, wave), maxlen=0)
        found[lanes] = wave.radiance.T
    return found.reshape(height, width, spp, 3).transpose(2, 0, 1, 3)


def looks(scene, bug, side=QUICK_SIDE, most=QUICK_SPP, seed=SEED):
    """The Looks of a bug's pictures with 1, 4, ... up to `most` samples per pixel, and the mean picture."""
    settings = bug.asked(**sized(scene, side), spp=most, seed=seed)
    at, spp = {}, 1
    plain = not {"film", "random"} & bug.changes.keys()  # the others depend on how many samples there are
    every = samples(scene, settings, bug.steps) if plain else None
    while spp <= most:
        rounds = max(1, min(64, most) // spp) if not plain else most // spp
        if plain:
            pictures = every.reshape(rounds, spp, *every.shape[1:]).mean(axis=1)
        else:
            some = (replace(settings, spp=spp, seed=seed + k) for k in range(rounds))
            pictures = np.array([samples(scene, s, bug.steps).mean(axis=0) for s in some])
        at[spp] = _mean(pictures)
        spp *= _EVERY
    return Looks(at), pictures.mean(axis=0)


@lru_cache(maxsize=4)
def straight_and_all(scene):
    """Right pictures (H, W, 3) of a scene, small: of the light that comes straight from lights to what is
    seen, and of all that is reflected there."""
    seen, direct, every = (
        render(scene, Settings(**sized(scene, SIDE), spp=_SHARES, seed=SEED, max_depth=depth)).rgb.astype(
            float
        )
        for depth in (1, 2, -1)
    )
    return direct - seen, every - seen


def _mean(pictures):
    """The mean Features of several pictures of one tracer."""
    found = [features(rgb) for rgb in pictures]
    parts = [np.mean(values, axis=0) for values in zip(*found, strict=True)]
    mean = Features(*parts)
    fewer = 1.0 / np.sqrt(len(found))
    return replace(
        mean,
        error=mean.error * fewer,
        bright_error=mean.bright_error * fewer,
        pixels=mean.pixels * len(found),
    )


def all_at_once(bugs):
    """The Bug that several make together; None if they replace the same step, as look-alikes do."""
    steps = [step for bug in bugs for step in bug.changes]
    if len(set(steps)) < len(steps):
        return None
    changes = {step: wrong for bug in bugs for step, wrong in bug.changes.items()}
    options = {name: value for bug in bugs for name, value in bug.settings.items()}
    first = bugs[0]
    return replace(first, id=" + ".join(bug.id for bug in bugs), changes=changes, settings=options)


def suited(scene, zoo):
    """The mistakes of a zoo that may show in a scene: those declared for it, and the homework's."""
    return [bug for bug in zoo if bug.scene in (scene.name, "cornell") and not bug.only_cost]


def album(scene, bugs, progress=None):
    """The Album of a scene: from the table where it has one, else rendered small. bugs: of the zoo."""
    if scene.name == "cornell" and not scene.definition.changes and TABLE.exists():
        return stored()
    (right, picture), *more = (looks(scene, bug) for bug in RIGHTS)
    found = {}
    for done, bug in enumerate(bugs):
        found[bug.id] = looks(scene, bug)[0]
        if progress:
            progress(done + 1, len(bugs))
    return Album(picture, (right, *(seen for seen, _ in more)), found, {})


def stored(file=TABLE):
    """The Album that a table holds."""
    with np.load(file) as table:
        ids, spp = table["ids"].tolist(), table["spp"].tolist()
        columns = {
            name: table[name].astype(np.float64)
            for name in ("mean", "error", "bright", "bright_error", "texture")
        }
        picture, rules = table["picture"].astype(np.float64), table["rules"].tolist()
    pixels = SIDE * SIDE * SPP
    every = {
        bug: Looks(
            {
                n: Features(**{name: c[b, k] for name, c in columns.items()}, pixels=pixels // n)
                for k, n in enumerate(spp)
            }
        )
        for b, bug in enumerate(ids)
    }
    rights = tuple(every.pop(bug.id) for bug in RIGHTS)
    return Album(picture, rights, every, dict(zip(ids, rules, strict=True)))


def mixtures(scene, zoo, progress=None):
    """A function from ids and samples per pixel to the Looks of all these mistakes at once; None where they
    replace the same step. progress(done, total) is told of each that is rendered."""
    done = 0

    def mixed(ids, spp):
        nonlocal done
        bug = all_at_once([zoo[name] for name in ids])
        if bug is None:
            return None
        found = looks(scene, bug, *(_FEW if spp <= _FEW[1] else _MANY))[0]
        done += 1
        if progress:
            progress(done, max(done, _MIXTURES))
        return found

    return mixed
