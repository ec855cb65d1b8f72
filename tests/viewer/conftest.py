"""A viewer in a process of its own, and a browser before it."""

import os
import subprocess
import sys

import pytest
from suite import ROOT

SWITCHES = (
    "--headless=new",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)
SMALL = ("--size", "64", "64", "--spp", "8", "--max-depth", "6")


class Server:
    """`castray view WORDS`, started and ready; `address` is the line it printed."""

    def __init__(self, *words, cwd=ROOT):
        code = "import sys; from viewer.cli import main; sys.exit(main())"
        self.process = subprocess.Popen(
            [sys.executable, "-c", code, "view", *words, "--no-browser"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            cwd=cwd,
            env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8"},
        )
        self.address = self.process.stdout.readline().strip()
        assert self.address, self.process.stderr.read()

    @property
    def port(self):
        """Where it listens."""
        return int(self.address.split(":")[2].split("/")[0])

    @property
    def key(self):
        """The key of this start."""
        return self.address.partition("?key=")[2].partition("#")[0]

    def stop(self):
        """End it; what it said on standard error."""
        self.process.terminate()
        return self.process.communicate(timeout=20)[1]


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


@pytest.fixture
def context(browser):
    """A profile of one test: no cookies of another."""
    fresh = browser.new_context(viewport={"width": 1500, "height": 900})
    yield fresh
    fresh.close()


@pytest.fixture
def visit(context):
    """Opens an address in a new tab and waits until the viewer is ready; console errors are kept in `page.errors`."""

    def open_page(address, ready=True):
        page = context.new_page()
        page.errors, page.asked = [], []
        page.on("console", lambda m: page.errors.append(m.text) if m.type == "error" else None)
        page.on("pageerror", lambda e: page.errors.append(str(e)))
        page.on("request", lambda r: page.asked.append(r.url))
        page.goto(address)
        if ready:
            page.wait_for_selector("html[data-ready]")
        return page

    return open_page
