"""Every word that castray shows, in one table per language.

A module in this folder that defines WORDS = {language: {key: words}} adds its area to the tables; nothing
else needs to know it. Every key stands in every language with the same {names}; only what is worded where it
is declared (the schema of events, the doctor's laws, the zoo, errors) has no English here.
"""

import importlib
import pkgutil
import re
from functools import cache, partial
from string import Formatter

from viewer.words.language import LANGUAGES, asked, current, use

__all__ = ["LANGUAGES", "Speaker", "areas", "asked", "current", "table", "use"]


@cache
def areas():
    """Every area's tables by its name: {name: {language: {key: words}}}."""
    modules = (importlib.import_module(f"{__name__}.{m.name}") for m in pkgutil.iter_modules(__path__))
    found = {module.__name__.rpartition(".")[2]: vars(module).get("WORDS") for module in modules}
    return {name: tables for name, tables in found.items() if tables}


@cache
def table(language):
    """All words of a language by their keys."""
    return {key: words for tables in areas().values() for key, words in tables.get(language, {}).items()}


INNER = {"why", "what"}  # sentences of their own
CALLED = {"called", "neighbours", "colours"}  # terms of their own
FACTORS = ("cos of the light sample", "pdf of the light sample")
# What values look like where it matters: a place before a value may have colons in it, and no quotes.
GREEDY = r"""[^'"{]+"""
HELD = {"field": r"[\w.<>]+", "n": r"\S+", "name": "[^;]+"}
QUOTED = re.compile(r"""(["'])([^"']*)\1""")
APART = re.compile(r"(?<=[\u4e00-\u9fff]) (?=“)|(?<=”) (?=[\u4e00-\u9fff])")
# English counts in the plural, but for one thing: "1 paths" is "1 path".
ONE = re.compile(
    r"(?<![\d.,/-])(1 (?:path|event|pixel|sample|light sample|bounce|finding|statement|direction))s\b"
)


@cache
def _patterns(prefix):
    """Keys that begin so, with patterns of their English: first those that begin with words of their own, and
    of these, and of the others, those with most."""

    def parts(words):
        return [(text, name) for text, name, _, _ in Formatter().parse(words)]

    def pattern(words):
        found = parts(words)
        held = HELD | ({"place": GREEDY} if "value" in dict(map(reversed, found)) else {})
        return "".join(
            re.escape(text) + (f"(?P<{name}>{held.get(name, '.+?')})" if name else "") for text, name in found
        )

    def own(key):
        said = [len(text) for text, _ in parts(known[key])]
        return -said[0], -sum(said)

    known = {key: words for key, words in table("en").items() if key.startswith(prefix)}
    return [(key, re.compile(pattern(known[key]), re.DOTALL)) for key in sorted(known, key=own)]


def _quoted(value):
    """What stands in quotes, in those that Chinese has."""
    found = QUOTED.fullmatch(value)
    return f"“{found[2]}”" if found else value


