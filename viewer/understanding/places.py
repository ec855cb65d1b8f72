"""The events of a recorded pixel, each with the surface that it is at."""

from typing import Any, NamedTuple


class Place(NamedTuple):
    """An event: number of its path, itself, and the HIT it is at (empty before the first)."""

    path: int
    event: Any
    hit: dict

    @property
    def at(self):
        """(path, event), as the cursor counts."""
        return self.path, self.event.step


def places(record, *kinds):
    """The Places of a record, those of some kinds of event only if any are named."""
    for number, path in enumerate(record.paths):
        hit: dict = {}
        for event in path.events:
            if event.kind.name == "hit":
                hit = event.values
            if not kinds or event.kind.name in kinds:
                yield Place(number, event, hit)
