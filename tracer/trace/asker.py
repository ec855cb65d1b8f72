"""Recordings are asked in a process of its own, which can be ended: once, or kept for the next question."""

import multiprocessing
import threading

import numpy as np

from tracer.settings import TracerError
from tracer.trace import folder, query


def ask(path, text, limit=20, seconds=query.SECONDS):
    """What the recording at `path` answers to a condition or a SELECT, as plain values.

    A condition gives {"events", "paths", "pixels": how many match; "found": the first `limit` paths with
    their first matching event; "mask": [x, y, paths] of each pixel with matches}. A SELECT gives {"columns",
    "rows", "more": whether there were more than `limit`}. Raises TracerError: what is wrong, where, what
    there is.
    """
    asker = Asker(path)
    try:
        return asker.ask(text, limit, seconds)
    finally:
        asker.close()


class Asker:
    """Asks the recording at `path`, behind the walls of `query`; one question at a time, from any thread.

    The process is started by the first question, ended where one takes too long, and started anew by the
    next. `close` ends it for good.
    """

    def __init__(self, path):
        self.place = folder.whole(path)
        self._lock, self._child, self._line = threading.Lock(), None, None
        self._closed = False

    def ask(self, text, limit=20, seconds=query.SECONDS):
        """As ask, in the process that is kept."""
        query.check(text)
        return self._asked(("answer", text, limit), seconds)

    def columns(self, select, seconds=query.SECONDS):
        """{name: (R,) array} of all rows of a SELECT of ours: it is not looked at, so no reader's."""
        return self._asked(("columns", select, None), seconds)

    def close(self):
        """End the process, and the question it works on."""
        self._closed, child = True, self._child
        if child is not None:
            child.kill()  # whoever waits for its answer hears that there is none
        if self._lock.acquire(blocking=False):
            self._end()
            self._lock.release()

    def _asked(self, question, seconds):
        with self._lock:
            if self._closed:
                raise TracerError("query: the recording is not asked any more")
            if self._child is None:
                self._begin()
            try:
                self._line.send(question)
                if not self._line.poll(seconds):
                    self._end()
                    raise TracerError(f"query: took longer than {seconds:g} seconds; ask for less")
                good, answer = self._line.recv()
            except (EOFError, OSError):
                self._end()
                raise TracerError("query: ended without an answer (out of memory?); ask for less") from None
        if not good:
            raise answer
        return answer

    def _begin(self):
        context = multiprocessing.get_context("spawn")
        self._line, theirs = context.Pipe()
        self._child = context.Process(target=_live, args=(theirs, self.place), daemon=True)
        self._child.start()
        theirs.close()

    def _end(self):
        if self._child is not None:
            self._child.kill()
            self._child.join()
            self._line.close()
        self._child = self._line = None


def _live(line, place):
    """The child's life: question after question, until the other end is gone."""
    query.limit_memory()
    connection = None
    while True:
        try:
            question = line.recv()
        except (EOFError, KeyboardInterrupt):
            return
        try:
            connection = connection or query.connection(place)
            line.send((True, _answer(connection, place.level, *question)))
        except TracerError as error:
            line.send((False, error))
        except MemoryError:
            line.send((False, query.TOO_LARGE))


def _answer(connection, level, what, text, limit):
    if what == "answer":
        return query.answered(connection, level, text, limit)
    import duckdb

    try:
        found = connection.execute(text).fetchnumpy()
    except duckdb.Error as error:
        raise TracerError(f"query: {' '.join(str(error).split())[:300]}") from None
    return {name: np.ma.filled(column, _nothing(column)) for name, column in found.items()}


def _nothing(column):
    """What stands for NULL in a column."""
    return np.nan if column.dtype.kind == "f" else None
