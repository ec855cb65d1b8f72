"""A reader of the course in the viewer: which lesson is open, what was answered, which help was asked for."""

from dataclasses import dataclass, field
from typing import Any

from lessons.answer import judge
from lessons.course import lesson
from lessons.html import body
from lessons.progress import Progress
from lessons.run import Run
from tracer.settings import TracerError
from viewer.link import of_moment
from viewer.words import LANGUAGES

# Kinds of tasks that are answered by going somewhere, and how much of x, y and path they give.
PLACES = {"pixel": 0, "path": 2, "event": 3}
LONGEST = 200


@dataclass
class Reading:
    """An open lesson.

    texts: language -> its body as HTML, none before it is made. replies: task -> the Verdict on what was
    answered last, or why that was no answer. shown: tasks whose solution is shown. judging: the task whose
    answer is being looked at.
    """

    run: Run
    texts: dict = field(default_factory=dict)
    replies: dict = field(default_factory=dict)
    shown: set = field(default_factory=set)
    judging: str = ""
    error: TracerError | None = None


@dataclass
class Course:
    """How far somebody is, and the lesson that is open."""

    progress: Progress = field(default_factory=Progress)
    open: Any = None


def course_of(session):
    """The Course of a session."""
    return session.shelf.setdefault("lesson", Course())


def address(moment):
    """Where a link to a moment leads."""
    return f"#{of_moment(moment).write()}"


def stands_at(session, run, task):
    """Whether the reader stands where a task is about, as far as the task gives that."""
    at, c, given = run.lesson.moments[task.at], session.cursor, PLACES[task.kind]
    as_it_is = session.scene.name == at.scene and not session.scene.definition.changes
    same = as_it_is and session.settings == run.settings(task.at)
    return same and (c.x, c.y, c.path)[:given] == (at.x, at.y, at.path)[:given]


class Reader:
    """What the page may ask of the course. worker: does what takes long."""

    def __init__(self, window, worker):
        self.window, self.session, self.worker = window, window.session, worker

    @property
    def course(self):
        return course_of(self.session)

    def open(self, number, stay=False):
        """Open a lesson, and the viewer where it begins; stay: a link leads there, or nobody wants to go."""
        if type(number) is not int:
            raise TracerError(f"lesson: {str(number)[:20]!r} is not a whole number")
        it = lesson(number)
        if stay is not True:
            self.window.open(of_moment(it.moments["start"]))
        self.window.state.touched = True
        self.course.open = reading = Reading(Run(it))

        def done(texts):
            reading.texts = texts
            self._show(reading)

        def failed(error):
            reading.error = error
            self._show(reading)

        self.worker.do(lambda: _texts(reading.run), done, failed)
        self._show(reading)

    def close(self):
        """Back to the list."""
        self.course.open = None
        self.window.show("lesson")

    def answer(self, task, said=""):
        """Have an answer judged; where a place is asked for, that is where the reader stands."""
        reading, task = self._task(task)
        if reading.judging:
            return
        try:
            words = self._place(reading.run, task) if task.kind in PLACES else [_short(said)]
        except TracerError as error:
            reading.replies[task.id] = error
            self._show(reading)
            return

        def done(verdict):
            reading.judging, reading.replies[task.id] = "", verdict
            hints = len(reading.run.lesson.words["en"].tasks[task.id].hints)
            self.course.progress.tried(reading.run.lesson.number, task.id, verdict.right, hints)
            if verdict.right:
                reading.shown.add(task.id)
            self._show(reading)

        def failed(error):
            reading.judging, reading.replies[task.id] = "", error
            self._show(reading)

        reading.judging = task.id
        self.worker.do(lambda: judge(reading.run, task, words), done, failed)
        self._show(reading)

    def hint(self, task):
        """Show the next hint to a task."""
        reading, task = self._task(task)
        hints = len(reading.run.lesson.words["en"].tasks[task.id].hints)
        self.course.progress.hinted(reading.run.lesson.number, task.id, hints)
        self._show(reading)

    def solution(self, task):
        """Show how a task is solved, after an honest try."""
        reading, task = self._task(task)
        number = reading.run.lesson.number
        if not self.course.progress.of(number, task.id).tries:
            raise TracerError(f"try first: castray lesson {number} --check {task.id} ANSWER")
        reading.shown.add(task.id)
        self._show(reading)

    def _task(self, name):
        reading = self.course.open
        if reading is None:
            raise TracerError("lesson: none is open")
        return reading, reading.run.lesson.task(_short(name))

    def _place(self, run, task):
        """Where the reader stands, in words; TracerError where the task is about another place."""
        if not stands_at(self.session, run, task):
            raise TracerError(f"task {task.id}: it is about another place; go there first")
        c = self.session.cursor
        return {"pixel": [str(c.x), str(c.y)], "path": [str(c.path)], "event": [str(c.event)]}[task.kind]

    def _show(self, reading):
        if self.course.open is reading:
            self.window.show("lesson")


def _short(said):
    if not isinstance(said, str) or len(said) > LONGEST:
        raise TracerError("lesson: an answer is a short text")
    return said


def _texts(run):
    return {language: list(body(run, language, _href(run))) for language in LANGUAGES}


def _href(run):
    return lambda name: address(run.lesson.moments[name])
