"""A lesson as its author wrote it: what both languages share, and the words of each.

A folder lNN_name of `lessons/course/` holds `en.md` (front matter and English words), `zh.md` (Chinese words)
and `claim.py`. CONTRIBUTING.md has the form. Nothing is rendered here.
"""

import re
import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from importlib import import_module
from pathlib import Path
from pkgutil import resolve_name

from lessons.words import Words, split
from tracer.scene_file.change import parse, plain
from tracer.settings import TracerError

LANGUAGES = ("en", "zh")
KINDS = ("number", "choice", "pixel", "path", "event", "bug")


@dataclass(frozen=True)
class Moment:
    """A place that the text speaks of. lands: what is to be found there: kind of event and fields by name.
    changes: of the scene's words, {key: value}, as `--set` says them."""

    id: str
    scene: str
    settings: dict
    x: int
    y: int
    path: int = 0
    event: int = 0
    lands: dict = field(default_factory=dict)
    changes: dict = field(default_factory=dict)


@dataclass(frozen=True)
class Formula:
    """A formula of the text by its label: the function that computes it, the test that proves it."""

    label: str
    function: str
    test: str

    @property
    def computed(self):
        """The function itself. ImportError or AttributeError if there is none of that name."""
        return resolve_name(self.function)


@dataclass(frozen=True)
class Task:
    """One question.

    answer: the right one, or the name of a value of the claim. wrong: plausible wrong ones, likewise. check:
    name of the claim's function that judges an answer instead. tolerance: relative, of numbers. at: the
    moment in whose pixel a path, or in whose path an event is sought.
    """

    id: str
    kind: str
    answer: object
    wrong: tuple
    tolerance: float = 0.02
    unit: str = ""
    check: str = ""
    at: str = "start"


class Lesson:
    """One folder of the course."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.number = int(re.match(r"l(\d\d)_", self.folder.name).group(1))

    @cached_property
    def words(self):
        """language -> Words."""
        return {language: self._words(language) for language in LANGUAGES}

    def _words(self, language):
        try:
            return Words(*self._split(language))
        except ValueError as error:
            raise TracerError(f"{self.folder.name}/{language}.md: {error}") from None

    def _split(self, language):
        return split((self.folder / f"{language}.md").read_text(encoding="utf-8"))

    @cached_property
    def front(self):
        """The front matter that both languages share, as it is written."""
        try:
            return tomllib.loads(self._split("en")[0])
        except ValueError as error:
            raise TracerError(f"{self.folder.name}/en.md: {error}") from None

    @property
    def minutes(self):
        return self.front["minutes"]

    @property
    def bugs(self):
        """Ids in the zoo of the mistakes that it explains, the one whose path it shows first."""
        return tuple(self.front.get("bugs", ()))

    @property
    def references(self):
        """Works as REFERENCES.md names them."""
        return tuple(self.front.get("references", ()))

    @cached_property
    def moments(self):
        """id -> Moment. Scene, pixel and path that one leaves out are those of `start`; settings are added to
        the lesson's. TracerError where a change of the scene is none."""
        start = self.front["moment"]["start"]
        kept = {k: start[k] for k in ("scene", "x", "y", "path") if k in start}
        return {name: self._moment(name, kept | said) for name, said in self.front["moment"].items()}

    def _moment(self, name, said):
        settings = self.front.get("settings", {}) | said.get("settings", {})
        place = {k: said[k] for k in ("x", "y", "path", "event", "lands") if k in said}
        changes = plain(parse(said.get("set", ())))
        return Moment(name, said.get("scene", self.front["scene"]), settings, **place, changes=changes)

    @cached_property
    def formulas(self):
        """label -> Formula."""
        return {label: Formula(label, **said) for label, said in self.front.get("formula", {}).items()}

    @cached_property
    def tasks(self):
        """id -> Task, in the order of the text."""
        return {t["id"]: Task(**(t | {"wrong": tuple(t["wrong"])})) for t in self.front["task"]}

    def task(self, name):
        """The task with that id. Raises TracerError with the ids there are."""
        if name not in self.tasks:
            raise TracerError(
                f"lesson {self.number}: {name!r} is no task of it; there are {', '.join(self.tasks)}"
            )
        return self.tasks[name]

    @cached_property
    def claim(self):
        """The module claim.py."""
        return import_module(f"lessons.course.{self.folder.name}.claim")
