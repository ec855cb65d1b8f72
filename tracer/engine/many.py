"""Tasks on the processes of many machines, by whatever gives futures for them (concurrent.futures.Executor).

A task is a pure function of its numbers, so it does not matter who does it, how often, or when: results are
taken in the order of the tasks, as everywhere. The size of tasks follows ARCHITECTURE.md, "Many machines".
"""

from concurrent.futures import FIRST_COMPLETED, wait
from itertools import islice

import numpy as np

from tracer.engine import parts, waves

MOST_PATHS = 1 << 23  # of a task: seconds of work, so that one scheduler has 1000 processes at work
TASKS_EACH = 16  # that a process gets at least, so that they end together
AT_ONCE = 3  # tasks under way for each process: one being done, the others on their way
# Tasks for each process that may be done before an earlier one is: while a slow worker's result is waited
# for, those of the others take memory.
AHEAD = 12
LOOK = 1.0  # seconds after which Ctrl-C is heard at the latest, and workers are counted where nothing comes


class Lost(Exception):
    """The machines cannot be reached any more; the message says which."""


class ClusterWarning(UserWarning):
    """Something about the machines that whoever waits for the picture should know."""


def left(settings, processes, sheet):
    """The parts in which so many processes share what a Film, filled from its first pixel on, lacks."""
    pixels, begin = settings.width * settings.height, int(np.count_nonzero(sheet.samples))
    each = (pixels - begin) * settings.spp // (TASKS_EACH * processes)
    lanes = max(min(max(each, waves.LANES), MOST_PATHS), settings.spp)  # a pixel's samples stay together
    return parts.cut(parts.Part(0, slice(begin, pixels), 0, settings.spp), lanes)


def traced(job, tasks, cluster):
    """Results of the tasks, in their order. cluster: a tracer.cluster.Cluster. Raises Lost.

    No more than AHEAD x processes of them are asked for or held back at a time.
    """
    place, tasks = cluster.place(job), enumerate(tasks)
    asked, done, number = {}, {}, 0
    cluster.look(moving=True)
    try:
        while True:
            free = AT_ONCE * cluster.processes - len(asked)
            near = AHEAD * cluster.processes - len(asked) - len(done)
            for k, task in islice(tasks, min(free, near)):
                asked[cluster.submit(place, task)] = k
            if not asked:
                return
            ready = wait(asked, LOOK, FIRST_COMPLETED).done
            cluster.look(moving=bool(ready))
            for future in ready:
                done[asked.pop(future)] = cluster.result(future)
            while number in done:
                yield done.pop(number)
                number += 1
    finally:
        for future in asked:  # stopped half way: what has not begun is of no use
            future.cancel()
