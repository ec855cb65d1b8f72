"""What tests share: the suite's seed, and how a missing part of the system is treated."""

import os

import pytest


def suite_seed():
    """One seed for every statistical test, never changed to make one pass; `make seeds` tries others."""
    return int(os.environ.get("CASTRAY_TEST_SEED", "20231"))


def missing(part):
    """Skip the test that needs `part`; under CI nothing may be missing, so fail."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"{part} is missing, and under CI nothing may be")
    pytest.skip(f"{part} is missing; `make test` says how to get it")
