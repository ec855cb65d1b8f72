"""Renders scenes with castray and with Mitsuba 3 from the same file and compares them: `make peers`.

Both programs render BATCHES pictures of a scene, each under a seed of its own. A pixel's mean and its
variance come from those pictures, in both programs alike: nothing is taken from either but what it draws.
It may be stopped at any time: each finished scene is kept in .accuracy/peers/, beside the file that was
rendered.
"""

import argparse
import contextlib
import hashlib
import json
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import accuracy
import numpy as np
from accuracy import KEPT, ROOT, SEED, commit, text_of
from peer_definitions import of_the_peer
from peer_scenes import SCENES
from stats import sidak

import tracer
from tracer import Settings
from tracer.scene import Scene
from tracer.testing import z_test
from tracer.testing.ztest import Estimate, plain_z

PATHS = 10**7  # of each program in each scene, at least
PIXELS = 4096  # about so many in a picture
BATCHES = 32  # pictures of a scene by each program
VARIANT = "scalar_rgb"
BAR = 4.0  # standard errors that the mean of a region, or of the whole picture, may be off
FAR, RARE = 2.576, 0.01  # standard errors, and the share of right pixels that are so far off
ALPHA = sidak(sum(not scene.differs for scene in SCENES))
HEAD = """## Against a peer

castray and {mitsuba} render the same files, as `castray export` writes them, to any depth, and their
pictures are compared pixel by pixel and channel by channel. Each program renders {batches} pictures of
a scene under different seeds, so that a pixel's error is known from how they scatter.

- *pixels off*: those that the z-test of `tracer.testing` rejects. If all are right, chance makes it
  reject any in this whole table with a probability of 1 %.
- *beyond 2.58*: share of pixels that are so many standard errors apart, skewed noise or not; by chance
  1 %; asked: no more, but for {bar:g} standard errors of that share (up to 1.6 %).
- *region*: largest bias of a region, of 8 x 8, in its standard errors; asked: below {bar:g}.
- *Z*: bias of the whole picture in red, green and blue, in its standard errors; asked: below {bar:g}.
- *mean*: how far the pictures are apart on the whole, in the channel of the largest Z, each pixel
  weighed by the inverse of its error; with 3 standard errors.

Scenes marked * have rough surfaces or coats, which Mitsuba defines differently (below): there castray
borrows Mitsuba's definitions, so that all the rest is compared. Picture k has the seed {seed} + k in castray
and {seed} + {batches} + k in Mitsuba. Measured by

```text
make peers
```

| scene | paths of each | pixels off | beyond 2.58 | region | Z | mean | at |
|---|---|---|---|---|---|---|---|
"""
DIFFERENT = """
### Where the two differ by definition

| scene | what differs, and why | measured | at |
|---|---|---|---|
"""

NOTES = """
Three more do not show here:

- `coloured_glass` is drawn by Mitsuba's `volpathmis`. Its `volpath` decides how far to go by one channel of
  three; in deeply coloured glass the weights of the others then grow without bound.
- Mitsuba takes the axis of a `rotate` as it is, and shears where its length is not 1. castray turns, and
  exports such a step as a matrix.
- Mitsuba 3.9.1 does not load a file in which, of two cubes or meshes of one material, one has
  `flip_normals`, as in `many_lights`; with `optimize=False`, as here, it does.
"""


def castray(path, spp, seeds):
    """Pictures of a scene file by castray, (H, W, 3) each."""
    scene = tracer.load(path)
    pictures = [tracer.render(scene, Settings(spp=spp, seed=seed)) for seed in seeds]
    dropped = sum(picture.dropped for picture in pictures)
    if dropped:
        raise ArithmeticError(f"{path}: castray dropped {dropped} samples that are not finite")
    return [picture.rgb for picture in pictures]


def mitsuba(path, spp, seeds):
    """Pictures of a scene file by Mitsuba, (H, W, 3) each.

    It must not merge shapes: version 3.9.1 fails where of two with one material one has its normals flipped.
    Where glass is coloured, its `volpath` goes by one channel of three at random, and now and then weighs the
    others by ever more: no number of paths settles that. `volpathmis` weighs by all three.
    """
    import mitsuba as peer

    peer.set_variant(VARIANT)
    peer.set_log_level(peer.LogLevel.Error)
    scene = peer.load_file(str(path), optimize=False)
    filled = 'type="volpath"' in path.read_text(encoding="utf-8")
    integrator = peer.load_dict({"type": "volpathmis" if filled else "path"})
    return [np.array(peer.render(scene, integrator=integrator, spp=spp, seed=seed)) for seed in seeds]


def together(pictures):
    """The mean of independent pictures of equal weight, as z_test takes it."""
    stack, count = np.stack(pictures).astype(np.float64), len(pictures)
    variance = stack.var(axis=0, ddof=1) / count
    return SimpleNamespace(
        rgb=stack.mean(axis=0), variance=variance, samples=np.full(stack.shape[1:3], count)
    )


