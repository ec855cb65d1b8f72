"""`castray lesson` on the terminal: the list, a lesson's text, verdicts and hints."""

import os
import re
from typing import ClassVar

from rich.markdown import Markdown, Paragraph
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from lessons.plain import spelled
from lessons.words import MOMENT, TaskWords
from viewer.folded import Folded
from viewer.link import of_moment
from viewer.words import Speaker, asked, current

DISPLAYED = re.compile(r"^\$\$\s*(.+?)\s*\$\$\s*(?:\([\w-]+\))?[ \t]*$", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"(?<![\\$])\$([^$\n]+)\$")
WAYS = {"number": "NUMBER", "choice": "LETTER", "pixel": "X Y", "path": "PATH", "event": "EVENT", "bug": "ID"}


class _Paragraph(Paragraph):
    """One whose lines end where those of its language do."""

    def __rich_console__(self, console, options):
        yield Folded(self.text)


class _Markdown(Markdown):
    elements: ClassVar[dict] = Markdown.elements | {"paragraph_open": _Paragraph}


def command(run, verb, task):
    """The words that do something with a task."""
    more = "" if current() == asked(os.environ) else f" --lang {current()}"
    return f"castray lesson {run.lesson.number} {verb} {task}{more}"


def print_list(course, progress, console):
    """Every lesson: number, title, minutes, how many of its tasks are solved."""
    say = Speaker()
    table = Table(box=None, pad_edge=False)
    table.add_column(no_wrap=True)
    table.add_column(say("lesson.lesson"))
    for name in ("lesson.time", "lesson.col_solved"):
        table.add_column(say(name), justify="right", no_wrap=True)
    for lesson in course:
        solved = f"{len(progress.solved(lesson.number) & lesson.tasks.keys())}/{len(lesson.tasks)}"
        time = say("lesson.minutes", n=lesson.minutes)
        table.add_row(f"{lesson.number:02}", lesson.words[current()].title, time, solved)
    console.print(table)
    console.print(Folded(Text(f"\n{say('lesson.list')}")))


def print_lesson(run, progress, console):
    """The whole text, its numbers filled in, and below it how to open the places it speaks of."""
    lesson, say = run.lesson, Speaker()
    solved = progress.solved(lesson.number)
    console.print(
        Folded(Text(say("lesson.head", number=lesson.number, title=lesson.words[current()].title), "bold"))
    )
    about = {"n": lesson.minutes, "solved": len(solved & lesson.tasks.keys()), "tasks": len(lesson.tasks)}
    console.print(Folded(Text(say("lesson.about", **about) + "\n", "dim")))
    places = _places(lesson)
    for part in lesson.words[current()].body:
        if isinstance(part, TaskWords):
            _print_task(run, part, part.id in solved, places, console)
        else:
            print_text(run, part, console, places)
    _print_foot(run, places, say, console)


def _places(lesson):
    """The moments that the text and the questions lead to, in that order."""
    texts = (part.ask if isinstance(part, TaskWords) else part for part in lesson.words[current()].body)
    return list(dict.fromkeys(name for text in texts for _, name in MOMENT.findall(text)))


def _print_task(run, part, solved, places, console):
    say = Speaker()
    console.print(Folded(Text(say(f"lesson.{'done' if solved else 'task'}", id=part.id), "bold cyan")))
    print_text(run, part.ask, console, places, indent=2)
    for name, text in part.choices.items():
        console.print(Padding(Text.assemble((f"{name}) ", "cyan"), plain(run.fill(text))), (0, 0, 0, 2)))
    task = run.lesson.tasks[part.id]
    way = command(run, "--check", f"{part.id} {WAYS[task.kind]}")
    way += f" ({task.unit})" if task.unit else ""
    console.print(Padding(Folded(Text(say("lesson.answer", command=way), "dim")), (0, 0, 1, 2)))


