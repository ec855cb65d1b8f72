"""Where bounces from a vertex really go: drawn anew as this tracer makes them, counted against p."""

from dataclasses import dataclass

import numpy as np

from tracer.events import LOBES

DRAWS = 2048
RINGS, SECTORS = 4, 8  # cells of equal solid angle on a side, into which they are counted
FINE = (96, 192)  # rings, and places along each, over which p is integrated
SHARP = 0.004  # where the two differ by more in a cell, p is too sharp for it
OFF = 5.0  # standard errors: a right tracer is as far off once in a million counts


@dataclass(frozen=True)
class Count:
    """So many of DRAWS went there.

    where: a cell (side, ring from the pole on, sector), a Dirac lobe's name, or "nowhere". expected: the
    probability, None where it is not known.
    """

    where: object
    observed: int
    expected: float | None

    @property
    def off(self):
        """How many standard errors the two are apart, 0 where nothing is expected."""
        if self.expected is None:
            return 0.0
        spread = np.sqrt(max(self.expected * (1.0 - self.expected) * DRAWS, 1.0))
        return float((self.observed - self.expected * DRAWS) / spread)

    def as_dict(self):
        """Plain values."""
        where = list(self.where) if isinstance(self.where, tuple) else self.where
        return {"where": where, "observed": self.observed, "expected": self.expected, "off": self.off}


def drawn(vertex, steps):
    """Shown directions (3, DRAWS) of bounces from a Vertex by the steps of a tracer, and its Sample."""
    surface, scene = vertex.times(DRAWS), vertex.scene
    hit = surface.as_hit()
    frame = steps.frame(scene, hit)
    u = np.random.default_rng(1).random((3, DRAWS)).astype(scene.dtype)
    u = np.minimum(u, np.nextafter(scene.dtype(1.0), scene.dtype(0.0)))
    sample = steps.bounce(scene, hit, frame.to_local(hit.wo), u)
    return vertex.turned(surface.frame.to_local(frame.to_world(sample.wi))), sample


def counted(vertex, shown, sample, diracs):
    """The Counts of draws: cells of each side, Dirac lobes, what goes nowhere. diracs: the material's own."""
    goes = (sample.pdf > 0.0) & np.isfinite(shown).all(axis=0)
    smooth, cell = goes & ~sample.delta, _cell(shown)
    shares = _expected(vertex)
    total = 0.0 if shares is None else float(sum(share.sum() for share in shares.values()))
    inside = 0
    for side in vertex.sides:
        counts = np.bincount(cell[smooth & (side * shown[2] > 0.0)], minlength=RINGS * SECTORS)
        inside += int(counts.sum())
        for k, count in enumerate(counts.tolist()):
            expected = None if shares is None else float(shares[side][k])
            yield Count((side, k // SECTORS, k % SECTORS), count, expected)
    right = {dirac.name: dirac.p for dirac in diracs}
    for name in sorted(right.keys() | {LOBES[int(lobe)] for lobe in sample.lobe[goes & sample.delta]}):
        of_lobe = goes & sample.delta & (sample.lobe == LOBES.index(name))
        # a lobe so rare that the material itself did not choose it is taken at the tracer's word
        chance = right[name] if name in right else float(np.median(sample.pdf[of_lobe]))
        total, inside = total + chance, inside + int(of_lobe.sum())
        yield Count(name, int(of_lobe.sum()), chance)
    if inside < DRAWS or (shares is not None and total < 1.0 - SHARP):
        yield Count("nowhere", DRAWS - inside, None if shares is None else max(1.0 - total, 0.0))


def _cell(shown):
    """Number of the cell of its side in which a direction (3, N) lies, rings first, from the pole on."""
    known = np.nan_to_num(shown)
    ring = np.minimum((RINGS * (1.0 - np.abs(known[2]))).astype(int), RINGS - 1)
    turn = np.arctan2(known[1], known[0]) / (2.0 * np.pi) % 1.0
    return ring * SECTORS + np.minimum((SECTORS * turn).astype(int), SECTORS - 1)


def _expected(vertex):
    """{side: (RINGS * SECTORS,) probability}; None where p is too sharp to be integrated."""
    found = [{side: _integrated(vertex, side, n) for side in vertex.sides} for n in FINE]
    apart = max(np.abs(found[0][side] - found[1][side]).max() for side in vertex.sides)
    return found[1] if apart <= SHARP else None


def _integrated(vertex, side, n):
    z, turn = 1.0 - (np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n
    z, phi = (v.ravel() for v in np.meshgrid(z, 2.0 * np.pi * turn, indexing="ij"))
    across = np.sqrt(1.0 - z * z)
    _, p = vertex.asked(np.stack((across * np.cos(phi), across * np.sin(phi), side * z)))
    cells = p.reshape(RINGS, n // RINGS, SECTORS, n // SECTORS).mean(axis=(1, 3))
    return cells.ravel() * (2.0 * np.pi / (RINGS * SECTORS))
