"""What if one path had gone otherwise: another direction at a bounce, another point on a lamp, another fate.

A supposition is written DEPTH.KIND=VALUE, depth 0 at the first hit:

    1.bounce=30,45        the bounce goes 30 degrees off the shading normal, turned by 45 degrees about it
    0.light=0.2,0.3,0.9   the light sample uses these numbers: which light, and where on it
    4.roulette=survive    or stop: what Russian roulette decides

They replace named steps of the loop and nothing else, so all that follows is worked out as ever: f,
densities, weights, shadow rays, the rest of the path with its own random numbers, and the ledger adds up.
"""

import math
import re
from dataclasses import replace

import numpy as np

from tracer.engine import inspect
from tracer.events import LOBES
from tracer.integrator.steps import RIGHT
from tracer.settings import TracerError

KINDS = {"bounce": 2, "light": 3, "roulette": 0}  # how many numbers each takes
FATES = ("survive", "stop")
MOST = 16
_KEY = re.compile(r"(\d{1,6})\.(\w+)")
_REFLECTION, _TRANSMISSION = LOBES.index("reflection"), LOBES.index("transmission")


def parse(texts):
    """Suppositions {(depth, kind): value} from texts; a value is a fate or a tuple of numbers.

    Raises TracerError.
    """
    if len(texts) > MOST:
        raise TracerError(f"what_if: more than {MOST} suppositions")
    found = {}
    for text in texts:
        key, _, value = text.partition("=")
        match = _KEY.fullmatch(key.strip())
        if not match or match[2] not in KINDS:
            known = ", ".join(KINDS)
            raise TracerError(
                f"what_if: {text[:40]!r} is no supposition; write DEPTH.KIND=VALUE, KIND one of {known}"
            )
        found[int(match[1]), match[2]] = _value(key, match[2], value.strip())
    return found


def _value(key, kind, text):
    if kind == "roulette":
        if text not in FATES:
            raise TracerError(f"what_if: {key}: {text[:20]!r} is not known; choose one of {', '.join(FATES)}")
        return text
    try:
        numbers = tuple(float(part) for part in text.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != KINDS[kind] or not all(map(math.isfinite, numbers)):
        raise TracerError(f"what_if: {key}: {text[:40]!r} is not {KINDS[kind]} numbers with commas between")
    if kind == "light" and not all(0.0 <= u < 1.0 for u in numbers):
        raise TracerError(f"what_if: {key}: random numbers are from 0 up to 1, 1 left out")
    if kind == "bounce" and not (0.0 <= numbers[0] <= 180.0 and abs(numbers[1]) <= 360.0):
        raise TracerError(f"what_if: {key}: angles are from 0 to 180 and from -360 to 360 degrees")
    return numbers


def written(suppositions):
    """The texts that parse reads as these suppositions."""
    return tuple(
        f"{depth}.{kind}={value if kind == 'roulette' else ','.join(f'{v:.9g}' for v in value)}"
        for (depth, kind), value in sorted(suppositions.items())
    )


def supposed(scene, settings, x, y, sample, suppositions, steps=RIGHT):
    """The PixelRecord of one sample as it would be. Raises TracerError, also for what never comes to pass."""
    supposing = _Supposing(steps, suppositions, settings.dtype)
    record = inspect(scene, settings, x, y, sample, supposing.steps)
    missed = sorted(suppositions.keys() - supposing.met)
    if missed:
        depth, kind = missed[0]
        raise TracerError(
            f"what_if: {depth}.{kind}: the path does no such thing there, or a mirror leaves no choice"
        )
    return record


class _Supposing:
    """Steps that do as is supposed, made for one trace; met: the suppositions that came to pass."""

    def __init__(self, steps, suppositions, dtype):
        self.right, self.all, self.dtype = steps, suppositions, dtype
        self.met, self._depth = set(), None
        self.steps = replace(steps, random=self.random, bounce=self.bounce)

    def _asked(self, kind, depth):
        """(supposition, lanes) of that kind where it applies."""
        for (wanted, named), value in self.all.items():
            lanes = np.flatnonzero(depth == wanted) if named == kind else ()
            if len(lanes):
                yield (wanted, named), value, lanes

    def random(self, draw, pixel, sample, depth, use):
        """The sampler's numbers, or others for a light sample or roulette of which something is supposed."""
        u = self.right.random(draw, pixel, sample, depth, use)
        if use == "bsdf":
            self._depth = depth  # of the bounce that comes next
        for key, value, lanes in self._asked(use, depth):
            u = u.copy()
            last = np.nextafter(self.dtype(1), self.dtype(0))
            if use == "roulette":
                u[0, lanes] = 0.0 if value == "survive" else last
            else:
                u[:, lanes] = np.minimum(np.asarray(value, self.dtype), last)[:, None]
            self.met.add(key)
        return u

    def bounce(self, scene, hit, wo, u):
        """The BSDF's direction, or the supposed one with the f and density that belong to it."""
        sample = self.right.bounce(scene, hit, wo, u)
        for key, (theta, phi), lanes in self._asked("bounce", self._depth):
            if sample.delta[lanes].all():
                continue
            off, turn = math.radians(theta), math.radians(phi)
            wi = sample.wi.copy()
            for axis, part in enumerate(
                (math.sin(off) * math.cos(turn), math.sin(off) * math.sin(turn), math.cos(off))
            ):
                wi[axis, lanes] = part
            f, pdf = (ask(scene, hit, wo, wi) for ask in (self.right.eval, self.right.pdf))
            across = wi[2] * wo[2] < 0.0
            lobe = np.where(across, _TRANSMISSION, _REFLECTION).astype(sample.lobe.dtype)
            ours = np.zeros(pdf.shape, bool)
            ours[lanes] = True
            sample = sample._replace(
                wi=wi,
                f=np.where(ours, f, sample.f),
                pdf=np.where(ours, pdf, sample.pdf),
                lobe=np.where(ours & ~self._keeps(sample, across), lobe, sample.lobe),
            )
            self.met.add(key)
        return sample

    @staticmethod
    def _keeps(sample, across):
        """Where the lobe that was drawn is on the side of the supposed direction, too."""
        return across == (sample.lobe == _TRANSMISSION)
