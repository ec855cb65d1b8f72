"""Heat maps of a picture: one number a pixel, worked out from its paths by one SELECT each."""

from dataclasses import dataclass

import numpy as np

# What casts a ray: to a hit or into the open, and to a lamp where anything may arrive.
RAY = "kind IN ('hit', 'escape') OR (kind = 'light' AND largest(f) > 0 AND largest(Le) > 0)"
_GIVEN = "sum(luminance(contribution)) FILTER (kind = '{}')"
_SHARE = f"coalesce({_GIVEN}, 0) / nullif(sum(luminance(contribution)), 0)"


@dataclass(frozen=True)
class Map:
    """value: what is selected of a pixel's rows of a view; log, share: how it is coloured."""

    view: str
    value: str
    log: bool = False
    share: bool = False


MAPS = {
    "variance": Map("paths", "var_samp(luminance(radiance)::DOUBLE) / count(*)", log=True),
    "length": Map("paths", "avg(vertices)"),
    "dead": Map("paths", "avg(CASE WHEN largest(radiance) > 0 THEN 0 ELSE 1 END)", share=True),
    "rays": Map("events", f"count(*) FILTER ({RAY}) / count(DISTINCT sample)"),
    "largest": Map("events", "max(luminance(contribution))", log=True),
    "hit": Map("events", _SHARE.format("hit"), share=True),
    "light": Map("events", _SHARE.format("light"), share=True),
    "escape": Map("events", _SHARE.format("escape"), share=True),
}


def known(survey):
    """Names of the maps that can be made of a Survey; of one that is yet to be traced, by its settings."""
    level = survey.level if hasattr(survey, "level") else "events"
    settings = getattr(survey, "settings", survey)
    lone = settings.spp < 2 or settings.parts is not None  # where the spread of samples is not their error
    return [
        name
        for name, one in MAPS.items()
        if (one.view == "paths" or level == "events") and not (name == "variance" and lone)
    ]


def values(survey, name):
    """The numbers (H, W) float32 of a map, NaN where a pixel has none."""
    one, settings = MAPS[name], survey.settings
    found = survey.asker.columns(f"SELECT x, y, ({one.value})::FLOAT AS v FROM {one.view} GROUP BY x, y")
    sheet = np.full((settings.height, settings.width), np.nan, np.float32)
    sheet[found["y"], found["x"]] = found["v"]
    return sheet
