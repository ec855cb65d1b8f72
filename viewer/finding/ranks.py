"""What all contributions of a picture look like together, and which paths stand out of it."""

from dataclasses import dataclass

import numpy as np

PER_DECADE = 6  # bins
DECADES = 9  # of them at most, below the largest
MOST = 12  # fireflies told
FACTOR = 10.0  # so many times as bright as what is around


@dataclass(frozen=True)
class Histogram:
    """How many contributions lie between edges (B + 1,), counts (B,), and how many below the first."""

    edges: tuple
    counts: tuple
    below: int
    of: str  # what a query calls the numbers

    def condition(self, low, high):
        """What asks for the numbers in the bins from low to high."""
        return f"{self.of} >= {self.edges[low]!r} AND {self.of} < {self.edges[high + 1]!r}"


def histogram(survey):
    """The Histogram of the luminance of contributions (of whole paths where only those are known), bins of
    equal width in the logarithm; None if nothing arrives. A query for a bin finds as many as are in it."""
    view, of = (
        ("events", "luminance(contribution)")
        if survey.level == "events"
        else ("paths", "luminance(radiance)")
    )
    found = survey.asker.columns(f"SELECT {of} AS v FROM {view} WHERE {of} > 0 AND isfinite({of})")["v"]
    if not found.size:
        return None
    last = int(np.floor(np.log10(float(found.max())) * PER_DECADE)) + 1
    first = int(np.floor(np.log10(float(found.min())) * PER_DECADE))
    first = max(first, last - DECADES * PER_DECADE)
    edges = [float(f"{10.0 ** (k / PER_DECADE):.3g}") for k in range(first, last + 1)]
    while found.max() >= np.asarray(edges[-1], found.dtype):
        last += 1
        edges.append(float(f"{10.0 ** (last / PER_DECADE):.3g}"))
    there = np.asarray(edges, found.dtype)  # as the query rounds them
    place = np.searchsorted(there, found, side="right")
    counts = np.bincount(place, minlength=len(edges) + 1)
    return Histogram(tuple(edges), tuple(counts[1 : len(edges)].tolist()), int(counts[0]), of)


def fireflies(survey):
    """The paths that are FACTOR times as bright as the other paths of their pixel and the eight around it, by
    how much brighter: [{x, y, sample, luminance, around}]."""
    there = survey.asker.columns("SELECT x, y, sample, luminance(radiance)::DOUBLE AS v FROM paths")
    shape = survey.settings.height, survey.settings.width
    x, y, v = there["x"].astype(int), there["y"].astype(int), np.nan_to_num(there["v"], posinf=0.0)
    place = y * shape[1] + x
    total, number = (
        _around(np.bincount(place, weights, shape[0] * shape[1]).reshape(shape)) for weights in (v, None)
    )
    around = (total[y, x] - v) / np.maximum(number[y, x] - 1.0, 1.0)
    around = np.maximum(around, 0.0)
    out = np.flatnonzero(v > FACTOR * np.maximum(around, 1e-6 * v.max(initial=0.0)))
    ranked = out[np.lexsort((there["sample"][out], place[out], -(v - around)[out]))][:MOST]
    return [
        {
            "x": int(x[k]),
            "y": int(y[k]),
            "sample": int(there["sample"][k]),
            "luminance": float(v[k]),
            "around": float(around[k]),
        }
        for k in ranked
    ]


def _around(sheet):
    """The sum over each pixel (H, W) and the eight around it."""
    wide = np.pad(sheet.astype(float), 1)
    height, width = sheet.shape
    return sum(wide[j : j + height, k : k + width] for j in range(3) for k in range(3))
