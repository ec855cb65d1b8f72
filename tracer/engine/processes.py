"""Waves on several processes, for work that is worth their start.

Workers are spawned, not forked: the same on every system. Results come back in the order of the tasks,
because blocks of a pixel are added in order.
"""

import multiprocessing
import os
import signal
from collections import deque
from concurrent.futures import ProcessPoolExecutor
from itertools import islice

from tracer.engine.waves import trace

# Seconds of remaining work, on one core, from which starting workers pays.
WORTH_A_START = 1.5

_job = None


def _begin(*job):
    global _job
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _job = job


def _trace(task):
    return trace(*_job, task)


def traced(job, tasks, workers):
    """Results of the tasks, in order, from `workers` processes. job: scene, settings, steps."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _begin, job)
    try:
        tasks = iter(tasks)
        waiting = deque(pool.submit(_trace, task) for task in islice(tasks, 4 * workers))
        while waiting:
            yield waiting.popleft().result()
            waiting.extend(pool.submit(_trace, task) for task in islice(tasks, 1))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
