"""One line of ACCURACY.md: many independent chunks, and what they add up to."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """What is measured, and what is asked of it.

    measure(chunk's seed) gives a dict of numbers; those of all chunks are put together by `together`.
    judge(sums, chunks) gives (what is printed, whether it is good enough).
    """

    key: str  # as `--only` takes it, and the line's name in ACCURACY.md
    what: str
    bar: str  # what castray asks of itself
    anchors: str  # what trusted renderers ask of themselves
    precision: str
    chunks: int
    n: int  # rays, paths, samples or intervals in a chunk
    measure: Callable
    judge: Callable


def together(rows):
    """One dict of many: numbers added up; the largest, if the name starts with "most"; lists joined."""
    return {name: _together(name, [row[name] for row in rows]) for name in rows[0]}


def _together(name, values):
    if isinstance(values[0], list):
        return [value for part in values for value in part]
    return (max if name.startswith("most") else sum)(values)
