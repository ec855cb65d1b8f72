"""Where the reader stands: a pixel, one of its paths, one event of that path. Pure transitions, no web."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Cursor:
    """A place in a recorded pixel. lengths: how many events each of its paths has."""

    x: int
    y: int
    lengths: tuple
    path: int = 0
    event: int = 0

    def __post_init__(self):
        if not 0 <= self.path < len(self.lengths):
            raise IndexError(f"path {self.path} of {len(self.lengths)}")
        if not 0 <= self.event < self.lengths[self.path]:
            raise IndexError(f"event {self.event} of {self.lengths[self.path]}")

    def at(self, event):
        """The same path, at the event nearest to the one asked for."""
        return replace(self, event=min(max(event, 0), self.lengths[self.path] - 1))

    def on(self, path):
        """The beginning of the path nearest to the one asked for; standing on it already changes nothing."""
        path = min(max(path, 0), len(self.lengths) - 1)
        return self if path == self.path else replace(self, path=path, event=0)

    def first(self):
        return self.at(0)

    def previous(self):
        return self.at(self.event - 1)

    def next(self):
        return self.at(self.event + 1)

    def last(self):
        return self.at(self.lengths[self.path] - 1)

    def up(self):
        return self.on(self.path - 1)

    def down(self):
        return self.on(self.path + 1)

    @property
    def at_end(self):
        """Whether there is no next event."""
        return self.event == self.lengths[self.path] - 1


MOVES = ("first", "previous", "next", "last", "up", "down")
