"""Submissions judged in a process of its own, so that each has a limit of time and none costs the others."""

import multiprocessing
from contextlib import suppress

from tracer.picture import is_picture
from tracer.settings import TracerError
from viewer.checking.submission import FAILED, Row, row_of

_STARTING = 60.0  # seconds that the process itself may take to be there


class Judge:
    """Judges submissions one after the other; as a context, so that its process ends with it.

    A log or a picture is judged in the process, which is kept: what a scene's mistakes look like is made
    once, and not in a picture's own time. Whoever takes longer than `seconds` is given up with the process.
    A tracer in Python has its own.
    """

    def __init__(self, scene, options, seconds):
        self._asked = scene, options, seconds
        self._process = self._pipe = None

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self._end()

    def row(self, path, name):
        """The Row of one file."""
        scene, options, seconds = self._asked
        if path.suffix.lower() == ".py":
            return row_of(path, name, scene, options, seconds)
        try:
            if self._process is None:
                self._start()
            self._pipe.send((path, name, scene, options, seconds))
            self._pipe.recv()  # when its own time begins
            if self._pipe.poll(seconds):
                return self._pipe.recv()
            why = f"{name}: not done after {seconds:g} s; give it fewer paths, or more time (--seconds)"
        except (EOFError, OSError):
            why = f"{name}: the process that judged it ended; is there enough memory?"
        self._end()
        return Row(name, FAILED, error=why, path=name)

    def _start(self):
        # Spawned: a fork would take the threads of its parent's libraries for its own
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_judging, args=(other,), daemon=True)
        self._process.start()
        other.close()
        if not self._pipe.poll(_STARTING):
            raise EOFError
        self._pipe.recv()

    def _end(self):
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._pipe.close()
        self._process = self._pipe = None


def _judging(pipe):
    """Answer until nobody asks any more."""
    from viewer.picture_doctor import album_of

    pipe.send(None)
    with suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            path, name, scene, *more = pipe.recv()
            if is_picture(path.name):
                with suppress(TracerError):  # which its row will say
                    album_of(scene)
            pipe.send(None)
            pipe.send(row_of(path, name, scene, *more))
