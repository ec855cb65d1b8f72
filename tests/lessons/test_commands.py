"""Commands that the lessons print are commands: a reader who types one off is not refused."""

import shlex
from functools import cache

import pytest
from cases import loaded
from cyclopts import CycloptsError

from lessons.course import lesson, lessons
from lessons.words import PLACEHOLDER, markdown
from tracer.scene_file.change import changed, parse
from tracer.settings import TracerError
from viewer.cli import command_line
from viewer.options import settings_and_steps
from viewer.words import Speaker


def commands(number):
    """Every `castray ...` of a lesson's English words, with some number where one is filled in."""
    for _, text in lesson(number).words["en"].texts:
        for token in markdown().parse(PLACEHOLDER.sub("1", text)):
            for child in token.children or ():
                if child.type == "code_inline" and child.content.startswith("castray "):
                    yield child.content


@cache
def app():
    return command_line(Speaker("en"))


def understood(line):
    """Take a command line apart as castray does; raises where it would be refused for its words."""
    _, bound, _ = app().parse_args(shlex.split(line)[1:], exit_on_error=False, print_error=False)
    asked, options = bound.arguments, bound.arguments.get("options")
    if options is not None:
        settings_and_steps(options)
        name = asked.get("scene") or asked["what"]
        changed(loaded(name), parse(getattr(options, "set", ())))


@pytest.mark.parametrize("number", lessons())
def test_every_command_of_a_lesson_is_understood(number):
    for line in dict.fromkeys(commands(number)):
        understood(line)


@pytest.mark.parametrize(
    "line",
    [
        "castray paint cornell",
        "castray view cornell --bugs B12",
        "castray view cornell --bug B99",
        "castray view cornell --set grey.reflectance=0.2",
        "castray inspect cornell",
    ],
)
def test_a_command_with_a_slip_is_seen(line):
    with pytest.raises((TracerError, CycloptsError)):
        understood(line)
