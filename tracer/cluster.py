"""The processes of many machines as one thing to trace with: any Executor, or a dask.distributed cluster.

Machines may be of different kinds. Every result comes with its maker's fingerprint: where it is not the one
of this machine, that is said once, since the picture is then not promised bit for bit.
"""

import asyncio
import logging
import pickle
import time
import warnings
from concurrent.futures import BrokenExecutor, CancelledError, ThreadPoolExecutor
from contextlib import contextmanager

from tracer.engine.many import ClusterWarning, Lost
from tracer.settings import TracerError
from tracer.trace.fingerprint import differences, fingerprint

PATIENCE = (
    5.0  # seconds to wait for a scheduler, for its first worker, and until it is said that all are gone
)
ANSWER = 2.0  # seconds to wait for a scheduler that has answered before
LONGEST = 600.0  # seconds to wait for a worker to come back


class Cluster:
    """An Executor and what is known about it.

    processes: how many tasks it does at once. place: puts a job where all its processes find it, once,
    instead of sending it with each task; gives what is sent in its place. name: what a message calls it.
    working: tells whether there is any worker now; without it there is taken to be one.
    """

    def __init__(
        self, executor, processes=1, place=lambda job: job, name="the cluster", working=lambda: True
    ):
        self.processes, self.place, self.name = max(processes, 1), place, name
        self.lost = False
        self._executor, self._working = executor, working
        self._strangers = set()
        self._seen, self._told = time.monotonic(), False

    def submit(self, job, task):
        """The Future of a task."""
        with self._lost_if_broken():
            return self._executor.submit(told, job, task)

    def result(self, future):
        """What a Future that is done has brought. Raises Lost."""
        with self._lost_if_broken():
            there, result = future.result()
        strange = "; ".join(differences(there))
        if strange and strange not in self._strangers:
            self._strangers.add(strange)
            warnings.warn(
                f"cluster: a worker is of another kind ({strange}); the picture agrees with one made here "
                "statistically, not bit by bit",
                ClusterWarning,
                stacklevel=2,
            )
        return result

    def look(self, moving):
        """While results are waited for: a warning where there has been no worker for PATIENCE seconds, Lost
        where there has been none for LONGEST. moving: whether a result has just come."""
        now = time.monotonic()
        if moving or self._working():
            self._seen, self._told = now, False
        elif now - self._seen > LONGEST:
            self.lost = True
            raise Lost(f"cluster: {self.name} has had no worker for {LONGEST:g} seconds")
        elif now - self._seen > PATIENCE and not self._told:
            self._told = True
            warnings.warn(
                f"cluster: {self.name} has no worker any more; it goes on when one comes back within "
                f"{LONGEST:g} seconds, and Ctrl-C keeps what is done",
                ClusterWarning,
                stacklevel=2,
            )

    @contextmanager
    def _lost_if_broken(self):
        try:
            yield
        except TracerError:
            raise
        except (CancelledError, BrokenExecutor) as error:
            self.lost = True
            raise Lost(f"cluster: {self.name} is lost{_why(error)}") from None
        except Exception as error:  # castray is not there, a task that kills every worker, ...
            self.lost = True
            kind = type(error).__name__
            raise Lost(f"cluster: a worker of {self.name} failed: {kind}{_why(error)}") from None


def told(job, task):
    """In a worker: who it is, and what job(task) gives."""
    return fingerprint(), job(task)


def _why(error):
    """The first line of what an error says, if it says anything."""
    line = " ".join(str(error).split("\n")[0].split())
    return f" ({line})" if line else ""


@contextmanager
def connected(address, patience=PATIENCE):
    """A dask.distributed cluster, by its scheduler's address, as a Cluster. Raises TracerError."""
    try:
        import distributed
    except ImportError:
        raise TracerError(
            "cluster: needs the package distributed, which is not installed; pip install distributed"
        ) from None
    with _quiet():
        _check_answers(address, patience)
        client = distributed.Client(address, timeout=patience, set_as_default=False)
        try:
            yield Cluster(
                client.get_executor(pure=False, retries=0),
                _processes(client, address, patience),
                lambda job: client.submit(pickle.loads, pickle.dumps(job), pure=False),
                f"the scheduler at {address}",
                lambda: _working(client),
            )
        finally:
            client.close(timeout=patience)


@contextmanager
def _quiet():
    """Without what dask, tornado and asyncio log when a line breaks: what matters is said in one line."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)


def _check_answers(address, patience):
    """TracerError unless a scheduler answers at the address."""
    from distributed import rpc

    async def ask():
        async with rpc(address, timeout=patience) as scheduler:
            return await scheduler.identity()

    try:
        with ThreadPoolExecutor(1) as elsewhere:  # a notebook's own thread has an event loop running
            said = elsewhere.submit(lambda: asyncio.run(asyncio.wait_for(ask(), patience))).result()
        if said.get("type") != "Scheduler":
            raise TracerError(f"cluster: {address} is a {said.get('type')}, not a scheduler")
    except TracerError:
        raise
    except (TimeoutError, OSError):
        raise TracerError(
            f"cluster: no scheduler answers at {address}; start one with: dask scheduler"
        ) from None
    except Exception as error:
        raise TracerError(
            f"cluster: {address!r} is no scheduler's address such as tcp://127.0.0.1:8786{_why(error)}"
        ) from None


def _processes(client, address, patience):
    """How many tasks the workers do at once; TracerError if there is none."""
    try:
        client.wait_for_workers(1, timeout=patience)
    except TimeoutError:
        raise TracerError(
            f"cluster: the scheduler at {address} has no workers; start some with: "
            f"dask worker {address} --nthreads 1 --nworkers -1"
        ) from None
    return sum(client.nthreads().values())


def _working(client):
    """Whether there is any worker, or no saying: of a scheduler that is lost the tasks tell."""
    try:
        return bool(client.sync(client.scheduler.ncores, callback_timeout=ANSWER))
    except (OSError, TimeoutError):
        return True