def compare(ours, theirs):
    """What two programs' pictures of a scene have in common, as plain numbers."""
    ours, theirs = together(ours), together(theirs)
    test = z_test(ours, theirs, ALPHA)
    mean = 0.5 * (ours.rgb + theirs.rgb)
    varies = ours.variance + theirs.variance > (1e-6 * mean) ** 2
    with np.errstate(all="ignore"):
        plain = np.abs(plain_z(Estimate.of(ours), Estimate.of(theirs), varies))[varies]
        weights = np.where(varies, 1.0 / np.sqrt(ours.variance + theirs.variance), 0.0)
    whole = (weights * mean).sum(axis=(0, 1)) / weights.sum(axis=(0, 1))
    x0, y0, x1, y1 = test.region
    parts = [picture.rgb[y0:y1, x0:x1].mean(axis=(0, 1)) for picture in (ours, theirs)]
    return {
        "tested": test.tested,
        "off": int((test.p < ALPHA).sum()) + test.invalid,
        "beyond": float((plain > FAR).mean()),
        "region": [int(v) for v in test.region],
        "region_Z": test.region_Z,
        "region_off": (parts[0] / parts[1] - 1.0).tolist(),
        "Z": test.Z.tolist(),
        "bias": (test.bias / whole).tolist(),
        "bound": (test.bound / whole).tolist(),
    }


def good(found):
    """Whether two programs' pictures differ by no more than chance."""
    pixels = found["tested"] / 3  # channels of one pixel share their paths
    beyond = RARE + BAR * (RARE * (1.0 - RARE) / pixels) ** 0.5
    Z = max(map(abs, (*found["Z"], found["region_Z"])))
    return not found["off"] and found["beyond"] < beyond and Z < BAR


def written(scene, folder):
    """The file both programs read, and its picture's size."""
    made = scene.make(folder)
    scale = (PIXELS / (made.width * made.height)) ** 0.5
    width, height = round(made.width * scale), round(made.height * scale)
    path = folder / f"{scene.key}.xml"
    tracer.export(Scene(made.definition._replace(width=width, height=height)), path)
    return path, width * height


def kept(scene, folder):
    """What was kept of a scene, as a dict; None if nothing was."""
    file = folder / f"{scene.key}.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else None


def measure(scene, folder, paths=PATHS, batches=BATCHES, seed=SEED, programs=(castray, mitsuba)):
    """Render a scene with both programs, unless that is done, and keep what was found; it, as a dict."""
    folder.mkdir(parents=True, exist_ok=True)
    path, pixels = written(scene, folder)
    spp = -(-paths // (pixels * batches))
    text = path.read_text(encoding="utf-8").replace(ROOT.as_posix(), "")  # the checkout may move
    file = hashlib.sha256(text.encode()).hexdigest()[:16]
    asked = {"file": file, "spp": spp, "batches": batches, "seed": seed, "peer": _version()}
    asked["as_peer"] = scene.as_peer
    old = kept(scene, folder)
    if old and old["asked"] == asked:
        return old
    pictures, seconds = [], []
    for k, program in enumerate(programs):
        began, first = time.perf_counter(), seed + k * batches
        with of_the_peer() if scene.as_peer else contextlib.nullcontext():
            pictures.append(program(path, spp, range(first, first + batches)))
        seconds.append(round(time.perf_counter() - began, 1))
    found = compare(*pictures)
    new = {
        "asked": asked,
        "paths": pixels * spp * batches,
        "at": commit(),
        "seconds": seconds,
        "found": found,
    }
    (folder / f"{scene.key}.json").write_text(json.dumps(new, indent=1), encoding="utf-8")
    return new


def _version():
    from importlib import metadata

    return f"Mitsuba {metadata.version('mitsuba')} ({VARIANT})"


def line(scene, result):
    """A scene's line of the table."""
    found = result["found"]
    x0, y0, x1, y1 = found["region"]
    channel = int(np.argmax(np.abs(found["Z"])))
    mean = f"{100 * found['bias'][channel]:+.3f} % ± {100 * found['bound'][channel]:.3f}"
    off = f"{found['off']} of {found['tested']}"
    if scene.differs:
        worst = max(found["region_off"], key=abs)
        where = f"pixels ({x0}, {y0}) to ({x1 - 1}, {y1 - 1}) by {100 * worst:+.2f} %"
        why = scene.differs.replace("\n", " ")
        return f"| {scene.key} | {why} | {off} pixels off; {where}; mean {mean} | {result['at']} |"
    cells = (
        scene.key + " *" * scene.as_peer,
        f"{result['paths']:.3g}",
        off,
        f"{100 * found['beyond']:.2f} %",
        f"{found['region_Z']:+.2f}",
        " ".join(f"{Z:+.2f}" for Z in found["Z"]),
        mean,
        result["at"] if good(found) else f"{result['at']} **missed**",
    )
    return "| " + " | ".join(cells) + " |"


def section(results):
    """The section of ACCURACY.md from (scene, what was kept) of each."""
    alike = [line(*result) for result in results if not result[0].differs]
    different = [line(*result) for result in results if result[0].differs]
    head = HEAD.format(bar=BAR, batches=BATCHES, seed=SEED, mitsuba=results[0][1]["asked"]["peer"])
    return head + "\n".join(alike) + "\n" + DIFFERENT + "\n".join(different) + "\n" + NOTES


def put(page, new):
    """A page with this section in place of the one it has, or at its end."""
    return accuracy.put(page, "peers", new)


def main():
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--only", default="", help="scenes whose name contains this; the others as they are")
    words.add_argument("--paths", type=int, default=PATHS, help="of each program in each scene, at least")
    words.add_argument("--out", type=Path, default=ROOT / "ACCURACY.md")
    asked, folder, results = words.parse_args(), KEPT / "peers", []
    for scene in SCENES:
        if asked.only in scene.key:
            result = measure(scene, folder, asked.paths)
            print(line(scene, result), *result["seconds"], flush=True)
            results = [(one, kept(one, folder)) for one in SCENES]
            results = [(one, result) for one, result in results if result]
            asked.out.write_text(put(text_of(asked.out), section(results)), encoding="utf-8")
    sys.exit(not all(scene.differs or good(result["found"]) for scene, result in results))


if __name__ == "__main__":
    main()
