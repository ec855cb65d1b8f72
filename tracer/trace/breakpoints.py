"""Named breakpoints: conditions on a recording that are worth stopping at."""

from typing import NamedTuple

from tracer.settings import TracerError

NEAR, UNLIKELY = 1e-4, 0.05  # metres; chance to go on


class Breakpoint(NamedTuple):
    """What it finds, as words; its condition on the view `events`, and on `paths` where that can tell."""

    about: str
    events: str
    paths: str | None = None


_NO_NUMBER = " OR ".join(f"no_number({name})" for name in ("beta", "f", "Le", "contribution"))
_ENDLESS = (
    "isnan(pdf) OR isnan(w) OR isinf(largest(beta)) OR isinf(largest(contribution)) OR reason = 'invalid'"
)
_MOST = "luminance({0}) = (SELECT max(luminance({0})) FROM {1} WHERE isfinite(luminance({0})))"
_CARRIES = "kind = 'light' AND NOT visible AND largest(f) > 0 AND largest(Le) > 0"

BREAKPOINTS = {
    "nan": Breakpoint(
        "NaN or infinity in a throughput, density, BSDF value or contribution",
        f"{_NO_NUMBER} OR {_ENDLESS}",
        "reason = 'invalid' OR no_number(radiance)",
    ),
    "negative": Breakpoint("negative contribution", "smallest(contribution) < 0", "smallest(radiance) < 0"),
    "largest": Breakpoint(
        "largest contribution", _MOST.format("contribution", "events"), _MOST.format("radiance", "paths")
    ),
    "near": Breakpoint(f"hit nearer than t = {NEAR:g}", f"kind = 'hit' AND t < {NEAR!r}"),
    "roulette": Breakpoint(
        f"roulette with a probability below {UNLIKELY:g}",
        f"kind = 'roulette' AND probability < {UNLIKELY!r}",
    ),
    "self": Breakpoint(
        "light sample blocked by the surface it starts on, or by nothing that castray finds there",
        f"{_CARRIES} AND (blocker IS NULL OR blocker = shape)",
    ),
}


def condition(name, level):
    """The condition of a breakpoint on a recording of that level. Raises TracerError."""
    if name not in BREAKPOINTS:
        raise TracerError(f"break: {name!r} is not known; choose one of {', '.join(BREAKPOINTS)}")
    found = getattr(BREAKPOINTS[name], level)
    if found is None:
        raise TracerError(f"break: {name} needs a recording of events (castray render --record-level events)")
    return found