class Speaker:
    """Looks words up: say("key", name=value). Without a language, in that of the terminal."""

    def __init__(self, language=None):
        self.language = language or current()
        self.words = table(self.language)

    def __call__(self, key, /, **values):
        said = self.words[key].format(**values)
        return ONE.sub(r"\1", said) if self.language == "en" else said

    def optional(self, key, otherwise):
        """The words for a key, or other ones where the table has none."""
        return self.words.get(key, otherwise)

    def meaning(self, kind, field):
        """What a field of an event means; the schema's own words unless the table has others."""
        return self.optional(f"field.{kind.name}.{field}", kind.field(field).meaning)

    def setting(self, name):
        """What a setting means; its own words unless the table has others."""
        from tracer.settings import Settings

        return self.optional(f"setting.{name}", Settings.__dataclass_fields__[name].metadata["help"])

    def dial(self, name):
        """What the page calls a setting."""
        return self.optional(f"dial.{name}", name)

    def dialed(self, value):
        """What the page says for a setting's value; a name, such as an integrator's, stays what it is."""
        from tracer.settings import told

        return self.optional(f"dialed.{told(value)}", told(value))

    def error(self, message):
        """An error in this language, with its place before it; in its own words where the table has none."""
        said = self._translated(message, "error.")
        if self.language == "en" or said != message:
            return said
        place, colon, rest = message.partition(": ")
        inner = self.error(rest) if colon else rest
        return self.words["clue.why"].join((place, inner)) if inner != rest else message

    def lacking(self, missing):
        """What the doctor lacks to judge a law, in this language."""
        return self._names(self._translated(missing, "lacking."))

    def need(self, words):
        """What a picture needs of the tracer, or why, in this language, part by part."""
        parts = (self._translated(part, "need.") for part in words.split("; "))
        return words if self.language == "en" else self.words["clue.and"].join(map(self._names, parts))

    def _names(self, words):
        """The same with names of things listed as this language lists them."""
        return words.replace(", ", self.words["join.list"])

    def formula(self, rule, formula):
        """The formula of one of the doctor's laws, with what words there are in it in this language."""
        return self.optional(f"formula.{rule}", formula)

    def quantity(self, name):
        """What the doctor calls a number that it judges."""
        return self.optional(f"quantity.{name}", name)

    def clue(self, explanation):
        """What the doctor says a broken law looks like, in this language, piece by piece."""
        if self.language == "en":
            return explanation
        joins = {": ": self.words["clue.why"], "; ": self.words["clue.and"]}
        parts = re.split(r"(; |(?<! ): )", explanation)
        return "".join(joins[part] if part in joins else self._piece(part) for part in parts)

    def _piece(self, part):
        said = self._translated(part, "clue.")
        if not part.startswith("recorded"):
            return said
        for factor in FACTORS:
            said = said.replace(factor, self.words[f"called.{factor}"])
        return re.sub(r"\bright\b", self.words["clue.right"], said)

    def _translated(self, message, prefix):
        if self.language != "en":
            for key, pattern in _patterns(prefix):
                found = pattern.fullmatch(message)
                if found:
                    values = found.groupdict()
                    if "which" in values:  # settings and their two values
                        values["which"] = self.listed(*map(self._differing, values["which"].split(", ")))
                    if "near" in values:  # several are joined by "or"
                        values["near"] = self.listed(*map(_quoted, values["near"].split(" or ")))
                    for inner in values.keys() & INNER:  # a sentence of its own
                        told = self.error if prefix == "error." else partial(self._translated, prefix=prefix)
                        values[inner] = told(values[inner])
                    for place in values.keys() & {"place", "path"}:
                        values[place] = values[place].replace(": ", self.words["clue.why"])
                    for listed in values.keys() & {"known", "names"}:
                        values[listed] = self._names(values[listed])
                    for term in values.keys() & CALLED:
                        values[term] = self.optional(f"called.{values[term]}", values[term])
                    if "kind" in values:
                        values["kind"] = self.optional(f"kind.{values['kind']}", values["kind"])
                    return APART.sub(
                        "", self(key, **{name: _quoted(value) for name, value in values.items()})
                    )
        return message

    def _differing(self, setting):
        """A setting of which two values are told, such as "jitter on and off"."""
        name, _, both = setting.partition(" ")
        one, _, other = both.partition(" and ")
        return self("dial.differs", name=self.dial(name), one=self.dialed(one), other=self.dialed(other))

    def sentences(self, *said):
        """Sentences one after another; empty ones are left out."""
        return self.words["join.sentences"].join(s for s in said if s)

    def listed(self, *said):
        """Things of a kind one after another."""
        return self.words["join.list"].join(said)

    def clauses(self, *said):
        """Parts of a sentence one after another."""
        return self.words["join.clauses"].join(said)

    def under(self, prefix):
        """All words of one panel, keyed by the rest of their name, for its template."""
        return {k.removeprefix(prefix): v for k, v in self.words.items() if k.startswith(prefix)}
