"""Fixtures of the whole suite."""

import shutil

import pytest
import suite


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


@pytest.hookimpl(tryfirst=True)  # xdist reads the groups in the same hook
def pytest_collection_modifyitems(items):
    """Tests that share a costly fixture (a browser, an installed wheel) stay on one worker, file by file."""
    for item in items:
        if item.get_closest_marker("browser") or item.get_closest_marker("slow"):
            item.add_marker(pytest.mark.xdist_group(item.path.name))
