"""What a cluster of two workers on loopback takes beside two local processes, and what killing workers does.

python tests/cluster.py                 # speed: runs in turn, medians and their ratio
python tests/cluster.py --kills 20      # a worker killed at a random moment, as often: the same bits?
"""

import argparse
import random
import statistics
import tempfile

import numpy as np
from clusters import Machines
from suite import suite_seed

import tracer
from tracer import cluster
from tracer.testing.machine import machine

SPEED = tracer.Settings(width=256, height=256, spp=64, max_depth=8)
KILLS = tracer.Settings(width=64, height=64, spp=256, max_depth=8)
SMALL_TASKS = 8  # processes that the cluster is taken for: about 130 tasks, so that there are many moments


def speed(scene, machines, repeats):
    """Paths/s of two local processes and of the cluster, in turn."""
    rates = {"two local processes": [], "two workers": []}
    with cluster.connected(machines.address) as there:
        for run in range(repeats + 1):  # the first starts children, and imports
            pictures = (tracer.render(scene, SPEED, workers=2), tracer.render(scene, SPEED, cluster=there))
            assert pictures[0].rgb.tobytes() == pictures[1].rgb.tobytes()
            if run:
                for name, picture in zip(rates, pictures, strict=True):
                    rates[name].append(picture.paths / picture.seconds)
    medians = {name: statistics.median(values) for name, values in rates.items()}
    for name, rate in medians.items():
        print(f"{name}: {rate:.3g} paths/s (median of {repeats})")
    local, remote = medians.values()
    print(f"ratio: {remote / local:.3f} (asked: 0.9)")


def kills(scene, machines, times):
    """Kill a worker while it works, start another, so many times; how often the bits were the same."""
    local, moments = tracer.render(scene, KILLS), random.Random(suite_seed())
    same = died = 0
    for _ in range(times):
        address, share = machines.address, 0.8 * moments.random()  # of the work: before its end

        def kill(done, total, share=share):
            nonlocal died
            if done > share * total and len(machines.workers) == 2:
                machines.workers[0].kill()
                machines.workers.pop(0).wait()
                died += done < total

        with cluster.connected(address) as there:
            there.processes = SMALL_TASKS
            picture = tracer.render(scene, KILLS, kill, cluster=there)
        whats = ("rgb", "variance", "samples")
        same += all(np.array_equal(getattr(local, what), getattr(picture, what)) for what in whats)
        machines.workers += [machines.start() for _ in range(2 - len(machines.workers))]
    print(f"a worker killed {died} times while it worked: the same bits {same} times of {times}")
    return same == times


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    words.add_argument("--kills", type=int, default=0, metavar="N")
    words.add_argument("--repeats", type=int, default=5, metavar="N")
    asked = words.parse_args()
    scene = tracer.load("cornell_unit")
    print(machine())
    with tempfile.TemporaryDirectory() as folder:
        machines = Machines(folder)
        try:
            if asked.kills:
                return 0 if kills(scene, machines, asked.kills) else 1
            return speed(scene, machines, asked.repeats) or 0
        finally:
            machines.close()


if __name__ == "__main__":
    raise SystemExit(main())
