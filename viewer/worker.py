"""Work that takes long, done beside the page: one job after another, in a thread of its own."""

import queue
import threading

from tracer.settings import TracerError


class Stopped(Exception):
    """What was begun is not wanted any more."""


class Worker:
    """Does jobs in their order. back: hands a call over to the thread that asked, as call_soon_threadsafe."""

    def __init__(self, back):
        self._back, self._jobs, self._thread = back, queue.SimpleQueue(), None

    def do(self, job, done, failed):
        """done(what job() gave) or failed(the TracerError) follows; neither, if the job was Stopped."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, daemon=True)
            self._thread.start()
        self._jobs.put((job, done, failed))

    def _work(self):
        while True:
            try:
                self._back(*outcome(*self._jobs.get()))
            except RuntimeError:  # the page is closed, and its loop with it
                return


def outcome(job, done, failed):
    """The call that tells what became of a job, and what it tells."""
    try:
        return done, job()
    except Stopped:
        return (lambda nothing: None), None
    except TracerError as error:
        return failed, error
    except (MemoryError, OSError) as error:
        return failed, TracerError(str(error) or "out of memory; ask for less")
