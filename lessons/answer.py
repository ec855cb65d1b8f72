"""Whether an answer to a task is right."""

import math
import re
from dataclasses import dataclass

from lessons import zoo
from tracer.settings import TracerError

NUMBER = re.compile(
    r"\s*([-+−]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)\s*(?:/\s*(\d+(?:[.,]\d+)?))?\s*(.*?)\s*"
)


@dataclass(frozen=True)
class Verdict:
    """right, and which of the plausible wrong answers it was (counted from 1), 0 if none of them."""

    right: bool
    known: int = 0


def judge(run, task, said):
    """The Verdict on an answer, said in words as on a command line (a list of str). Raises TracerError for
    what is no answer of the task's kind."""
    answer = READ[task.kind](run, task, said)
    if _right(run, task, answer):
        return Verdict(True)
    return Verdict(False, next((k for k, w in enumerate(wrong(run, task), 1) if _same(task, answer, w)), 0))


def right(run, task):
    """The right answer (of several: one of them)."""
    return _meant(run, task, task.answer)


def wrong(run, task):
    """The plausible wrong ones."""
    return [_meant(run, task, answer) for answer in task.wrong]


def spelled(answer):
    """An answer as the words of a command line."""
    return [str(part) for part in answer] if isinstance(answer, (list, tuple)) else [str(answer)]


def _meant(run, task, answer):
    if task.kind == "number" and isinstance(answer, str):
        return run.value(answer)
    if task.kind in ("path", "event") and isinstance(answer, str):
        return getattr(run.lesson.moments[answer], task.kind)
    return tuple(answer) if isinstance(answer, list) else answer


def _right(run, task, answer):
    if task.check:
        arguments = answer if isinstance(answer, tuple) else (answer,)
        return bool(getattr(run.lesson.claim, task.check)(run, *arguments))
    return _same(task, answer, right(run, task))


def _same(task, answer, other):
    if task.kind == "number":
        return math.isclose(answer, other, rel_tol=task.tolerance, abs_tol=1e-12)
    if task.kind == "bug":
        return answer in zoo.alike(other)
    return answer == other


def _number(run, task, said):
    text = " ".join(said)
    found = NUMBER.fullmatch(text)
    unit = found.group(3).lower() if found else ""
    known = {"", task.unit.lower(), *({"deg", "degrees", "度"} if task.unit == "°" else ()), "%"}
    if not found or unit not in known:
        wanted = f"a number in {task.unit}" if task.unit else "a number"
        raise TracerError(f"task {task.id}: {text!r} is not {wanted}")
    top = float(found.group(1).replace(",", ".").replace("−", "-"))
    bottom = float((found.group(2) or "1").replace(",", "."))
    if bottom == 0.0:
        raise TracerError(f"task {task.id}: {text!r} divides by 0")
    return top / bottom / (100.0 if unit == "%" and task.unit != "%" else 1.0)


def _choice(run, task, said):
    known = run.lesson.words["en"].tasks[task.id].choices
    text = " ".join(said).strip().lower()
    if text not in known:
        raise TracerError(f"task {task.id}: {text!r} is not among the answers {', '.join(known)}")
    return text


def _bug(run, task, said):
    text = " ".join(said).strip()
    return zoo.of(next((name for name in zoo.ZOO if name.lower() == text.lower()), text)).id


def _pixel(run, task, said):
    words = re.sub(r"[(),，]", " ", " ".join(said)).split()
    settings = run.settings(task.at)
    if len(words) != 2 or not all(word.isdecimal() for word in words):
        text = " ".join(said)
        raise TracerError(f"task {task.id}: {text!r} is not column and row of a pixel, two whole numbers")
    x, y = map(int, words)
    if not (x < settings.width and y < settings.height):
        raise TracerError(
            f"task {task.id}: pixel {x} {y} is outside the picture of {settings.width} x {settings.height}"
        )
    return x, y


def _counted(run, task, said):
    many = run.settings(task.at).spp if task.kind == "path" else len(run.path(task.at).events)
    text = " ".join(said).strip()
    if not text.isdecimal() or int(text) >= many:
        raise TracerError(f"task {task.id}: {text!r} is not the number of one, from 0 to {many - 1}")
    return int(text)


READ = {
    "number": _number,
    "choice": _choice,
    "bug": _bug,
    "pixel": _pixel,
    "path": _counted,
    "event": _counted,
}
