"""A dask.distributed scheduler and its workers on loopback, started and ended by whoever asks."""

import os
import subprocess
import sys
import time
from pathlib import Path

from suite import ROOT

# What makes a worker the slow machine among others.
SLOW = """
import time

from tracer import cluster


def late(job, task, told=cluster.told):  # bound now: a worker may run this file twice
    time.sleep(0.5)
    return told(job, task)


cluster.told = late
"""
PATIENCE = 30.0  # seconds


class Machines:
    """A scheduler and workers of one thread each, every one a process of its own."""

    def __init__(self, folder, workers=2):
        self._file = Path(folder, f"scheduler-{time.monotonic_ns()}.json")
        self._env = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        self._folder = folder
        where = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-jupyter")
        self.scheduler = self._start("dask_scheduler", *where, "--scheduler-file", self._file)
        self.workers = [self.start() for _ in range(workers)]

    def start(self, preload=None):
        """One more worker; preload: a file that it runs first."""
        words = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", self._folder]
        words += ["--preload", preload] if preload else []
        return self._start("dask_worker", "--scheduler-file", self._file, *words)

    def _start(self, module, *words):
        return subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.{module}", *map(str, words)],
            cwd=self._folder,
            env=self._env,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def wait_for_work(self):
        """Wait until somebody has given the scheduler something to do."""
        import distributed

        end = time.monotonic() + PATIENCE
        with distributed.Client(self.address, timeout=PATIENCE, set_as_default=False) as client:
            while not client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)):
                assert time.monotonic() < end, "the scheduler was given nothing to do"
                time.sleep(0.1)

    @property
    def address(self):
        """The scheduler's, once all workers are there."""
        import distributed

        end = time.monotonic() + PATIENCE
        while not self._file.exists():
            assert time.monotonic() < end, "the scheduler does not start"
            time.sleep(0.05)
        with distributed.Client(scheduler_file=str(self._file), set_as_default=False) as client:
            client.wait_for_workers(sum(w.poll() is None for w in self.workers), timeout=PATIENCE)
            return client.scheduler.address

    def close(self):
        """End all of them."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()
