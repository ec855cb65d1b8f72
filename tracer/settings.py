"""Every option that decides a path's numbers, declared once; all who ask or show derive from it."""

from dataclasses import dataclass, field, fields, replace

import numpy as np

MOST_PIXELS = 10**8  # the film then takes 9 GB
ANY_DEPTH = 2**28  # max_depth of paths that only their own events end: a log that declares none


class TracerError(ValueError):
    """Bad input: one line that says what, where, and what would do."""


def told(value):
    """A setting's value as one says it."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return "none" if value is None else str(value)


def both_told(one, other, names):
    """Of two {name: value} those of some names, as one says them."""
    return ", ".join(f"{name} {told(one[name])} and {told(other[name])}" for name in names)


def option(default, help, choices=None, least=None, most=None):
    """A dataclass field that carries its own explanation and limits."""
    return field(
        default=default,
        metadata={"help": help, "choices": choices, "least": least, "most": most},
    )


@dataclass(frozen=True)
class Settings:
    """How a picture is rendered. None for the size: as the scene says.

    Raises TracerError naming the option, its value and what would do.
    """

    width: int | None = option(None, "picture width in pixels (default: the scene's)", least=1, most=65535)
    height: int | None = option(None, "picture height in pixels (default: the scene's)", least=1, most=65535)
    spp: int = option(16, "samples per pixel", least=1, most=2**31)
    seed: int = option(0, "seed of every random number", least=0, most=2**32 - 1)
    max_depth: int = option(
        -1,
        "longest path: 1 = emission seen directly, 2 = plus direct light, -1 = unlimited",
        least=-1,
        most=ANY_DEPTH,
    )
    integrator: str = option("path", "which loop", choices=("path", "direct", "walk"))
    strategy: str = option(
        "mis", "how path finds lights: both ways weighted, or one", choices=("mis", "light", "bsdf")
    )
    heuristic: str = option("power", "MIS weights", choices=("power", "balance"))
    hemisphere: str = option(
        "cosine", "how a diffuse surface chooses directions", choices=("cosine", "uniform")
    )
    roulette: str = option("auto", "Russian roulette: auto, off, or one survival probability in (0, 1]")
    light_sampling: str = option(
        "solid_angle",
        "how a point on a lamp is chosen: uniform as the receiver sees it (rectangles, spheres), or by area",
        choices=("solid_angle", "area"),
    )
    sampler: str = option(
        "independent",
        "how random numbers fall: each for itself, or evenly over a pixel's samples",
        choices=("independent", "lattice"),
    )
    replicates: int = option(
        1,
        "independent lattices that a pixel's samples are dealt to: from 2 on their means give error bars",
        least=1,
        most=4096,
    )
    precision: int = option(32, "bits of the floating point numbers", choices=(32, 64))
    accel: str = option(
        "bvh",
        "who looks for the triangles of large meshes: castray's own tree, or Embree (needs embreex)",
        choices=("bvh", "embree"),
    )
    jitter: bool = option(True, "spread samples over the pixel (off: all through its centre)")
    bug: str | None = option(None, "plant bugs of the zoo, as in E01 or E01,D06 (`castray bugs` lists them)")

    def __post_init__(self):
        for f in fields(self):
            value, rules = getattr(self, f.name), f.metadata
            if rules["choices"] and value not in rules["choices"]:
                known = ", ".join(map(str, rules["choices"]))
                raise TracerError(f"{f.name}: {value!r} is not known; choose one of {known}")
            if rules["least"] is None or (value is None and f.default is None):
                continue
            if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
                raise TracerError(f"{f.name}: {value!r} is not a whole number")
            if not rules["least"] <= value <= rules["most"]:
                raise TracerError(f"{f.name}: {value} is not between {rules['least']} and {rules['most']}")
        if not isinstance(self.jitter, bool):
            raise TracerError(f"jitter: {self.jitter!r} is neither true nor false")
        if not isinstance(self.bug, str | None):
            raise TracerError(f"bug: {self.bug!r} is not the name of a bug")
        self._check_roulette()
        self._check_replicates()
        if self.accel == "embree" and self.precision != 32:
            raise TracerError(f"accel: embree works in 32 bits; precision {self.precision} needs accel bvh")
        if self.integrator != "path" and self.strategy != "mis":
            raise TracerError(
                f"strategy: {self.strategy!r} is for the path integrator; {self.integrator} has only one way"
            )

    def _check_roulette(self):
        if self.roulette in ("auto", "off"):
            if self.roulette == "off" and self.max_depth < 0:
                raise TracerError("roulette: off needs a max_depth, or a path in a closed room never ends")
            return
        try:
            q = float(self.roulette)
        except (TypeError, ValueError):
            q = float("nan")
        if not 0.0 < q <= 1.0:
            raise TracerError(
                f"roulette: {self.roulette!r} is neither auto, off nor a probability above 0 and up to 1"
            )
        if q == 1.0 and self.max_depth < 0:
            raise TracerError("roulette: 1 needs a max_depth, or a path in a closed room never ends")
        object.__setattr__(self, "roulette", repr(q))

    def _check_replicates(self):
        if self.replicates == 1:
            return
        if self.sampler == "independent":
            raise TracerError(
                f"replicates: {self.replicates} is for sampler lattice; independent samples need none"
            )
        if self.spp % self.replicates:
            raise TracerError(f"spp: {self.spp} is not a multiple of replicates, {self.replicates}")

    @property
    def dtype(self):
        """The floating point type of every path quantity."""
        return np.float32 if self.precision == 32 else np.float64

    @property
    def parts(self):
        """Into how many independent parts a pixel's samples fall; None where each sample is one.
        With one part alone the error of a pixel is not known."""
        return None if self.sampler == "independent" else self.replicates

    @property
    def last_depth(self):
        """Depth (0 at the first hit) of the last vertex whose emission counts."""
        return np.iinfo(np.int32).max if self.max_depth < 0 else self.max_depth - 1

    def at_size_of(self, scene):
        """These settings with the scene's own picture size where none was asked for."""
        width, height = self.width or scene.width, self.height or scene.height
        if width * height > MOST_PIXELS:
            raise TracerError(f"size: {width} x {height} is more than {MOST_PIXELS} pixels")
        return replace(self, width=width, height=height)

    def at_spp(self, spp):
        """These settings for another number of samples, for a look: without error bars where that number
        cannot be dealt to all replicates."""
        return replace(self, spp=spp, replicates=1 if spp % self.replicates else self.replicates)

    def as_dict(self):
        """Plain values by name, as files and links keep them."""
        return {f.name: getattr(self, f.name) for f in fields(self)}
