"""Runs the statistical tests under 20 other seeds and reports the share that fail: `make seeds`."""

import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

from suite import suite_seed

ROOT = Path(__file__).resolve().parent.parent
RUNS = 20


def outcomes(seed, report):
    """(names of the tests that ran, names of those that failed) under one seed."""
    command = [sys.executable, "-m", "pytest", "-q", "-n", "2", "-m", "statistical", f"--junitxml={report}"]
    done = subprocess.run(
        command,
        cwd=ROOT,
        env={**os.environ, "CASTRAY_TEST_SEED": str(seed)},
        capture_output=True,
        encoding="utf-8",
    )
    if done.returncode not in (0, 1):  # 1: some failed, which is what is being counted
        sys.exit(done.stdout + done.stderr)
    ran, failed = [], []
    for case in ElementTree.parse(report).iter("testcase"):
        if case.find("skipped") is not None:
            continue
        name = f"{case.get('classname')}::{case.get('name')}"
        ran.append(name)
        if case.find("failure") is not None or case.find("error") is not None:
            failed.append(name)
    return ran, failed


def main():
    total, fails = 0, Counter()
    with tempfile.TemporaryDirectory() as folder:
        for run in range(1, RUNS + 1):
            seed = suite_seed() + run
            ran, failed = outcomes(seed, Path(folder) / "report.xml")
            total += len(ran)
            fails.update(failed)
            print(f"seed {seed}: {len(failed)} of {len(ran)} failed", flush=True)
    for name, count in fails.most_common():
        print(f"  {name}: under {count} of {RUNS} seeds")
    share = fails.total() / total
    print(f"{fails.total()} of {total} failed: {share:.3%}")


if __name__ == "__main__":
    main()
