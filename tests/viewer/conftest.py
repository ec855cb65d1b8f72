"""Viewers and a browser before them."""

import pytest
from viewers import SMALL, SWITCHES, Server

PATIENCE = 120_000  # milliseconds, of every wait: on a busy machine what takes one second took forty


@pytest.fixture(scope="module")
def serve():
    """Starts viewers; every one is stopped at the end."""
    started = []

    def start(*words, **options):
        started.append(Server(*words, **options))
        return started[-1]

    yield start
    for server in started:
        server.stop()


@pytest.fixture(scope="module")
def small(serve):
    """A viewer of a small picture, shared by the tests of a file."""
    return serve("cornell_unit", *SMALL)


@pytest.fixture(scope="session")
def browser(chromium):
    """Chromium with software GL and a fresh profile."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=chromium, args=list(SWITCHES))
        yield running
        running.close()


@pytest.fixture(scope="module")
def newcomer(serve, tmp_path_factory):
    """Starts viewers of somebody who has done nothing yet."""

    def start(*words):
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("XDG_STATE_HOME", str(tmp_path_factory.mktemp("reader")))
            return serve(*words)

    return start


@pytest.fixture(scope="module")
def tab(browser):
    """Opens an address in a tab that the tests of a file share; its console may have had no complaints."""
    opened = []

    def open_tab(address):
        context = browser.new_context(viewport={"width": 1280, "height": 720}, locale="en-GB")
        opened.append(listened(context))
        opened[-1].goto(address)
        opened[-1].wait_for_selector("html[data-ready]")
        return opened[-1]

    yield open_tab
    complaints = [error for page in opened for error in page.errors]
    for page in opened:
        page.context.close()
    assert complaints == []


def listened(context):
    """A new page; console errors go to `page.errors`, the addresses that it asks for to `page.asked`."""
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.errors, page.asked = [], []
    page.on("console", lambda m: page.errors.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda e: page.errors.append(str(e)))
    page.on("request", lambda r: page.asked.append(r.url))
    return page


@pytest.fixture
def context(browser):
    """A profile of one test: no cookies of another."""
    fresh = browser.new_context(viewport={"width": 1500, "height": 900})
    yield fresh
    fresh.close()


@pytest.fixture
def visit(context):
    """Opens an address in a new tab and waits until it is ready."""

    def open_page(address, ready=True):
        page = listened(context)
        page.goto(address)
        if ready:
            page.wait_for_selector("html[data-ready]")
        return page

    return open_page
