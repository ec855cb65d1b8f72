"""What a reader has done, kept in one small file of the user; without it lessons work all the same."""

import json
import os
import sys
import warnings
from dataclasses import asdict, dataclass
from pathlib import Path

UNREADABLE = (LookupError, ValueError, TypeError, AttributeError)


@dataclass
class Done:
    """How far somebody is with one task."""

    tries: int = 0
    hints: int = 0
    solved: bool = False


def home():
    """The folder of the user's state: $XDG_STATE_HOME where it is set, or what the system uses."""
    said = os.environ.get("XDG_STATE_HOME")
    if said:
        return Path(said) / "castray"
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "castray"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "castray"
    return Path.home() / ".local" / "state" / "castray"


class Progress:
    """(lesson, task) -> Done, read when made and written at each change.

    kept: whether it could be. Where not, one warning says why.
    """

    def __init__(self, folder=None):
        self.kept = True
        self._done = {}
        try:
            self.file = (Path(folder) if folder else home()) / "lessons.json"
            self._done = _read(self.file)
        except (RuntimeError, OSError, *UNREADABLE) as error:
            self._give_up("read", error)

    def of(self, lesson, task):
        """How far the reader is with a task; a copy."""
        return Done(**asdict(self._done.get((lesson, task), Done())))

    def solved(self, lesson):
        """The ids of a lesson's solved tasks."""
        return {task for (number, task), done in self._done.items() if number == lesson and done.solved}

    def tried(self, lesson, task, right, hints):
        """Note a try, after which a wrong answer shows the next of so many hints; the Done that it makes."""
        done = self.of(lesson, task)
        done.tries += 1
        done.solved |= right
        if not right:
            done.hints = min(done.hints + 1, hints)
        self.note(lesson, task, done)
        return done

    def hinted(self, lesson, task, hints):
        """Note that the next of so many hints is shown; the Done that it makes."""
        done = self.of(lesson, task)
        done.hints = min(done.hints + 1, hints)
        self.note(lesson, task, done)
        return done

    def note(self, lesson, task, done):
        """Keep how far the reader is."""
        self._done[lesson, task] = done
        if not self.kept:
            return
        try:
            self._done = _read(self.file) | {(lesson, task): done}  # others may have written meanwhile
            self._write()
        except OSError as error:
            self._give_up("written", error)
        except UNREADABLE as error:
            self._give_up("read", error)

    def _write(self):
        self.file.parent.mkdir(parents=True, exist_ok=True)
        document = {}
        for (number, task), done in self._done.items():
            document.setdefault(f"{number:02}", {})[task] = asdict(done)
        partial = self.file.with_name(f"{self.file.name}.{os.getpid()}.partial")
        try:
            partial.write_text(json.dumps(document, indent=1), encoding="utf-8")
            partial.replace(self.file)
        finally:
            partial.unlink(missing_ok=True)

    def _give_up(self, verb, error):
        self.kept = False
        where = getattr(self, "file", "the user's folder")
        why = error.strerror if isinstance(error, OSError) else "it is not what castray wrote"
        warnings.warn(f"progress is not kept: {where} cannot be {verb}: {why}", stacklevel=2)


def _read(file):
    if not file.exists():
        return {}
    document = json.loads(file.read_text(encoding="utf-8"))
    return {
        (int(number), task): Done(int(d["tries"]), int(d["hints"]), bool(d["solved"]))
        for number, tasks in document.items()
        for task, d in tasks.items()
    }
