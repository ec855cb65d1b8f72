"""The command `castray lesson`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from tracer.settings import TracerError
from viewer.options import Json, Whole, print_json
from viewer.words import Speaker, current

Words = Parameter(consume_multiple=True, negative=())


def lesson(
    number: Annotated[int | None, Whole] = None,
    /,
    *,
    check: Annotated[list[str] | None, Words] = None,
    hint: Annotated[str | None, Parameter(negative=())] = None,
    solution: Annotated[str | None, Parameter(negative=())] = None,
    site: Path | None = None,
    solutions: bool = True,
    json: Json = False,
):
    """The lessons: list them; with a number, read that one, or check an answer to one of its tasks.

    Exit code of --check: 0 if the answer is right, 1 if not. Progress is kept in the user's state folder.

    Parameters
    ----------
    number
        Which lesson.
    check
        A task's name and your answer to it: --check window 2.5, or --check 120 80 for a pixel (without a
        name: the first task that is not solved).
    hint
        The next hint to a task.
    solution
        How a task is solved; try it first.
    site
        Write the lessons there as web pages that open without a network: all, or the one of that number.
    solutions
        Whether the pages say how tasks are solved.
    """
    from lessons.course import lesson as of
    from lessons.course import lessons
    from lessons.progress import Progress

    if site is not None:
        return _site(site, None if number is None else [of(number).number], solutions, json)
    progress = Progress()
    if number is None:
        if check or hint or solution:
            raise TracerError("lesson: which one? Give its number before the options")
        return _list(lessons().values(), progress, json)
    from lessons.run import Run

    run = Run(of(number))
    asked = [name for name, said in (("check", check), ("hint", hint), ("solution", solution)) if said]
    if len(asked) > 1:
        raise TracerError(f"lesson: --{asked[0]} and --{asked[1]} are for one at a time")
    if check is not None and not check:
        raise TracerError(f"lesson: {number} --check needs your answer behind it")
    if check:
        return _check(run, check, progress, json)
    if hint or solution:
        return (_hint if hint else _solution)(run, hint or solution, progress, json)
    return _show(run, progress, json)


def _site(folder, numbers, solutions, json):
    """Write the pages, and say where they begin."""
    from viewer.progress import watched
    from viewer.site import build

    with watched(Speaker()("site.making")) as progress:
        names = build(folder, numbers, solutions, progress=progress)
    if json:
        print_json({"folder": str(folder), "pages": names})
    else:
        first = folder / "index.html"
        print(Speaker()("site.written", n=len(names), folder=folder, first=first))


def _console():
    from rich.console import Console

    return Console(highlight=False)


def _list(course, progress, json):
    if json:
        print_json([_summary(lesson, progress) for lesson in course])
        return
    from viewer.lesson_report import print_list

    print_list(course, progress, _console())


def _summary(lesson, progress):
    return {
        "number": lesson.number,
        "title": lesson.words[current()].title,
        "minutes": lesson.minutes,
        "bugs": list(lesson.bugs),
        "tasks": list(lesson.tasks),
        "solved": sorted(progress.solved(lesson.number)),
    }


def _show(run, progress, json):
    if not json:
        from viewer.lesson_report import print_lesson

        print_lesson(run, progress, _console())
        return
    from viewer.link import of_moment

    lesson = run.lesson
    body = [_part(run, part) for part in lesson.words[current()].body]
    moments = {name: of_moment(moment).write() for name, moment in lesson.moments.items()}
    more = {"references": list(lesson.references), "moments": moments, "body": body}
    print_json(_summary(lesson, progress) | more)


def _part(run, part):
    """A piece of the text, or a task without what would give it away."""
    if isinstance(part, str):
        return {"text": run.fill(part)}
    choices = {name: run.fill(text) for name, text in part.choices.items()}
    task = run.lesson.tasks[part.id]
    asked = {"task": part.id, "kind": task.kind, "unit": task.unit or None, "text": run.fill(part.ask)}
    return asked | {"choices": choices, "hints": len(part.hints)}


def _check(run, said, progress, json):
    """Judge an answer; the exit code."""
    from lessons.answer import judge
    from viewer.lesson_report import print_verdict

    task, answer = _task_and_answer(run, said, progress)
    verdict = judge(run, task, answer)
    words = run.lesson.words[current()].tasks[task.id]
    done = progress.tried(run.lesson.number, task.id, verdict.right, len(words.hints))
    if json:
        print_json(_verdict(run, task, verdict, done, words))
    else:
        finished = progress.solved(run.lesson.number) >= run.lesson.tasks.keys()
        print_verdict(run, task, verdict, done, finished, _console())
    return 0 if verdict.right else 1


def _verdict(run, task, verdict, done, words):
    """What --check --json says."""
    shown = words.solution if verdict.right else words.wrong.get(verdict.known)
    hint = None if verdict.right else run.fill(words.hints[done.hints - 1])
    says = {"task": task.id, "right": verdict.right, "tries": done.tries, "hint": hint}
    return says | {"text": run.fill(shown) if shown else None}


def _task_and_answer(run, said, progress):
    lesson = run.lesson
    if said[0] in lesson.tasks or (len(said) > 1 and said[0].isalpha()):  # a word before an answer is a name
        name, answer = lesson.task(said[0]).id, said[1:]
    else:
        solved = progress.solved(lesson.number)
        name = next((t for t in lesson.tasks if t not in solved), next(iter(lesson.tasks)))
        answer = said
    if not answer:
        raise TracerError(f"lesson {lesson.number}: --check {name} needs your answer behind it")
    return lesson.tasks[name], answer


def _hint(run, name, progress, json):
    from viewer.lesson_report import print_hint

    words = run.lesson.words[current()].tasks[run.lesson.task(name).id]
    more = progress.of(run.lesson.number, name).hints < len(words.hints)
    done = progress.hinted(run.lesson.number, name, len(words.hints))
    if json:
        text = run.fill(words.hints[done.hints - 1])
        print_json({"task": name, "hint": text, "number": done.hints, "of": len(words.hints)})
    else:
        print_hint(run, words, done.hints, more, _console())


def _solution(run, name, progress, json):
    from viewer.lesson_report import print_solution

    words = run.lesson.words[current()].tasks[run.lesson.task(name).id]
    if progress.kept and not progress.of(run.lesson.number, name).tries:
        raise TracerError(Speaker()("lesson.try_first", number=run.lesson.number, id=name))
    if json:
        print_json({"task": name, "solution": run.fill(words.solution)})
    else:
        print_solution(run, words, _console())
