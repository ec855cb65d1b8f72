"""Fixtures of the whole suite."""

import shutil
from collections import Counter

import pytest
import suite

# As many quick tests take about as long as a slow one.
SLOW = 30


@pytest.fixture(scope="session", autouse=True)
def english():
    """Commands speak English, whatever language this machine's user reads."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("LANGUAGE", "en")
        yield


@pytest.fixture(scope="session")
def suite_seed():
    """The seed of every statistical test."""
    return suite.suite_seed()


@pytest.fixture(scope="session")
def chromium():
    """Path of the browser that the browser tests drive."""
    names = ("chromium", "chromium-browser", "google-chrome")
    return next(filter(None, map(shutil.which, names)), None) or suite.missing("chromium")


def pytest_collection_modifyitems(config, items):
    """Workers take whole files, so that what its tests share is made once; those with most to do go first."""
    if hasattr(config, "workerinput"):
        work = Counter()
        for item in items:
            long = item.get_closest_marker("slow") or item.get_closest_marker("browser")
            work[item.path] += SLOW if long else 1
        items.sort(key=lambda item: (-work[item.path], item.path))
