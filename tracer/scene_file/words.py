"""Reading the tables of a scene word by word, with errors that name the place and what would do."""

import sys

import numpy as np

from tracer.settings import TracerError

MISSING = object()  # a word without a default
LARGEST = 1e15  # of all numbers in a scene: products of several are then still numbers


class SceneWarning(UserWarning):
    """Something a scene file says that castray takes from elsewhere: one line that says what and where."""


def listed(names):
    """Names in one line."""
    return ", ".join(map(str, names))


def near(word, known):
    """A hint at the known word that `word` may have been meant to be, or nothing."""
    from difflib import get_close_matches

    match = get_close_matches(str(word), known, 1)
    return f"did you mean {match[0]!r}? " if match else ""


class Words:
    """A table that is read word by word; finish() names the words nobody asked for."""

    def __init__(self, table, place):
        if not isinstance(table, dict):
            raise TracerError(f"{place}: is {shown(table)}, but has to be a table with a type")
        self.table, self.place, self._known = table, place, []

    def take(self, word, default=MISSING):
        """The value of a word; TracerError if it is missing and has no default."""
        self._known.append(word)
        if word in self.table:
            return self.table[word]
        if default is MISSING:
            raise TracerError(f"{self.place}.{word}: is missing")
        return default

    def finish(self):
        """TracerError for the first word that nothing understood."""
        for word in self.table:
            if word not in self._known:
                known = f"{near(word, self._known)}known here: {listed(self._known)}"
                raise TracerError(f"{self.place}.{word}: unknown word; {known}")


def real(value, place, least=-LARGEST, most=LARGEST):
    """A finite number within limits."""
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TracerError(f"{place}: {shown(value)} is not a number")
    if not -sys.float_info.max <= value <= sys.float_info.max:  # a whole number may be larger than any float
        raise TracerError(f"{place}: {shown(value)} is not a finite number")
    if not least <= value <= most:
        raise TracerError(f"{place}: {value:g} is out of range; it has to be from {least:g} to {most:g}")
    return float(value)


def switch(table, word, default):
    """True or false from a table of Words; the default where nothing is said."""
    value = table.take(word, default)
    if value is not default and not isinstance(value, bool):
        raise TracerError(f"{table.place}.{word}: {shown(value)} is neither true nor false")
    return value


def one_of(table, word, known, default=None):
    """One of the known words from a table of Words; `default`, or else the first, where nothing is said."""
    value = table.take(word, default or next(iter(known)))
    if not isinstance(value, str) or value not in known:
        raise TracerError(
            f"{table.place}.{word}: {shown(value)} is not known; {near(value, known)}known: {listed(known)}"
        )
    return value


def shown(value):
    """A value as an error message shows it: however it is nested, in part of a line."""
    try:
        text = repr(value)
    except ValueError:  # a whole number of thousands of digits
        text = "a huge number"
    return text if len(text) <= 80 else f"{text[:77]}..."


def triple(value, place, least=-LARGEST, most=LARGEST):
    """Three finite numbers within limits, (3,) float64."""
    if not isinstance(value, (list, tuple, np.ndarray)) or len(value) != 3:
        raise TracerError(f"{place}: {shown(value)} is not a list of three numbers")
    return np.array([real(v, f"{place}[{k}]", least, most) for k, v in enumerate(value)])


def colour(value, place, most=LARGEST, others=()):
    """A linear RGB colour from a number, three numbers, or {type = "rgb", value = ...}, (3,) float64.

    others: what else may stand there, for the message.
    """
    if isinstance(value, dict):
        table = Words(value, place)
        if table.take("type") != "rgb":
            known = listed(("rgb", *others))
            raise TracerError(f"{place}.type: {shown(value['type'])} is not supported; known: {known}")
        value = table.take("value")
        table.finish()
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        value = [value] * 3
    return triple(value, place, 0.0, most)
