"""Waves on several processes: this one and children beside it, kept from one render to the next.

Children are spawned, not forked: the same on every system. This process goes on tracing while they start and
while they work, so nothing waits for them. A job, a function of a task that can be pickled, is sent to each
child once. Results come back in the order of the tasks, because blocks of a pixel are added in order.
"""

import atexit
import multiprocessing
import os
import pickle
import signal
import threading
from collections import deque
from multiprocessing.connection import wait

from tracer.settings import TracerError

# Seconds of remaining work, on one core, from which starting children pays.
WORTH_A_START = 0.8
IN_FLIGHT = 2  # tasks a child has at once: one to work on, one so that it need not wait for the next

_crew = None
_free = threading.Lock()  # whoever has it has the children


def _serve(connection):
    """A child's life: trace what is asked until the other end is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    job = None
    connection.send(None)  # ready
    while True:
        try:
            kind, content = connection.recv()
        except (EOFError, OSError):
            return
        if kind == "job":
            job = pickle.loads(content)
            continue
        try:
            answer = True, job(content)
        except Exception as error:
            answer = False, error
        connection.send(answer)


class Crew:
    """Child processes, each with a line to it."""

    def __init__(self, children):
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        context = multiprocessing.get_context("spawn")
        self.lines, self._children, self._job = [], [], {}
        for _ in range(children):
            ours, theirs = context.Pipe()
            child = context.Process(target=_serve, args=(theirs,), daemon=True)
            child.start()
            theirs.close()
            self.lines.append(ours)
            self._children.append(child)

    @property
    def ready(self):
        """Lines to the children that have started and know the job."""
        return list(self._job)

    def greet(self, job):
        """Tell the job to the children that have started and do not know it yet."""
        new = [line for line in self.lines if line not in self._job]
        for line in wait(new, 0.0) if new else ():
            line.recv()
            self._job[line] = None
        waiting = [line for line, known in self._job.items() if known is not job]
        if waiting:
            content = pickle.dumps(job)
            for line in waiting:
                line.send(("job", content))
                self._job[line] = job

    def close(self):
        """End the children, whatever they are at."""
        for line, child in zip(self.lines, self._children, strict=True):
            line.close()
            child.terminate()
        for child in self._children:
            child.join()

    @property
    def alive(self):
        """Whether all children still run."""
        return all(child.is_alive() for child in self._children)


def crew(children):
    """The Crew of so many children, the one of last time if it fits."""
    global _crew
    if _crew is not None and (len(_crew.lines) != children or not _crew.alive):
        dismiss()
    if _crew is None:
        _crew = Crew(children)
    return _crew


def started(workers):
    """Whether the children for so many processes are there already."""
    return _crew is not None and len(_crew.lines) == workers - 1 and _crew.alive


@atexit.register
def dismiss():
    """End the children of earlier renders; the next one that needs some starts new ones."""
    global _crew
    if _crew is not None:
        _crew.close()
        _crew = None


def traced(job, tasks, workers):
    """Results of the tasks, in order, from `workers` processes, this one included.

    job: what gives the result of a task. Raises TracerError if a child dies.
    """
    if workers == 1 or not _free.acquire(blocking=False):  # another thread has the children
        yield from map(job, tasks)
        return
    work = _Work(job, tasks, crew(workers - 1))
    try:
        yield from work.results()
    except (EOFError, BrokenPipeError, ConnectionResetError):
        raise TracerError(
            "workers: a process was ended from outside (out of memory?); try fewer --workers"
        ) from None
    finally:
        if work.under_way:  # stopped half way: what the children still do is of no use
            dismiss()
        _free.release()


class _Work:
    """One job being done by a crew and this process."""

    def __init__(self, job, tasks, crew):
        self._job, self._crew = job, crew
        self._tasks = enumerate(tasks)
        self._asked = {line: deque() for line in crew.lines}  # numbers of the tasks each child has
        self._done = {}

    @property
    def under_way(self):
        """Whether children still work on it."""
        return any(self._asked.values())

    def results(self):
        """Results in order of the tasks."""
        number = 0
        while True:
            self._crew.greet(self._job)
            for line in self._crew.ready:
                self._ask(line, 1)
            task = next(self._tasks, None)  # before anybody gets a second one: there may be few
            for line in self._crew.ready:
                self._ask(line, IN_FLIGHT)
            self._collect(0.0)
            if task is not None:
                self._done[task[0]] = self._job(task[1])
            elif number not in self._done:
                if not self.under_way:
                    return
                self._collect(None)
            while number in self._done:
                yield self._done.pop(number)
                number += 1

    def _ask(self, line, most):
        """Give a child tasks until it has so many."""
        numbers = self._asked[line]
        while len(numbers) < most and (task := next(self._tasks, None)) is not None:
            numbers.append(task[0])
            line.send(("task", task[1]))

    def _collect(self, timeout):
        """Take in what children have finished; timeout: seconds to wait for that, None for as long as it
        takes."""
        if not self.under_way:
            return
        for line in wait([line for line, numbers in self._asked.items() if numbers], timeout):
            good, answer = line.recv()
            number = self._asked[line].popleft()
            if not good:
                raise answer
            self._done[number] = answer
