"""A mistake that no catalogue has."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Mistake:
    """id; words: what is wrong; laws: ids of rules, any of which may fire first, none where nothing is wrong;
    diagnosed: the Diagnosis of a program that makes it; fair: ids of the catalogue that are no wrong name for
    it; batch: those that were written together, before what they showed was mended."""

    id: str
    words: str
    laws: tuple
    diagnosed: Callable
    fair: tuple = ()
    batch: str = "first"
