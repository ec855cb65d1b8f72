"""A section of BENCHMARKS.md: what is measured, how large, and how times are taken."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from tracer import Settings
from tracer.testing.machine import kernel_seconds

DEPTH = 8  # longest path of all scenes here
SEED = 20_231


@dataclass(frozen=True)
class Size:
    """How large everything is."""

    side: int = 128  # pixels of the square pictures
    spp: int = 16
    repeats: int = 5  # of each render; the median counts
    moments: int = 1500  # samples of a profile
    lanes: tuple = tuple(1 << k for k in range(9, 19))
    spps: tuple = (1, 4, 16, 64, 256)
    depths: tuple = (1, 2, 4, 8, 16, 32, -1)
    levels: tuple = (3, 4, 5, 6, 7, 8)  # subdivisions of an icosahedron: 20 * 4^level triangles
    brute: int = 6  # the level at which the tree is held against every triangle in turn
    brute_rays: int = 1024
    mesh_spp: int = 4  # of pictures with meshes, which take long
    mesh_repeats: int = 3
    lamps: tuple = (1, 10, 100, 1000)
    starts: int = 9  # of a program
    wholes: tuple = (("cornell_unit", 128, 64), ("cornell", 784, 16))  # scene, side, spp
    whole_repeats: int = 5
    error_spps: tuple = (16, 32, 64, 128, 256, 512)
    error_seeds: int = 8
    sharing_spp: int = 64
    lamp_spp: int = 1 << 20
    picks: int = 25  # pixels
    steps: int = 100


FULL = Size()
TINY = Size(
    side=8, spp=2, repeats=1, moments=5, lanes=(64, 128), spps=(1, 2), depths=(1, 2), levels=(0, 1), brute=1,
    brute_rays=16, mesh_spp=1, mesh_repeats=1, lamps=(1, 2), starts=1, wholes=(("furnace", 4, 1),),
    whole_repeats=1, error_spps=(1, 4), error_seeds=2, sharing_spp=32, lamp_spp=256, picks=1, steps=2,
)  # fmt: skip


@dataclass(frozen=True)
class Section:
    """measure(size, say) gives the text of the section; say(line) tells how far it is."""

    key: str
    title: str
    about: str
    measure: Callable


@dataclass
class Times:
    """Seconds of one piece of work, and of the calibration kernel just before each time."""

    seconds: list = field(default_factory=list)
    kernels: list = field(default_factory=list)

    @property
    def median(self):
        """Seconds."""
        return statistics.median(self.seconds)

    @property
    def kernel(self):
        """The kernel's milliseconds, as tables show them."""
        return f"{1e3 * statistics.median(self.kernels):.2f}"


def in_turn(works, repeats, say=lambda line: None, kernel_every=1):
    """{name: Times} of {name: work()}, each done once untimed and then by turns, so that what disturbs the
    machine disturbs all alike.

    A work may give its own seconds, a float; else the whole call counts. kernel_every: rounds from one
    measurement of the kernel to the next; it empties the caches, which quick works would feel.
    """
    times = {name: Times() for name in works}
    for name, work in works.items():
        say(f"warming up: {name}")
        work()
    for k in range(repeats):
        for name, work in works.items():
            say(f"{name}: {k + 1} of {repeats}")
            if k % kernel_every == 0:
                times[name].kernels.append(kernel_seconds())
            began = time.perf_counter()
            own = work()
            took = time.perf_counter() - began
            times[name].seconds.append(own if isinstance(own, float) else took)
    return times


def settings(size, **more):
    """The settings of a picture here."""
    said = {"width": size.side, "height": size.side, "spp": size.spp, "max_depth": DEPTH, "seed": SEED}
    return Settings(**{**said, **more})


def table(rows):
    """Rows, all dicts with the same names, as a table in Markdown."""
    names = list(rows[0])
    lines = [names, ["---"] + ["---:"] * (len(names) - 1), *([str(row[n]) for n in names] for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def short(value, digits=3):
    """A number with so many digits, without an exponent where it needs none."""
    if value >= 10**digits:
        return f"{float(f'{value:.{digits - 1}e}'):,.0f}"
    return f"{value:.{digits}g}"
