"""The words of a lesson in one language: Markdown in which tasks stand as `:::` boxes.

::: task ID      the question
::: choice ID    an answer to choose (kind choice)
::: hint         one step of help; several, in order
::: wrong N      what to say to the N-th of the wrong answers
::: solution     shown after a try
:::              end of the task
"""

import re
import tomllib
from dataclasses import dataclass, field
from functools import cache

FRONT = re.compile(r"\A\+\+\+\n(.*?)^\+\+\+\n", re.DOTALL | re.MULTILINE)
PLACEHOLDER = re.compile(r"\{\{\s*([\w.-]+)\s*(?::([^}\s]*))?\s*\}\}")
MOMENT = re.compile(r"\[([^\]]+)\]\(#([\w-]+)\)")

# Chinese has no spaces: a line of it that goes on in the next one does so without one.
JOINED = re.compile(
    r"(?<=[\u3000-\u303f\uff00-\uff65])\n(?=[^\s:#>|*$-]|\$[^$]|\*)|(?<=[\u4e00-\u9fff])\n(?=[\u3000-\u9fff\uff00-\uff65])"
)


@dataclass
class TaskWords:
    """What a task says, each part in Markdown."""

    id: str
    ask: str = ""
    choices: dict = field(default_factory=dict)
    hints: list = field(default_factory=list)
    wrong: dict = field(default_factory=dict)
    solution: str = ""

    @property
    def parts(self):
        """Every part by name, in order."""
        hints = {f"hint {k}": text for k, text in enumerate(self.hints, 1)}
        choices = {f"choice {k}": text for k, text in self.choices.items()}
        wrong = {f"wrong {k}": text for k, text in self.wrong.items()}
        return {"ask": self.ask} | choices | hints | wrong | {"solution": self.solution}


class Words:
    """Title, and the body as a list of Markdown texts and TaskWords. ValueError where it cannot be read."""

    def __init__(self, front, body):
        self.title = tomllib.loads(front)["title"]
        self.body = list(_parts(JOINED.sub("", body)))

    @property
    def tasks(self):
        """id -> TaskWords."""
        return {part.id: part for part in self.body if isinstance(part, TaskWords)}

    @property
    def texts(self):
        """Every piece of Markdown by where it stands: (place, text)."""
        for k, part in enumerate(self.body):
            if isinstance(part, TaskWords):
                yield from ((f"task {part.id}, {name}", text) for name, text in part.parts.items())
            else:
                yield f"text {k}", part


def split(text):
    """Front matter and body of a file. ValueError without front matter."""
    front = FRONT.match(text)
    if not front:
        raise ValueError("begins with front matter between two lines +++")
    return front.group(1), text[front.end() :]


def _parts(body):
    """The body, cut where tasks begin and end."""
    plain, task, place = [], None, None
    for line in body.splitlines():
        if not line.startswith(":::"):
            (plain if task is None else place).append(line)
            continue
        kind, _, name = line.removeprefix(":::").strip().partition(" ")
        if task is None and kind == "task":
            if "".join(plain).strip():
                yield "\n".join(plain).strip()
            plain, task, place = [], TaskWords(name), []
            pieces = [("ask", "", place)]
        elif task is not None and kind in ("choice", "hint", "wrong", "solution"):
            place = []
            pieces.append((kind, name, place))
        elif task is not None and not kind:
            yield _filled(task, pieces)
            task = None
        else:
            raise ValueError(f"{line!r} has no place here")
    if task is not None:
        raise ValueError(f"task {task.id} has no end, a line :::")
    if "".join(plain).strip():
        yield "\n".join(plain).strip()


def _filled(task, pieces):
    for kind, name, lines in pieces:
        text = "\n".join(lines).strip()
        if kind == "choice":
            task.choices[name] = text
        elif kind == "wrong":
            task.wrong[int(name)] = text
        elif kind == "hint":
            task.hints.append(text)
        else:
            setattr(task, kind, text)
    return task


@cache
def markdown():
    """The reader of our Markdown: CommonMark, tables, formulas between dollars, labelled where displayed."""
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    reader = MarkdownIt("commonmark").enable("table")
    return reader.use(dollarmath_plugin, allow_labels=True, allow_space=False, allow_digits=False)


def blocks(text):
    """The blocks of a text as (type, text, shared): shared is what no language may change, in any order:
    links, placeholders, formulas, code."""
    for token in markdown().parse(text):
        if token.type == "inline":
            yield token.type, token.content, sorted([*_shared(token), *_placeholders(token.content)])
        elif token.type.startswith("math_block") or token.type in ("fence", "code_block"):
            yield token.type, "", [token.content.strip(), token.info]
        else:
            yield token.type, "", []


def labels(text):
    """label -> LaTeX of the displayed formulas of a text; a formula without one has the label ""."""
    found = (token for token in markdown().parse(text) if token.type.startswith("math_block"))
    return {token.info: token.content.strip() for token in found}


def _placeholders(text):
    return [":".join(filter(None, found)) for found in PLACEHOLDER.findall(text)]


def _shared(token):
    for child in token.children or ():
        if child.type in ("math_inline", "code_inline"):
            yield child.content
        elif child.type == "link_open":
            yield child.attrs["href"]
