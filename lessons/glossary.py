"""One glossary for both languages: which Chinese words stand for which English term."""

import re
import tomllib
from functools import cache
from pathlib import Path

ENDINGS = "(?:s|es|al|ed)?"


@cache
def terms():
    """English term -> Chinese words that stand for it, the longest terms first."""
    text = (Path(__file__).parent / "glossary.toml").read_text(encoding="utf-8")
    found = tomllib.loads(text)
    return {name: tuple(found[name]) for name in sorted(found, key=len, reverse=True)}


def found(text):
    """The terms that an English text uses; a word belongs to the longest term that it is part of."""
    for term in terms():
        pattern = rf"(?<![\w-]){re.escape(term)}{ENDINGS}(?![\w-])"
        text, many = re.subn(pattern, " ", text, flags=re.IGNORECASE)
        if many:
            yield term


def missing(english, chinese):
    """Terms of an English text for which a Chinese one has no word of the glossary."""
    return [term for term in found(english) if not any(word in chinese for word in terms()[term])]
