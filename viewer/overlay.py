"""Numbers of pixels laid over the picture in colours: a mask of hits, a heat map, a difference."""

from dataclasses import dataclass, field

import numpy as np

from viewer.numerals import short

# Colours from low to high, as #rrggbb. Lightness rises all the way and hue goes from blue to yellow, so they
# can be told apart by whom red and green look alike. A difference goes from blue by dark grey to orange.
STOPS = {
    "map": ("#101a3c", "#26478a", "#5b6f8d", "#8f8b78", "#c9a94a", "#f2cf43", "#fff7c0"),
    "mask": ("#c7631a", "#ff9d2e", "#ffe9a8"),
    "difference": ("#9fd0ff", "#3f8cf3", "#1d3f7a", "#16181d", "#7a3a10", "#ef8a2d", "#ffe0a6"),
}
DECADES = 4  # of a logarithmic scale at most


@dataclass(frozen=True)
class Overlay:
    """values: (H, W) float32, NaN where there is nothing to show. by: the panel that shows it; title, unit:
    keys of words, said with the values of `told`, or with what these say in a language; kind: which STOPS;
    low and high: numbers at their ends."""

    by: str
    title: str
    values: np.ndarray
    kind: str
    low: float
    high: float
    log: bool = False
    told: dict = field(default_factory=dict)

    def legend(self, say):
        """What the page needs to draw and explain it, beside the values."""
        return {
            "by": self.by,
            "title": say(self.title, **{k: v(say) if callable(v) else v for k, v in self.told.items()}),
            "kind": self.kind,
            "stops": list(STOPS[self.kind]),
            "low": self.low,
            "high": self.high,
            "log": self.log,
            "ends": [short(self.low), short(self.high)],
        }


def mask(by, title, pixels, settings, **told):
    """The Overlay of [x, y, number] of some pixels, as shares of a pixel's samples."""
    values = np.full((settings.height, settings.width), np.nan, np.float32)
    for x, y, number in pixels:
        values[y, x] = number / settings.spp
    return Overlay(by, title, values, "mask", 0.0, 1.0, told=told)


def scaled(by, title, values, log=False, share=False, low=None, **told):
    """The Overlay of a heat map whose colours reach over the values, or from `low`; shares from 0 to 1."""
    finite = values[np.isfinite(values)]
    least, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    low = least if low is None else low
    if share:
        low, high = 0.0, 1.0
    elif log:
        positive = finite[finite > 0.0]
        least = float(positive.min()) if positive.size else 1.0
        high = high if high > 0.0 else 1.0
        low = max(least, high / 10.0**DECADES)
    if not low < high:
        low, high = (high / 10.0, high) if log else (min(low, 0.0), max(high, low + 1.0, 1.0))
    return Overlay(by, title, values.astype(np.float32), "map", low, high, log, told)


def signed(by, title, values, most=None, **told):
    """The Overlay of a difference, its colours the same to both sides of 0."""
    finite = np.abs(values[np.isfinite(values)])
    reach = most or (float(np.quantile(finite, 0.995)) if finite.size else 0.0)
    reach = reach or (float(finite.max()) if finite.size and finite.max() > 0.0 else 1.0)
    return Overlay(by, title, values.astype(np.float32), "difference", -reach, reach, told=told)
