"""One sentence on why a pixel is what it is, and the event that shows it."""

from dataclasses import dataclass, field

import numpy as np

from tracer.recorder import number
from viewer.numerals import short

# What no right tracer does.
STRANGE = frozenset(
    "invalid negative light.negative light.phantom light.self met.lost met.dark met.certain "
    "unfit.result unfit.f unfit.pdf unfit.direction film met.back_lit light.back_lit "
    "redone.direction redone.density redone.share redone.weight redone.through redone.hit redone.normal "
    "redone.fate".split()
)


@dataclass(frozen=True)
class Reason:
    """key: which sentence. count, of: so many of so many. place: (path, event) that shows it, or None.
    values: names and numbers of the sentence. weight: how much of the pixel it explains."""

    key: str
    count: int
    of: int
    place: tuple | None = None
    values: dict = field(default_factory=dict)
    weight: float = 0.0

    @property
    def strange(self):
        """Whether no right tracer does this."""
        return self.key in STRANGE

    def sentence(self, say):
        """The words."""
        said = {name: short(v) if isinstance(v, float) else v for name, v in self.values.items()}
        if "kind" in said:
            said["what"] = say(f"ledger.{said['kind']}", depth=said["depth"])
        for name in ("where", "events"):
            if name in said:
                said[name] = say(f"why.{said[name]}", count=self.count, of=self.of)
        return say(f"why.{self.key}", **{"count": self.count, "of": self.of, **said})

    def as_dict(self, say):
        """Plain values, as `castray inspect --why --json` prints them."""
        path, event = self.place or (None, None)
        values = {k: number(v) if isinstance(v, float) else v for k, v in self.values.items()}
        said = {"key": self.key, "sentence": self.sentence(say), "count": self.count, "of": self.of}
        said["strange"] = self.strange
        return said | {"path": path, "event": event, "values": values}


def spelled(values):
    """Numbers within a sentence; "NaN" where none of them is one."""
    if np.isnan(values).all():
        return "NaN"
    return " ".join("NaN" if np.isnan(v) else short(v) for v in np.ravel(values))