def _print_foot(run, places, say, console):
    lesson = run.lesson
    console.print(Folded(Text(say("lesson.view", command=f"castray view --lesson {lesson.number}") + "\n")))
    console.print(Folded(Text(say("lesson.open"))))
    _print_places(lesson, places, console)
    console.print()
    if lesson.bugs:
        console.print(Folded(Text(say("lesson.mistake", bugs=say.listed(*lesson.bugs), bug=lesson.bugs[0]))))
    if lesson.references:
        console.print(Folded(Text(say("lesson.references", works="; ".join(lesson.references)))))


def _print_places(lesson, places, console):
    for k, name in enumerate(places, 1):
        console.print(
            Text.assemble((f"[{k}]", "cyan"), f" castray view '{of_moment(lesson.moments[name]).write()}'"),
            soft_wrap=True,
        )


def print_answer(run, text, console):
    """A hint, a reply or a solution, and how to open the places it speaks of."""
    places = list(dict.fromkeys(name for _, name in MOMENT.findall(text)))
    print_text(run, text, console, places)
    _print_places(run.lesson, places, console)


def print_text(run, text, console, places, indent=0):
    """One piece of Markdown; displayed formulas on lines of their own, places by their number."""
    filled = run.fill(text)
    pieces = DISPLAYED.split(filled)
    for k, piece in enumerate(pieces):
        if k % 2:
            console.print(Padding(Text(spelled(piece), "bold"), (0, 0, 1, indent + 4)))
        elif piece.strip():
            console.print(Padding(_Markdown(_inline(piece.strip(), places)), (0, 0, 1, indent)))


def _inline(text, places):
    """Markdown whose formulas are words and whose links to moments are numbers."""
    text = MOMENT.sub(lambda m: f"**{m[1]}** \\[{places.index(m[2]) + 1}\\]", text)
    return INLINE.sub(lambda m: re.sub(r"([\\*_\[\]<>`~])", r"\\\1", spelled(m[1])), text)


def plain(text):
    """A short text in one line, without marks."""
    text = MOMENT.sub(r"\1", text)
    text = INLINE.sub(lambda m: spelled(m[1]), text)
    return re.sub(r"(?<![\s*])\*+|\*+(?![\s*])|`", "", DISPLAYED.sub(lambda m: spelled(m[1]), text))


def print_verdict(run, task, verdict, done, finished, console):
    """Whether an answer was right, and what helps on. finished: whether no task of the lesson is open."""
    say, said = Speaker(), run.lesson.words[current()].tasks[task.id]
    if verdict.right:
        console.print(Folded(Text(say("lesson.right"), "bold green")))
        print_answer(run, said.solution, console)
        if finished:
            console.print(Folded(Text(say("lesson.all_solved"), "bold")))
        return
    console.print(Folded(Text(say("lesson.wrong"), "bold red")))
    if verdict.known in said.wrong:
        print_answer(run, said.wrong[verdict.known], console)
    _print_hint(run, said, done.hints, console)
    verb = ("hint", "next_hint") if done.hints < len(said.hints) else ("solution", "to_solution")
    way = command(run, f"--{verb[0]}", task.id)
    console.print(Folded(Text(say(f"lesson.{verb[1]}", command=way), "dim")))


def print_hint(run, said, number, more, console):
    """The hint with that number, and a word where it was the last one already."""
    _print_hint(run, said, number, console)
    if not more:
        say = Speaker()
        way = say("lesson.to_solution", command=command(run, "--solution", said.id))
        console.print(Folded(Text(say.sentences(say("lesson.no_hint"), way))))


def _print_hint(run, said, number, console):
    console.print(Folded(Text(Speaker()("lesson.hint", k=number, n=len(said.hints)), "bold")))
    print_answer(run, said.hints[number - 1], console)


def print_solution(run, said, console):
    """How the task is solved."""
    console.print(Folded(Text(Speaker()("lesson.solution"), "bold")))
    print_answer(run, said.solution, console)
