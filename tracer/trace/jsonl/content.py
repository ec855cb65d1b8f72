"""What a log holds: its lines as columns, and what is wrong with them."""

from dataclasses import dataclass, field

import numpy as np

from tracer.trace.jsonl import header

SHOWN = 20  # mistakes that are told one by one


@dataclass(frozen=True)
class Mistake:
    """What is wrong with a line, and with which field of it ("" for the whole)."""

    line: int
    field: str
    what: str

    def __str__(self):
        return f"line {self.line}: {self.field}{': ' if self.field else ''}{self.what}"


@dataclass
class Columns:
    """All lines of one sort. values: name -> (..., N), NaN where not given; given: name -> (N,)."""

    line: np.ndarray
    values: dict
    given: dict

    @property
    def size(self):
        """Number of lines."""
        return self.line.size

    def take(self, rows):
        """Some of the lines; this one's columns are given up one by one, to hold nothing twice."""
        values = {name: self.values.pop(name)[..., rows] for name in list(self.values)}
        return Columns(self.line[rows], values, {name: mask[rows] for name, mask in self.given.items()})


@dataclass
class Read:
    """What a file holds. columns: name of a kind, or None for calls -> Columns."""

    header: header.Header
    columns: dict = field(default_factory=dict)
    mistakes: list = field(default_factory=list)
    mistaken: int = 0  # all of them
    unknown: dict = field(default_factory=dict)  # fields that the format does not have -> first line
    lines: int = 0
    cut: bool = False  # whether the last line ends in its middle

    def tell(self, line, name, what):
        """Note a mistake."""
        self.mistaken += 1
        if len(self.mistakes) < SHOWN:
            self.mistakes.append(Mistake(line, name, what))
