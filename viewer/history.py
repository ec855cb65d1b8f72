"""The pixels that were picked, back and forward, as a browser has its pages."""

from dataclasses import dataclass, field

MOST = 200


@dataclass
class History:
    """Pixels (x, y) in the order in which they were picked, and which of them is shown."""

    pixels: list = field(default_factory=list)
    now: int = -1

    def add(self, pixel):
        """A pixel was picked: what lay ahead is gone; the one that is shown already is none."""
        if self.pixels and self.pixels[self.now] == pixel:
            return
        self.pixels = [*self.pixels[: self.now + 1], pixel][-MOST:]
        self.now = len(self.pixels) - 1

    def moved(self, by):
        """The pixel so many further, which is shown from now on; None where there is none."""
        if not 0 <= self.now + by < len(self.pixels):
            return None
        self.now += by
        return self.pixels[self.now]

    @property
    def behind(self):
        """How many lie behind."""
        return max(self.now, 0)

    @property
    def ahead(self):
        """How many lie ahead."""
        return len(self.pixels) - 1 - self.now
