"""The numbered lessons, one folder each."""

from functools import cache
from pathlib import Path

from lessons.lesson import Lesson
from tracer.settings import TracerError


@cache
def lessons():
    """number -> Lesson, in order."""
    found = (Lesson(folder) for folder in sorted(Path(__file__).parent.glob("l[0-9][0-9]_*")))
    return {lesson.number: lesson for lesson in found}


def about(bug):
    """The number of the lesson that explains a mistake of the zoo, None if none does."""
    return next((number for number, it in lessons().items() if bug in it.bugs), None)


def lesson(number):
    """The lesson with that number. Raises TracerError with the numbers there are."""
    if number not in lessons():
        raise TracerError(f"lesson: there is no {number}; there are {', '.join(map(str, lessons()))}")
    return lessons()[number]
