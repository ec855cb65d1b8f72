"""What tests share: the suite's seed, the command line, and how a missing part of the system is treated."""

import os
import subprocess
import sys
from pathlib import Path

import forked
import pytest

ROOT = Path(__file__).resolve().parent.parent


def suite_seed():
    """One seed for every statistical test, never changed to make one pass; `make seeds` tries others."""
    return int(os.environ.get("CASTRAY_TEST_SEED", "20231"))


def missing(part):
    """Skip the test that needs `part`; under CI nothing may be missing, so fail."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"{part} is missing, and under CI nothing may be")
    pytest.skip(f"{part} is missing; `make test` says how to get it")


def gl():
    """The OpenGL context of the gl engine, drawn by whomever; without one the test is skipped."""
    from tracer.engine.gl.device import device
    from tracer.settings import TracerError

    try:
        return device()
    except TracerError as error:
        return missing(f"OpenGL 4.1 ({error})")


def castray(*words, cwd=ROOT, env=None, timeout=300):
    """`castray WORDS` as this checkout has it, run to its end in `cwd`."""
    words = [str(word) for word in words]
    env = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "PYTHONSAFEPATH": "1",
        "PYTHONIOENCODING": "utf-8",
        **(env or {}),
    }
    if forked.HERE:
        return forked.run(words, cwd, env, timeout)
    return subprocess.run(
        [sys.executable, "-c", "import sys; from viewer.cli import main; sys.exit(main())", *words],
        cwd=cwd,
        env=env,
        capture_output=True,
        encoding="utf-8",
        timeout=timeout,
        check=False,
    )
